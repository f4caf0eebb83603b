//! The loop: output over input, measured and of every model.

use super::shown::{MEASURED, Shown, band_colour, band_key, measured_pen, output_range, usage};
use super::thin;
use crate::plots::axis::Axis;
use crate::plots::panel::Reading;
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{NARROW, Pen};
use std::ops::Range;
use switchback_io::model::{Banded, RecordSeries};

/// Samples of a loop at most: with more, lines cover each other.
const MOST: usize = 500;
const HEIGHT: f64 = 430.0;

/// A figure a record.
pub(crate) fn loops(shown: &Shown<'_>) -> Vec<String> {
    shown.records().into_iter().map(|record| figure(shown, record)).collect()
}

fn figure(shown: &Shown<'_>, record: &RecordSeries) -> String {
    let window = thin::window(record, MOST);
    let (v, y) = (&record.v[window.clone()], &record.y[window.clone()]);
    let runs = shown.runs(record);
    let note = match window.len() == record.t.len() {
        true => format!("{} record.", usage(record)),
        false => format!(
            "{} record; {} of {} samples, from {} s on, where the first model misses most.",
            usage(record),
            window.len(),
            record.t.len(),
            record.t[window.start]
        ),
    };
    let title = format!("Loop of {}", record.record);
    let mut sheet = Sheet { width: NARROW, ..Sheet::new(title, vec![note], Grid::new(1, 1, HEIGHT)) };
    sheet.legend = shown.legend(record);
    let outputs: Vec<&[f64]> = runs.iter().map(|(_, run, _)| &run.y[window.clone()]).collect();
    let axes = (Axis::linear(v.iter().copied()), Axis::linear(output_range(y, &outputs)));
    let reading = Reading { x: shown.input, y: shown.output, zooms: false };
    sheet.render(|canvas, frames| {
        let panel = frames.readable(canvas, (0, 0), axes, reading);
        for (name, run, colour) in &runs {
            if let Some(stretches) = stretches(v, run, &window) {
                panel.series(&band_key(name), || {
                    stretches.iter().for_each(|stretch| panel.band(stretch, band_colour(*colour)));
                });
            }
        }
        let over = |y: &[f64]| -> Vec<(f64, f64)> { v.iter().copied().zip(y.iter().copied()).collect() };
        panel.series(MEASURED, || panel.line(&over(y), measured_pen()));
        for ((name, _, colour), output) in runs.iter().zip(&outputs) {
            panel.series(name, || panel.line(&over(output), Pen::data(*colour)));
        }
    })
}

/// The band by stretches on which the input moves in one direction, each by rising input: input, lower and upper end.
fn stretches(v: &[f64], run: &Banded, window: &Range<usize>) -> Option<Vec<Vec<(f64, f64, f64)>>> {
    let (y, half) = (&run.y[window.clone()], &run.band.as_ref()?[window.clone()]);
    let mut stretches = Vec::new();
    let mut start = 0;
    while start + 1 < v.len() {
        let rises = v[start + 1] >= v[start];
        let goes_on = |k: usize| (v[k + 1] >= v[k]) == rises;
        let end = (start + 1..v.len() - 1).find(|&k| !goes_on(k)).unwrap_or(v.len() - 1);
        let mut stretch: Vec<_> = (start..=end).map(|k| (v[k], y[k] - half[k], y[k] + half[k])).collect();
        if !rises {
            stretch.reverse();
        }
        stretches.push(stretch);
        start = end;
    }
    Some(stretches)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_rise_and_cover_every_step() {
        let v = [0.0, 1.0, 2.0, 1.0, 0.5, 0.5, 3.0];
        let run = Banded { y: vec![0.0, 1.0, 2.0, 1.5, 1.0, 1.0, 3.0], band: Some(vec![0.1; 7]) };
        let stretches = stretches(&v, &run, &(0..7)).expect("it has a band");
        assert!(stretches.iter().all(|s| s.windows(2).all(|pair| pair[0].0 <= pair[1].0)), "{stretches:?}");
        let steps: usize = stretches.iter().map(|s| s.len() - 1).sum();
        assert_eq!(steps, v.len() - 1);
    }
}
