//! Stated closure against what the stated models really close.

use super::page::{COLOURS, Frame, INK, PlotError, page};
use crate::blind::{Case, ClosureCheck};
use plotters::prelude::*;

/// One dot a rig; large gaps and small ones in two colours.
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub fn closure(cases: &[Case]) -> Result<String, PlotError> {
    let frame = Frame {
        title: "Closure on the hold-out records: stated against real",
        names: &["surviving gap ≥ 1 sd", "smaller"],
        x: ("closure that the stated models have", -0.5..1.05),
        y: ("closure stated", -0.5..1.05),
    };
    page((620, 560), |canvas| {
        frame.draw(
            canvas,
            |x| format!("{x:.1}"),
            |chart| {
                let diagonal = LineSeries::new([(-0.5, -0.5), (1.0, 1.0)], INK.mix(0.4));
                chart.draw_series(diagonal).map_err(PlotError::new)?;
                for (large, colour) in [(false, COLOURS[1]), (true, COLOURS[0])] {
                    let dots = cases.iter().filter(|c| c.is_large() == large).filter_map(|c| c.closure);
                    let dot = |c: ClosureCheck| {
                        // Rigs beyond the frame are drawn at its edge rather than dropped.
                        Circle::new((c.actual.max(-0.5), c.estimate.max(-0.5)), 2, colour.mix(0.6).filled())
                    };
                    chart.draw_series(dots.map(dot)).map_err(PlotError::new)?;
                }
                Ok(())
            },
        )
    })
}
