//! Shares as curves: accuracy against size, calibration, abstention.

use super::page::{COLOURS, Chart, Frame, INK, PlotError, Sample, page};
use crate::blind::{AbstentionRow, SizeRow};
use crate::examination::{CalibrationBin, Share};
use plotters::prelude::*;

const SIZE: (u32, u32) = (720, 460);

/// Accuracy against the size of the surviving gap, with 95 % intervals (Wilson).
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub(super) fn accuracy(rows: &[SizeRow]) -> Result<String, PlotError> {
    let largest = rows.iter().map(|r| r.wanted).fold(1.0, f64::max);
    let least = rows.iter().map(|r| r.wanted).fold(1.0, f64::min);
    let frame = Frame {
        title: "What was put in is named",
        sample: Sample::Line,
        names: &["exact", "right class", "other laws, right class", "a wrong cause"],
        x: ("surviving gap asked for, noise sd", least.log2() - 0.3..largest.log2() + 0.3),
        y: ("share of rigs", 0.0..1.02),
    };
    let series: [fn(&SizeRow) -> Share; 4] = [|r| r.exact, |r| r.class, |r| r.mismatch_class, |r| r.wrong];
    page(SIZE, |canvas| {
        frame.draw(canvas, power_of_two, |chart| {
            for (k, share) in series.into_iter().enumerate() {
                // Slightly apart, so that intervals do not cover each other.
                let aside = 0.03 * (k as f64 - 1.5);
                let points: Vec<_> = rows.iter().map(|r| (r.wanted.log2() + aside, share(r))).collect();
                curve(chart, COLOURS[k], &points)?;
            }
            Ok(())
        })
    })
}

/// A tick of an axis of binary logarithms; none between powers of two.
fn power_of_two(x: &f64) -> String {
    let is_whole = (x - x.round()).abs() < 1e-6;
    if is_whole { x.round().exp2().to_string() } else { String::new() }
}

/// Share of verdicts that hold against the probability they claim.
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub(in crate::plots) fn calibration(bins: &[CalibrationBin]) -> Result<String, PlotError> {
    let frame = Frame {
        title: "Probabilities mean what they say where the curve follows the diagonal",
        sample: Sample::Line,
        names: &["verdicts; bars: 95 % intervals (Wilson); grey: as much holds as is claimed"],
        x: ("probability claimed", 0.0..1.02),
        y: ("share that holds", 0.0..1.02),
    };
    page(SIZE, |canvas| {
        frame.draw(
            canvas,
            |x| format!("{x:.1}"),
            |chart| {
                let diagonal = LineSeries::new([(0.0, 0.0), (1.0, 1.0)], INK.mix(0.4));
                chart.draw_series(diagonal).map_err(PlotError::new)?;
                let points: Vec<_> = bins.iter().map(|b| (b.claimed, b.held)).collect();
                curve(chart, COLOURS[0], &points)
            },
        )
    })
}

/// Share of right verdicts against the share that is still given.
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub(super) fn abstention(rows: &[AbstentionRow]) -> Result<String, PlotError> {
    let frame = Frame {
        title: "Staying silent below a probability",
        sample: Sample::Line,
        names: &["verdicts still given", "of these, right"],
        x: ("least probability of a verdict", 0.0..1.02),
        y: ("share", 0.0..1.02),
    };
    let series: [fn(&AbstentionRow) -> Share; 2] = [|r| r.answered, |r| r.right];
    page(SIZE, |canvas| {
        frame.draw(
            canvas,
            |x| format!("{x:.1}"),
            |chart| {
                for (k, share) in series.into_iter().enumerate() {
                    let points: Vec<_> = rows.iter().map(|r| (r.threshold, share(r))).collect();
                    curve(chart, COLOURS[k], &points)?;
                }
                Ok(())
            },
        )
    })
}

fn curve(chart: &mut Chart<'_, '_>, colour: RGBColor, points: &[(f64, Share)]) -> Result<(), PlotError> {
    let told: Vec<_> = points.iter().filter_map(|(x, s)| Some((*x, s.value()?, s.interval()?))).collect();
    let line = LineSeries::new(told.iter().map(|(x, y, _)| (*x, *y)), colour.stroke_width(2));
    chart.draw_series(line).map_err(PlotError::new)?;
    let dots = told.iter().map(|(x, y, _)| Circle::new((*x, *y), 3, colour.filled()));
    chart.draw_series(dots).map_err(PlotError::new)?;
    let bars = told.iter().map(|(x, _, [low, high])| PathElement::new([(*x, *low), (*x, *high)], colour));
    chart.draw_series(bars).map_err(PlotError::new)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::power_of_two;

    #[test]
    fn ticks_are_powers_of_two() {
        let told = [-1.0, -0.5, 0.0, 1.0, 1.5, 2.0].map(|x| power_of_two(&x));
        assert_eq!(told, ["0.5", "", "1", "2", "", "4"]);
    }
}
