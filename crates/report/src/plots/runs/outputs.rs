//! Outputs over time, and below them the residuals.

use super::shown::{MEASURED, Shown, band_colour, band_key, extremes, measured_pen, output_range, usage};
use super::thin;
use crate::plots::axis::Axis;
use crate::plots::canvas::Dash;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::{Panel, Reading};
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{GREY, Pen};
use switchback_io::identification::unit;
use switchback_io::model::RecordSeries;

const TIME: &str = "time since the record's start [s]";
const HEIGHT: f64 = 210.0;
/// Key of the noise floor.
const FLOOR: &str = "± 2 sd of the noise";

/// A figure a record.
pub(crate) fn outputs(shown: &Shown<'_>) -> Vec<String> {
    shown.records().into_iter().map(|record| figure(shown, record)).collect()
}

fn figure(shown: &Shown<'_>, record: &RecordSeries) -> String {
    let mut sheet = Sheet::new(
        format!("Outputs of {}", record.record),
        vec![format!("{} record. Below: measured less simulated.", usage(record))],
        Grid { above: 12.0, apart: 66.0, ..Grid::new(2, 1, HEIGHT) },
    );
    sheet.legend = shown.legend(record);
    if noise(shown).is_some() {
        sheet.legend.push(Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dots), FLOOR).hiding(FLOOR));
    }
    let unit = unit(shown.output);
    let residual = if unit.is_empty() { "residual".to_owned() } else { format!("residual [{unit}]") };
    let time =
        Axis::linear([record.t.first().copied().unwrap_or(0.0), record.t.last().copied().unwrap_or(1.0)]);
    sheet.render(|canvas, frames| {
        let panel = |row: usize, y: Axis, name: &str| {
            frames.readable(canvas, (row, 0), (time, y), Reading { x: TIME, y: name, zooms: true })
        };
        let runs = shown.runs(record);
        let measured: Vec<&[f64]> = runs.iter().map(|(_, run, _)| &run.y[..]).collect();
        outputs_of(shown, record, &panel(0, Axis::linear(output_range(&record.y, &measured)), shown.output));
        let missed: Vec<Vec<f64>> = measured.iter().map(|run| misses(&record.y, run)).collect();
        let [low, high] = extremes(&record.y);
        let reach = (high - low).max(f64::MIN_POSITIVE);
        let floor = noise(shown).map(|noise| 2.0 * noise);
        let inside = missed.iter().flatten().map(|e| e.clamp(-reach, reach));
        let range = inside.chain(floor.iter().flat_map(|floor| [-floor, *floor]));
        let below = panel(1, Axis::linear(range), &residual);
        for ((name, _, colour), missed) in runs.iter().zip(&missed) {
            below.series(name, || below.line(&thin::line(&record.t, missed), Pen::data(*colour)));
        }
        if let Some(floor) = floor {
            below.series(FLOOR, || {
                [floor, -floor].into_iter().for_each(|y| below.level(y, Some(Dash::Dots), Pen::data(GREY)));
            });
        }
    })
}

fn noise(shown: &Shown<'_>) -> Option<f64> {
    shown.noise.filter(|noise| noise.is_finite())
}

fn misses(measured: &[f64], run: &[f64]) -> Vec<f64> {
    measured.iter().zip(run).map(|(y, s)| y - s).collect()
}

fn outputs_of(shown: &Shown<'_>, record: &RecordSeries, panel: &Panel<'_>) {
    let runs = shown.runs(record);
    for (name, run, colour) in &runs {
        if let Some(half) = &run.band {
            let band = thin::band(&record.t, &run.y, half);
            panel.series(&band_key(name), || panel.band(&band, band_colour(*colour)));
        }
    }
    panel.series(MEASURED, || panel.line(&thin::line(&record.t, &record.y), measured_pen()));
    for (name, run, colour) in &runs {
        panel.series(name, || panel.line(&thin::line(&record.t, &run.y), Pen::data(*colour)));
    }
}
