//! The borders with their confidence bands.

use crate::pages::Z95;
use crate::pages::chart::{Chart, Ink, Layer, Mark, Reading, SQUARE, Scale, Shape};
use maud::{Markup, html};
use switchback_io::diagnosis::digits;
use switchback_io::identification::json::{EstimateFile, Point};

/// Both borders, or the one that was seen.
pub(super) fn borders(estimate: &EstimateFile) -> Markup {
    let (falling, rising) = (&estimate.descendant, &estimate.ascendant);
    if falling.is_empty() && rising.is_empty() {
        return html! {};
    }
    let is_one = falling == rising;
    let drawn: Vec<(&str, Ink, &[Point])> = match is_one {
        true => vec![("both directions", Ink::Green, falling)],
        false => {
            vec![("descending, v falls", Ink::Blue, falling), ("ascending, v rises", Ink::Orange, rising)]
        }
    };
    let mut layers = Vec::new();
    for (name, ink, points) in drawn.iter().filter(|(.., points)| !points.is_empty()) {
        if points.iter().any(|p| p.se.is_finite()) {
            let band = points.iter().map(|p| (p.v, p.f - half(p), p.f + half(p))).collect();
            layers.push(Layer::new(format!("{name}, 95 % band"), *ink, Shape::Band(band)));
        }
        layers.push(Layer::new(*name, *ink, Shape::Line(points.iter().map(|p| (p.v, p.f)).collect())));
        layers.push(Layer::new(
            format!("{name}, points"),
            *ink,
            Shape::Marks(points.iter().map(|p| mark(name, p)).collect()),
        ));
    }
    let all = || falling.iter().chain(rising);
    let chart = Chart {
        title: if is_one { "The curve" } else { "Both borders" }.to_owned(),
        note: "Bands are pointwise 95 % intervals".to_owned(),
        x: Scale::linear(&estimate.input, all().map(|p| p.v)),
        y: Scale::linear("u, from u_m to u_m + 1", all().flat_map(|p| [p.f - half(p), p.f + half(p)])),
        layers,
        reading: Reading::Nearest,
        size: SQUARE,
    };
    html! {
        div class="charts" { (chart.html()) }
        @if let Some(apart) = &estimate.r#loop {
            p {
                "The borders are " (if apart.z > apart.limit { "told apart" } else { "not told apart" }) ": on "
                (format!("{:.0} %", 100.0 * apart.told_apart)) " of the interval their difference is beyond chance; it is clearest at "
                (digits(apart.clearest_v, 3)) ", where it is " (digits(apart.difference, 3)) " with a standard error of " (digits(apart.se, 2))
                " (" (digits(apart.z, 3)) " standard errors; the limit for all points together is " (digits(apart.limit, 3)) ")."
            }
        }
        p class="note" {
            "The scale between input and output belongs to neither part alone: u is told so that it runs from u_m to u_m + 1 over the working interval. "
            "A static nonlinearity in series with the input, an offset common to all records and a shift of the borders look the same in any record."
        }
    }
}

fn half(point: &Point) -> f64 {
    if point.se.is_finite() { Z95 * point.se } else { 0.0 }
}

fn mark(name: &str, point: &Point) -> Mark {
    let interval =
        if point.se.is_finite() { format!(" ± {}", digits(half(point), 2)) } else { String::new() };
    Mark {
        at: (point.v, point.f),
        ends: None,
        told: format!("{name}\n{}: {}{interval}", digits(point.v, 4), digits(point.f, 4)),
    }
}
