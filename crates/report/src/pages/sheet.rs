//! Figures that are files of their own, inlined.

use super::error::PageError;
use maud::{Markup, PreEscaped, html};

/// What the program draws with. With anything else a page would do more than show.
const DRAWN: [&str; 17] = [
    "svg", "g", "path", "polyline", "polygon", "line", "rect", "circle", "ellipse", "text", "tspan", "title",
    "desc", "defs", "clippath", "use", "marker",
];

/// A figure of a page: the SVG file of a name. `number` tells its ids from those of others.
///
/// # Errors
/// [`PageError::NoDrawing`] if the file is no SVG or holds more than a drawing.
pub(super) fn figure(name: &str, svg: &str, number: usize) -> Result<Markup, PageError> {
    let refuse = || PageError::NoDrawing { file: name.to_owned() };
    let start = svg.find("<svg").ok_or_else(refuse)?;
    let svg = svg[start..].trim_end();
    if !svg.split('<').skip(1).all(is_drawn) {
        return Err(refuse());
    }
    let svg = with_own_ids(svg, number);
    let head_end = svg.find('>').ok_or_else(refuse)?;
    let label = title(&svg).unwrap_or_else(|| name.trim_end_matches(".svg").replace(['-', '_'], " "));
    let labelled = html! { svg role="img" aria-label=(label) {} }.into_string();
    let named = svg[..head_end].contains(" aria-label=");
    let head = if named { "<svg" } else { labelled.trim_end_matches("></svg>") };
    let rest = &svg["<svg".len()..];
    Ok(html! { figure class="sheet" { div { (PreEscaped(format!("{head}{rest}"))) } } })
}

/// Figures of some files, one below the other; nothing where there are none.
///
/// # Errors
/// As [`figure`].
pub(super) fn sheets<'a>(files: impl Iterator<Item = (&'a str, &'a str)>) -> Result<Markup, PageError> {
    // Files have a name each, so that a number made of it is no other's.
    let number = |name: &str| {
        name.bytes().fold(7usize, |sum, byte| sum.wrapping_mul(31).wrapping_add(byte.into())) % 1_000_000_007
    };
    let drawn: Vec<Markup> =
        files.map(|(name, svg)| figure(name, svg, number(name))).collect::<Result<_, _>>()?;
    Ok(html! { @for figure in &drawn { (figure) } })
}

/// Whether a tag, all that follows its `<`, draws: nothing runs in it, and it refers to nothing but parts of the figure.
fn is_drawn(tag: &str) -> bool {
    let tag = tag.split('>').next().unwrap_or_default().to_ascii_lowercase();
    let name = tag.trim_start_matches('/').split([' ', '/', '\n', '\t', '\r']).next().unwrap_or_default();
    let mut attributes = tag.split(['"', '\'']).step_by(2).flat_map(str::split_ascii_whitespace).skip(1);
    let runs = attributes.any(|attribute| attribute.starts_with("on") || attribute.starts_with("style"));
    let refers = |k: usize| {
        !tag[k..].trim_start_matches("href").trim_start_matches(['=', ' ', '"', '\'']).starts_with('#')
    };
    DRAWN.contains(&name) && !runs && !tag.match_indices("href").any(|(k, _)| refers(k))
}

/// Ids, and what refers to them, begin with the figure's number: on a page each is there once.
fn with_own_ids(svg: &str, number: usize) -> String {
    let marked = |sign: &str| format!("{sign}f{number}-");
    [" id=\"", "href=\"#", "url(#"].iter().fold(svg.to_owned(), |svg, sign| svg.replace(sign, &marked(sign)))
}

/// The first text of a figure is its title.
fn title(svg: &str) -> Option<String> {
    let text = &svg[svg.find("<text")?..];
    let (_, rest) = text.split_once('>')?;
    let (inner, _) = rest.split_once("</text>")?;
    let plain = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    let title = plain.iter().fold(inner.trim().to_owned(), |text, (sign, plain)| text.replace(sign, plain));
    (!title.is_empty() && !inner.contains('<')).then_some(title)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_keeps_its_size_and_gets_a_label() {
        let svg = "<?xml version=\"1.0\"?>\n<svg width=\"1200\" height=\"9\" viewBox=\"0 0 9600 72\">\n<text x=\"1\">\na &lt; b &amp; c\n</text></svg>\n";
        let html = figure("bias-joint.svg", svg, 3).expect("a drawing").into_string();
        assert!(html.contains("<svg role=\"img\" aria-label=\"a &lt; b &amp; c\" width=\"1200\""), "{html}");
        assert!(!html.contains("<?xml"));
    }

    #[test]
    fn ids_are_those_of_one_figure() {
        let svg = "<svg><clipPath id=\"a\"/><g clip-path=\"url(#a)\"/><use href=\"#a\"/></svg>";
        let html = figure("x.svg", svg, 7).expect("a drawing").into_string();
        assert_eq!(html.matches("f7-a").count(), 3, "{html}");
    }

    #[test]
    fn what_is_more_than_a_drawing_is_refused() {
        for svg in [
            "no svg at all",
            "<svg><SCRIPT>alert(1)</SCRIPT></svg>",
            "<svg onload=\"alert(1)\"/>",
            "<svg><a href=\"javascript:alert(1)\"/></svg>",
            "<svg><image href=\"http://somewhere\"/></svg>",
        ] {
            assert!(figure("x.svg", svg, 0).is_err(), "{svg}");
        }
        assert!(
            figure("x.svg", "<svg><text font-size=\"9\">on = 1, javascript: one onset</text></svg>", 0)
                .is_ok()
        );
    }
}
