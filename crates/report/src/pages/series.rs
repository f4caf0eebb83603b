//! Sections of series.csv, which a diagnosis and an identification have in common.

use super::error::PageError;
use super::sheet::sheets;
use crate::plots::runs::{self, Shown};
use maud::{Markup, html};

/// A loop a record.
///
/// # Errors
/// A figure that is no drawing.
pub(super) fn loops(shown: &Shown<'_>) -> Result<Markup, PageError> {
    let figures = runs::loops(shown);
    Ok(html! {
        div class="charts" { (sheets(figures.iter().map(|svg| ("loop", &**svg)))?) }
        p class="note" {
            "Models run freely, from v alone; a band is the 95 % band of a model for a measured output, noise included."
            @if shown.left_out() > 0 { " " (shown.left_out()) " more records are in series.csv." }
        }
    })
}

/// Outputs and residuals over time.
///
/// # Errors
/// A figure that is no drawing.
pub(super) fn outputs(shown: &Shown<'_>) -> Result<Markup, PageError> {
    let figures = runs::outputs(shown);
    Ok(html! {
        (sheets(figures.iter().map(|svg| ("outputs", &**svg)))?)
        p class="note" {
            "Before the first simulated sample a model has the measured output. "
            @if shown.noise.is_some() { "The dotted lines among the residuals are the noise floor, ± 2 standard deviations: residuals between them need no cause." }
        }
    })
}
