//! The record to take next, drawn.

use crate::diagnosis::json::GapFile;
use crate::pages::chart::{Chart, FULL, Ink, Layer, Reading, Scale, Shape};
use maud::{Markup, html};
use switchback_io::diagnosis::digits;

/// Its input, and what it separates.
pub(super) fn experiment(gap: &GapFile) -> Markup {
    let Some(next) = &gap.next_experiment else {
        return html! { p { "None is needed to tell causes apart: the records leave no rivals that another record would separate." } };
    };
    let time = |k: usize| k as f64 * next.sample_time;
    let line: Vec<(f64, f64)> = next.v.iter().enumerate().map(|(k, v)| (time(k), *v)).collect();
    let rivals = next.separates.iter().map(|e| e.replace('_', " ")).collect::<Vec<_>>().join(" and ");
    let chart = Chart {
        title: format!("Input of the next experiment: {}", next.experiment.replace('_', " ")),
        note: String::new(),
        x: Scale::linear("time [s]", line.iter().map(|p| p.0)),
        y: Scale::linear(&gap.input, next.v.iter().copied()),
        layers: vec![Layer::new("input to play", Ink::Blue, Shape::Line(line))],
        reading: Reading::Zooming("next".to_owned()),
        size: FULL,
    };
    html! {
        p {
            "Of the kinds of record tried, " (next.experiment.replace('_', " ")) " sets the predictions of " (rivals) " apart by most: by "
            (digits(next.distance, 2)) " standard deviations of the noise at a sample, over " (next.v.len()) " samples ("
            (digits(next.v.len() as f64 * next.sample_time, 3)) " s). Where that is enough, next_experiment.csv holds the input."
        }
        (chart.html())
    }
}
