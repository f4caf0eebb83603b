//! The record to take next, drawn.

use crate::diagnosis::json::GapFile;
use crate::pages::error::PageError;
use crate::pages::sheet::figure;
use crate::plots::gap;
use maud::{Markup, html};
use switchback_io::diagnosis::digits;

/// Its input, and the causes that it separates.
///
/// # Errors
/// A figure that is no drawing.
pub(super) fn experiment(gap: &GapFile) -> Result<Markup, PageError> {
    let Some(next) = &gap.next_experiment else {
        return Ok(
            html! { p { "None is needed: the records leave no rivals that another record would separate." } },
        );
    };
    let rivals = next.separates.iter().map(|e| e.replace('_', " ")).collect::<Vec<_>>().join(" and ");
    Ok(html! {
        p {
            "Of the kinds of record tried, " (next.experiment.replace('_', " ")) " sets the predictions of " (rivals) " apart by most: by "
            (digits(next.distance, 2)) " standard deviations of the noise at a sample, over " (next.v.len()) " samples ("
            (digits(next.v.len() as f64 * next.sample_time, 3)) " s). Where that is enough, next_experiment.csv holds the input."
        }
        (figure("next experiment", &gap::experiment(gap, next))?)
    })
}
