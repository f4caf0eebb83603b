//! Figures on a page.

use super::drawing::redrawn;
use super::error::PageError;
use maud::{Markup, PreEscaped, html};

/// A figure of a page: the SVG of a name.
///
/// # Errors
/// [`PageError::NoDrawing`] if it holds more than a drawing.
pub(super) fn figure(name: &str, svg: &str) -> Result<Markup, PageError> {
    let label = name.trim_end_matches(".svg").replace(['-', '_'], " ");
    let refuse = |why: String| PageError::NoDrawing { file: name.to_owned(), why };
    let drawing = redrawn(svg, &label).map_err(refuse)?;
    Ok(html! { figure class="sheet" { div class="paper" { (PreEscaped(drawing)) } } })
}

/// Figures, one below the other; nothing where there are none.
///
/// # Errors
/// As [`figure`].
pub(super) fn sheets<'a>(figures: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Markup, PageError> {
    let drawn: Vec<Markup> =
        figures.into_iter().map(|(name, svg)| figure(name, svg)).collect::<Result<_, _>>()?;
    Ok(html! { @for figure in &drawn { (figure) } })
}
