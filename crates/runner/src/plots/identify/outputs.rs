//! Measured against simulated output of one record.

use super::series::{thinned, worst_window};
use super::style::{Canvas, ERROR, GRID, INK, MEASURED, PlotError, SIMULATED, header, letters, range, tick};
use crate::identification::FreeRun;
use plotters::prelude::*;
use std::ops::Range;
use switchback_estimator::rig::{Rig, RigRecord, Usage};

const LEGEND: [(&str, RGBColor); 3] =
    [("measured", MEASURED), ("simulated from v alone", SIMULATED), ("measured − simulated", ERROR)];

const SIZE: (u32, u32) = (960, 640);

/// Height of the upper panel: it carries the lesser detail.
const UPPER: u32 = 250;

/// Samples of the window that is drawn enlarged.
const WINDOW: usize = 300;

/// A series over time: stamps in seconds, values in output units.
type Series = Vec<(f64, f64)>;

/// What the panels draw.
struct Figure<'a> {
    label: &'a str,
    measured: Series,
    simulated: Series,
    errors: Series,
}

/// Above, over the whole record, what the simulation misses, before the measured output as a scale; below, enlarged, the
/// measured and the simulated output where it misses most.
///
/// # Errors
/// [`PlotError`] if drawing fails.
pub fn outputs(rig: &Rig, record: &RigRecord, run: &FreeRun) -> Result<String, PlotError> {
    let figure = Figure::new(rig, record, run);
    let samples = figure.measured.len();
    let misses: Vec<f64> = figure.errors.iter().map(|error| error.1).collect();
    let start = worst_window(&misses, WINDOW);
    let window = start..(start + WINDOW).min(samples);

    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        canvas.fill(&WHITE).map_err(PlotError::new)?;
        let body = header(&canvas, &title(rig, record, run), &LEGEND)?;
        let (upper, lower) = body.split_vertically(UPPER);
        let whole = "the whole record, the enlarged stretch shaded";
        let enlarged = format!("enlarged: the {} samples where the simulation misses most", window.len());
        figure.panel(&upper, (whole, 0..samples), Some(window.clone()))?;
        figure.panel(&lower, (&enlarged, window), None)?;
        canvas.present().map_err(PlotError::new)?;
    }
    Ok(svg)
}

fn title(rig: &Rig, record: &RigRecord, run: &FreeRun) -> String {
    let usage = match record.usage {
        Usage::Fit => "fitted",
        Usage::Holdout => "held out",
    };
    let fit = match run.fit_percent {
        fit if fit.is_finite() => format!("fit {fit:.1} % in free run"),
        _ => "free run".to_owned(),
    };
    format!("{}, record {} ({usage}): {fit}", rig.name, record.name)
}

impl<'a> Figure<'a> {
    fn new(rig: &'a Rig, record: &RigRecord, run: &FreeRun) -> Self {
        let stamped = |values: &mut dyn Iterator<Item = f64>| -> Series {
            values.enumerate().map(|(k, y)| (k as f64 * rig.sample_time, y)).collect()
        };
        let measured = record.record.y();
        Self {
            label: &rig.output_label,
            measured: stamped(&mut measured.iter().copied()),
            simulated: stamped(&mut run.simulated.iter().copied()),
            errors: stamped(&mut measured.iter().zip(&run.simulated).map(|(y, s)| y - s)),
        }
    }

    /// One pair of axes over a stretch of samples: with `shaded`, the overview; without, the enlargement.
    fn panel(
        &self,
        area: &Canvas<'_>,
        (caption, stretch): (&str, Range<usize>),
        shaded: Option<Range<usize>>,
    ) -> Result<(), PlotError> {
        let foreground = if shaded.is_some() { (&self.errors, ERROR) } else { (&self.simulated, SIMULATED) };
        let (measured, drawn) = (&self.measured[stretch.clone()], &foreground.0[stretch]);
        let time = measured[0].0..measured[measured.len() - 1].0;
        let output = output_range(measured, drawn);

        let mut chart = ChartBuilder::on(area)
            .caption(caption, letters(15))
            .margin_left(16)
            .margin_right(24)
            .margin_bottom(6)
            .x_label_area_size(42)
            .y_label_area_size(76)
            .build_cartesian_2d(time.clone(), output.clone())
            .map_err(PlotError::new)?;
        if let Some(window) = shaded {
            let corners = [
                (self.measured[window.start].0, output.start),
                (self.measured[window.end - 1].0, output.end),
            ];
            chart.draw_series([Rectangle::new(corners, GRID.filled())]).map_err(PlotError::new)?;
        }
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(INK)
            .label_style(letters(14))
            .axis_desc_style(letters(15))
            .x_desc("time since the record's start [s]")
            .y_desc(self.label)
            .y_labels(6)
            .x_label_formatter(&tick(time.end - time.start))
            .y_label_formatter(&tick(output.end - output.start))
            .draw()
            .map_err(PlotError::new)?;
        for (points, colour, width) in [(measured, MEASURED, 4), (drawn, foreground.1, 2)] {
            let within = points.iter().filter(|p| p.1.is_finite());
            let clamped: Series = within.map(|p| (p.0, p.1.clamp(output.start, output.end))).collect();
            let line = LineSeries::new(thinned(&clamped, SIZE.0 as usize), colour.stroke_width(width));
            chart.draw_series(line).map_err(PlotError::new)?;
        }
        Ok(())
    }
}

/// Room for both series, but never more than thrice the measured one's: a simulation that runs away must not flatten
/// the measured output to a line.
fn output_range(measured: &[(f64, f64)], drawn: &[(f64, f64)]) -> Range<f64> {
    let seen = range(measured.iter().map(|p| p.1));
    let both = range(measured.iter().chain(drawn).map(|p| p.1));
    let reach = seen.end - seen.start;
    both.start.max(seen.start - reach)..both.end.min(seen.end + reach)
}
