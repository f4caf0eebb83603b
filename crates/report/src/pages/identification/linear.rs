//! The linear part: its figure, and its poles and zeros as a table.

use crate::pages::error::PageError;
use crate::pages::sheet::figure;
use crate::pages::table::{Cell, Table};
use crate::plots::identify::{self, LinearPart, with_error};
use maud::{Markup, html};
use switchback_io::diagnosis::digits;
use switchback_io::identification::json::EstimateFile;
use switchback_io::model::ModelFile;

/// A figure and a table.
///
/// # Errors
/// A figure that is no drawing.
pub(super) fn linear(estimate: &EstimateFile, model: Option<&ModelFile>) -> Result<Markup, PageError> {
    let Some(part) = LinearPart::of(estimate, model) else {
        return Ok(html! { p { "The coefficients are not known." } });
    };
    Ok(html! {
        (figure("linear part", &identify::linear(&part))?)
        (roots(&part, estimate.sample_time).html())
        p class="note" {
            "From u, which runs from u_m to u_m + 1, to the output. "
            @if part.has_errors() { "Bands and intervals are pointwise, 95 %, from the covariance of the coefficients by linear propagation." }
            @else { "There are no bands: the covariance of the coefficients is not known." }
        }
    })
}

fn roots(part: &LinearPart<'_>, sample_time: f64) -> Table {
    let mut table = Table::new(
        "Poles and zeros",
        ["root", "real part", "imaginary part", "modulus", "time constant [s]", "frequency [Hz]"],
    );
    for (name, roots) in ["pole", "zero"].into_iter().zip(part.roots()) {
        for root in roots {
            let (re, im) = root.at;
            let modulus = re.hypot(im);
            let decay = (modulus > 0.0 && modulus < 1.0).then(|| -sample_time / modulus.ln());
            let turns = part.hertz(im.atan2(re).abs());
            table.row([
                Cell::word(name),
                Cell::number(with_error(re, root.se.map(|s| s.0)), Some(re)),
                Cell::number(with_error(im, root.se.map(|s| s.1)), Some(im)),
                Cell::number(digits(modulus, 4), Some(modulus)),
                Cell::number(decay.map_or_else(|| "–".to_owned(), |d| digits(d, 3)), decay),
                Cell::number(digits(turns, 3), Some(turns)),
            ]);
        }
    }
    table
}
