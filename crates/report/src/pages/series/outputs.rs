//! Outputs over time, and below them what the models miss.

use super::{Drawn, thin, usage};
use crate::pages::chart::{Chart, FULL, Ink, Layer, Reading, Scale, Shape};
use maud::{Markup, html};
use switchback_io::identification::unit;
use switchback_io::model::RecordSeries;

const TIME: &str = "time since the record's start [s]";

/// Two charts a record that zoom together.
pub(crate) fn outputs(drawn: &Drawn<'_>) -> Markup {
    html! {
        @for (k, record) in drawn.records().into_iter().enumerate() {
            (measured(drawn, record, k).html())
            (residuals(drawn, record, k).html())
        }
        p class="note" {
            "Before the first simulated sample a model has the measured output. "
            @if drawn.noise.is_some() { "The dotted lines among the residuals are the noise floor, ± 2 standard deviations: what lies between them needs no cause." }
        }
    }
}

fn measured(drawn: &Drawn<'_>, record: &RecordSeries, number: usize) -> Chart {
    let mut bands = Vec::new();
    let mut lines = vec![Layer::new("measured", Ink::Grey, Shape::Wide(thin::line(&record.t, &record.y)))];
    for (k, (name, run)) in drawn.series.names.iter().zip(&record.runs).enumerate() {
        let Some(run) = run else { continue };
        lines.push(Layer::new(name, drawn.ink(k), Shape::Line(thin::line(&record.t, &run.y))));
        if let Some(half) = &run.band {
            let band = thin::band(&record.t, &run.y, half);
            bands.push(Layer::new(format!("{name}, 95 % band"), drawn.ink(k), Shape::Band(band)));
        }
    }
    bands.append(&mut lines);
    let (low, high) = range(&record.y);
    let reach = (high - low).max(f64::MIN_POSITIVE);
    let runs = record.runs.iter().flatten().flat_map(|run| &run.y);
    let shown = record.y.iter().chain(runs).map(|y| y.clamp(low - reach, high + reach));
    Chart {
        title: format!("Outputs of {}", record.record),
        note: usage(record).to_owned(),
        x: Scale::linear(TIME, ends(&record.t)),
        y: Scale::linear(drawn.output, shown),
        layers: bands,
        reading: Reading::Zooming(format!("record-{number}")),
        size: FULL,
    }
}

fn residuals(drawn: &Drawn<'_>, record: &RecordSeries, number: usize) -> Chart {
    let (low, high) = range(&record.y);
    let reach = (high - low).max(f64::MIN_POSITIVE);
    let mut layers = Vec::new();
    let mut shown = Vec::new();
    for (k, (name, run)) in drawn.series.names.iter().zip(&record.runs).enumerate() {
        let Some(run) = run else { continue };
        let missed: Vec<f64> = record.y.iter().zip(&run.y).map(|(y, s)| y - s).collect();
        shown.extend(missed.iter().map(|e| e.clamp(-reach, reach)));
        layers.push(Layer::new(
            format!("measured − {name}"),
            drawn.ink(k),
            Shape::Line(thin::line(&record.t, &missed)),
        ));
    }
    if let Some(noise) = drawn.noise.filter(|noise| noise.is_finite()) {
        let floor = |level: f64| ends(&record.t).map(|t| (t, level));
        let both = [floor(2.0 * noise), floor(-2.0 * noise)].concat();
        shown.extend(both.iter().map(|p| p.1));
        // The way back from one line to the other is outside the frame.
        let far = (f64::NAN, f64::NAN);
        layers.push(Layer::new(
            "± 2 sd of the noise",
            Ink::Green,
            Shape::Dots(vec![both[0], both[1], far, both[2], both[3]]),
        ));
    }
    let unit = unit(drawn.output);
    Chart {
        title: format!("Residuals of {}", record.record),
        note: String::new(),
        x: Scale::linear(TIME, ends(&record.t)),
        y: Scale::linear(
            if unit.is_empty() { "residual".to_owned() } else { format!("residual [{unit}]") },
            shown,
        ),
        layers,
        reading: Reading::Zooming(format!("record-{number}")),
        size: (FULL.0, 240.0),
    }
}

fn ends(t: &[f64]) -> [f64; 2] {
    [t.first().copied().unwrap_or(0.0), t.last().copied().unwrap_or(1.0)]
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(*y), high.max(*y)))
}
