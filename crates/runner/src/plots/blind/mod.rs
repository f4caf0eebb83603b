//! Figures of a blind study, drawn from its tables alone.

mod closure;
mod confusion;
mod curves;
mod page;
mod rules;

pub use page::PlotError;

use crate::blind::{Case, Scores};

/// Every figure with the name of its file.
///
/// # Errors
/// [`PlotError`] for a figure that could not be drawn.
pub fn figures(cases: &[Case], scores: &Scores) -> Result<[(&'static str, String); 6], PlotError> {
    Ok([
        ("confusion.svg", confusion::confusion(&scores.confusion)?),
        ("accuracy.svg", curves::accuracy(&scores.sizes)?),
        ("calibration.svg", curves::calibration(&scores.calibration)?),
        ("abstention.svg", curves::abstention(&scores.abstention)?),
        ("closure.svg", closure::closure(cases)?),
        ("baselines.svg", rules::baselines(&scores.baselines)?),
    ])
}
