//! The loop: output over input, measured and of every model.

use super::{Drawn, thin, usage};
use crate::pages::chart::{Chart, Ink, Layer, Reading, SQUARE, Scale, Shape};
use maud::{Markup, html};
use std::ops::Range;
use switchback_io::model::{Banded, RecordSeries};

/// Samples of a loop at most: with more, lines cover each other.
const MOST: usize = 500;

/// A loop a record.
pub(crate) fn loops(drawn: &Drawn<'_>) -> Markup {
    html! {
        div class="charts" { @for record in drawn.records() { (chart(drawn, record).html()) } }
        p class="note" {
            "Models run freely, from v alone; a band is the 95 % band of a model for a measured output, noise included."
            @if drawn.left_out() > 0 { " " (drawn.left_out()) " more records are in series.csv." }
        }
    }
}

fn chart(drawn: &Drawn<'_>, record: &RecordSeries) -> Chart {
    let window = thin::window(record, MOST);
    let part = |values: &[f64]| values[window.clone()].to_vec();
    let (v, y) = (part(&record.v), part(&record.y));
    let over = |y: &[f64]| v.iter().copied().zip(y[window.clone()].iter().copied()).collect();
    let mut bands = Vec::new();
    let mut lines = vec![Layer::new("measured", Ink::Grey, Shape::Wide(over(&record.y)))];
    for (k, (name, run)) in drawn.series.names.iter().zip(&record.runs).enumerate() {
        let Some(run) = run else { continue };
        lines.push(Layer::new(name, drawn.ink(k), Shape::Line(over(&run.y))));
        if let Some(patches) = patches(&v, run, &window) {
            bands.push(Layer::new(format!("{name}, 95 % band"), drawn.ink(k), Shape::Patches(patches)));
        }
    }
    bands.append(&mut lines);
    let note = match window.len() == record.t.len() {
        true => usage(record).to_owned(),
        false => format!(
            "{}; {} of {} samples, from {} s on, where the first model misses most",
            usage(record),
            window.len(),
            record.t.len(),
            record.t[window.start]
        ),
    };
    Chart {
        title: format!("Loop of {}", record.record),
        note,
        x: Scale::linear(drawn.input, v.iter().copied()),
        y: Scale::linear(drawn.output, inside(&y, record, &window)),
        layers: bands,
        reading: Reading::Nearest,
        size: SQUARE,
    }
}

/// The measured outputs, and what runs add to them within their range once more: one that runs away must not flatten the loop.
fn inside(y: &[f64], record: &RecordSeries, window: &Range<usize>) -> Vec<f64> {
    let (low, high) =
        y.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(*y), high.max(*y)));
    let reach = (high - low).max(f64::MIN_POSITIVE);
    let runs = record.runs.iter().flatten().flat_map(|run| &run.y[window.clone()]);
    y.iter().chain(runs).map(|y| y.clamp(low - reach, high + reach)).collect()
}

/// The band as patches, one a stretch on which the input moves one way; all turn the same way round, so that patches that overlap stay
/// filled.
fn patches(v: &[f64], run: &Banded, window: &Range<usize>) -> Option<Vec<Vec<(f64, f64)>>> {
    let (y, half) = (&run.y[window.clone()], &run.band.as_ref()?[window.clone()]);
    let mut patches = Vec::new();
    let mut start = 0;
    while start + 1 < v.len() {
        let rises = v[start + 1] >= v[start];
        let goes_on = |k: usize| (v[k + 1] >= v[k]) == rises;
        let end = (start + 1..v.len() - 1).find(|&k| !goes_on(k)).unwrap_or(v.len() - 1);
        let mut stretch: Vec<usize> = (start..=end).collect();
        if !rises {
            stretch.reverse();
        }
        let upper = stretch.iter().map(|&k| (v[k], y[k] + half[k]));
        let lower = stretch.iter().rev().map(|&k| (v[k], y[k] - half[k]));
        patches.push(upper.chain(lower).collect());
        start = end;
    }
    Some(patches)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_turn_one_way_and_cover_every_step() {
        let v = [0.0, 1.0, 2.0, 1.0, 0.5, 0.5, 3.0];
        let run = Banded { y: vec![0.0, 1.0, 2.0, 1.5, 1.0, 1.0, 3.0], band: Some(vec![0.1; 7]) };
        let patches = patches(&v, &run, &(0..7)).expect("it has a band");
        let twice_area = |p: &[(f64, f64)]| -> f64 {
            (0..p.len()).map(|k| (p[k], p[(k + 1) % p.len()])).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum()
        };
        assert!(patches.iter().all(|p| twice_area(p) <= 0.0), "{patches:?}");
        let steps: usize = patches.iter().map(|p| p.len() / 2 - 1).sum();
        assert_eq!(steps, v.len() - 1);
    }
}
