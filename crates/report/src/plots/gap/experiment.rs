//! The input of the record to take next.

use crate::diagnosis::json::{GapFile, Next};
use crate::plots::axis::Axis;
use crate::plots::panel::Reading;
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{AFTER, Pen};

const HEIGHT: f64 = 200.0;

/// The input over time.
pub(crate) fn experiment(gap: &GapFile, next: &Next) -> String {
    let line: Vec<(f64, f64)> =
        next.v.iter().enumerate().map(|(k, v)| (k as f64 * next.sample_time, *v)).collect();
    let title = format!("Input of the next experiment: {}", next.experiment.replace('_', " "));
    let sheet = Sheet::new(title, Vec::new(), Grid { above: 12.0, ..Grid::new(1, 1, HEIGHT) });
    let axes = (Axis::linear(line.iter().map(|p| p.0)), Axis::linear(next.v.iter().copied()));
    sheet.render(|canvas, frames| {
        let reading = Reading { x: "time [s]", y: &gap.input, zooms: true };
        let panel = frames.readable(canvas, (0, 0), axes, reading);
        panel.series("input to play", || panel.line(&line, Pen::data(AFTER)));
    })
}
