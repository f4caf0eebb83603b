//! Stated closure against what the stated models really close.

use super::page::{COLOURS, Frame, INK, PlotError, Sample, page, tick};
use crate::blind::Case;
use crate::examination::ClosureCheck;
use plotters::prelude::*;

/// Where the axes begin.
const LEAST: f64 = -0.5;

/// One dot a rig; large gaps and small ones in two colours.
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub(super) fn closure(cases: &[Case]) -> Result<String, PlotError> {
    let frame = Frame {
        title: "Closure on the hold-out records: stated against real (× beyond the frame)",
        sample: Sample::Dot,
        names: &["surviving gap ≥ 1 sd", "smaller"],
        x: ("closure that the stated models have", LEAST..1.05),
        y: ("closure stated", LEAST..1.05),
    };
    page((620, 560), |canvas| {
        frame.draw(
            canvas,
            |x| tick(*x, 1),
            |chart| {
                let diagonal = LineSeries::new([(LEAST, LEAST), (1.0, 1.0)], INK.mix(0.4));
                chart.draw_series(diagonal).map_err(PlotError::new)?;
                for (large, colour) in [(false, COLOURS[1]), (true, COLOURS[0])] {
                    let dots = cases.iter().filter(|c| c.is_large() == large).filter_map(|c| c.closure);
                    let dot =
                        |c: ClosureCheck| Circle::new((c.actual, c.estimate), 2, colour.mix(0.6).filled());
                    let (inside, beyond): (Vec<_>, Vec<_>) =
                        dots.partition(|c| c.actual >= LEAST && c.estimate >= LEAST);
                    chart.draw_series(inside.into_iter().map(dot)).map_err(PlotError::new)?;
                    // Rigs beyond the frame stand at its edge as crosses.
                    let mark = |c: ClosureCheck| {
                        Cross::new((c.actual.max(LEAST), c.estimate.max(LEAST)), 4, colour.stroke_width(1))
                    };
                    chart.draw_series(beyond.into_iter().map(mark)).map_err(PlotError::new)?;
                }
                Ok(())
            },
        )
    })
}
