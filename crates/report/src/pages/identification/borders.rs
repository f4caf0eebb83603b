//! The borders with their confidence bands.

use crate::pages::error::PageError;
use crate::pages::sheet::figure;
use crate::plots::identify;
use maud::{Markup, html};
use switchback_io::diagnosis::digits;
use switchback_io::identification::json::EstimateFile;

/// Both borders, or the one that was seen.
///
/// # Errors
/// A figure that is no drawing.
pub(super) fn borders(estimate: &EstimateFile) -> Result<Markup, PageError> {
    let Some(svg) = identify::borders(estimate) else { return Ok(html! {}) };
    Ok(html! {
        (figure("borders", &svg)?)
        @if let Some(apart) = &estimate.r#loop {
            p {
                "The borders " (if apart.z > apart.limit { "differ beyond chance" } else { "do not differ beyond chance" }) ": on "
                (format!("{:.0} %", 100.0 * apart.distinguished)) " of the interval their difference is beyond chance; it is clearest at "
                (digits(apart.clearest_v, 3)) ", where it is " (digits(apart.difference, 3)) " with a standard error of " (digits(apart.se, 2))
                " (" (digits(apart.z, 3)) " standard errors; the limit for all points together is " (digits(apart.limit, 3)) ")."
            }
        }
        p class="note" {
            "The scale between input and output belongs to neither part alone: u runs from u_m to u_m + 1 over the working interval. "
            "A static nonlinearity in series with the input, an offset common to all records and a shift of the borders look the same in any record."
        }
    })
}
