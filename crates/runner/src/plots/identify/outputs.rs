//! Measured against simulated output of one record.

use super::series::{thinned, worst_window};
use super::style::{Canvas, ERROR, GRID, INK, MEASURED, PlotError, SIMULATED, header, letters, range, tick};
use crate::identification::FreeRun;
use plotters::prelude::*;
use switchback_estimator::rig::{Rig, RigRecord, Usage};

const LEGEND: [(&str, RGBColor); 3] =
    [("measured", MEASURED), ("simulated from v alone", SIMULATED), ("measured − simulated", ERROR)];

const SIZE: (u32, u32) = (960, 640);

/// Samples of the window that is drawn enlarged.
const WINDOW: usize = 300;

/// The whole record above; below it, enlarged, the stretch where the simulation misses most.
///
/// # Errors
/// [`PlotError`] if drawing fails.
pub fn outputs(rig: &Rig, record: &RigRecord, run: &FreeRun) -> Result<String, PlotError> {
    let usage = match record.usage {
        Usage::Fit => "fit",
        Usage::Holdout => "hold-out",
    };
    let title = match run.fit_percent {
        fit if fit.is_finite() => {
            format!("{}, record {} ({usage}): free-run simulation explains {fit:.1} %", rig.name, record.name)
        }
        _ => format!("{}, record {} ({usage}): free-run simulation", rig.name, record.name),
    };
    let measured = stamped(record.record.y(), rig.sample_time);
    let simulated = stamped(&run.simulated, rig.sample_time);
    let errors: Vec<f64> = record.record.y().iter().zip(&run.simulated).map(|(y, s)| y - s).collect();

    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        canvas.fill(&WHITE).map_err(PlotError::new)?;
        let body = header(&canvas, &title, &LEGEND)?;
        if measured.len() <= 2 * WINDOW {
            panel(&body, "", [&measured, &simulated], &rig.output_label)?;
        } else {
            let (upper, lower) = body.split_vertically(280);
            let start = worst_window(&errors, WINDOW);
            let window = start..start + WINDOW;
            panel(&upper, "whole record", [&measured, &simulated], &rig.output_label)?;
            let caption = format!("the {WINDOW} samples where it misses most");
            panel(&lower, &caption, [&measured[window.clone()], &simulated[window]], &rig.output_label)?;
        }
        canvas.present().map_err(PlotError::new)?;
    }
    Ok(svg)
}

fn stamped(y: &[f64], sample_time: f64) -> Vec<(f64, f64)> {
    y.iter().enumerate().map(|(k, y)| (k as f64 * sample_time, *y)).collect()
}

fn panel(
    area: &Canvas<'_>,
    caption: &str,
    [measured, simulated]: [&[(f64, f64)]; 2],
    output_label: &str,
) -> Result<(), PlotError> {
    let time = measured[0].0..measured[measured.len() - 1].0;
    // A simulation that runs away must not flatten the measured output to a line.
    let seen = range(measured.iter().map(|p| p.1));
    let errors: Vec<_> = measured.iter().zip(simulated).map(|(y, s)| (y.0, y.1 - s.1)).collect();
    let both = range(measured.iter().chain(simulated).chain(&errors).map(|p| p.1));
    let reach = seen.end - seen.start;
    let output = both.start.max(seen.start - reach)..both.end.min(seen.end + reach);
    let clipped = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        points
            .iter()
            .map(|p| (p.0, p.1.clamp(output.start, output.end)))
            .filter(|p| p.1.is_finite())
            .collect()
    };

    let mut chart = ChartBuilder::on(area)
        .caption(caption, letters(15))
        .margin_right(24)
        .margin_left(16)
        .margin_bottom(6)
        .x_label_area_size(42)
        .y_label_area_size(76)
        .build_cartesian_2d(time.clone(), output.clone())
        .map_err(PlotError::new)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .axis_style(INK)
        .label_style(letters(14))
        .axis_desc_style(letters(15))
        .x_desc("time since the record's start [s]")
        .y_desc(output_label)
        .y_labels(6)
        .x_label_formatter(&tick(time.end - time.start))
        .y_label_formatter(&tick(output.end - output.start))
        .draw()
        .map_err(PlotError::new)?;
    for (points, colour, width) in [(measured, MEASURED, 4), (simulated, SIMULATED, 1), (&errors, ERROR, 1)] {
        let points = thinned(&clipped(points), SIZE.0 as usize);
        chart.draw_series(LineSeries::new(points, colour.stroke_width(width))).map_err(PlotError::new)?;
    }
    Ok(())
}
