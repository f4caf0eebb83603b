//! Charts that only pages have: curves that can be read off, hidden and zoomed, in the colours of the page, light or dark.
//!
//! They are made of the axes of all other figures ([`Axis`]); what is drawn lies in a square of 1000 by 1000 that the page's script
//! reads back, so that no number is written twice.

use crate::plots::axis::Axis;
use maud::{Markup, PreEscaped, html};
use std::fmt::Write;

/// An axis with its name and unit.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    axis: Axis,
    name: String,
}

impl Scale {
    /// A linear axis over values.
    pub(super) fn linear(name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self { axis: Axis::linear(values), name: name.into() }
    }

    /// A logarithmic axis over the positive ones of some values.
    pub(super) fn logarithmic(name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self { axis: Axis::logarithmic(values), name: name.into() }
    }

    /// The ends, as the script reads them.
    fn words(&self) -> String {
        // Half-way up a logarithmic axis is the geometric mean of its ends, and the arithmetic one on a linear axis.
        let geometric = (self.axis.low() * self.axis.high()).sqrt();
        let is_logarithmic = self.axis.place(geometric).is_some_and(|p| (p - 0.5).abs() < 1e-9)
            && self.axis.place(-1.0).is_none();
        format!("{} {} {}", if is_logarithmic { "log" } else { "lin" }, self.axis.low(), self.axis.high())
    }
}

/// A mark with the words that are told of it.
#[derive(Debug, Clone)]
pub(super) struct Mark {
    pub(super) at: (f64, f64),
    /// The ends of a bar.
    pub(super) ends: Option<(f64, f64)>,
    pub(super) told: String,
}

/// How something is drawn.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    Line(Vec<(f64, f64)>),
    /// A line that others are drawn on.
    Wide(Vec<(f64, f64)>),
    Dashes(Vec<(f64, f64)>),
    Dots(Vec<(f64, f64)>),
    /// Between a low and a high value at each x.
    Band(Vec<(f64, f64, f64)>),
    /// Patches, each a polygon.
    Patches(Vec<Vec<(f64, f64)>>),
    Marks(Vec<Mark>),
    Crosses(Vec<Mark>),
    /// Upright lines from zero.
    Stems(Vec<(f64, f64)>),
}

/// Something drawn, with its name in the key.
#[derive(Debug, Clone)]
pub(super) struct Layer {
    name: String,
    ink: Ink,
    shape: Shape,
}

/// Colours of the page, the same in light and dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ink {
    Blue = 0,
    Orange = 1,
    Green = 2,
    Grey = 6,
}

impl Layer {
    /// Something to draw.
    pub(super) fn new(name: impl Into<String>, ink: Ink, shape: Shape) -> Self {
        Self { name: name.into(), ink, shape }
    }
}

/// Which points answer the pointer, and whether the chart zooms.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) enum Reading {
    /// All curves at the pointer's x.
    #[default]
    Along,
    /// The nearest point of any curve.
    Nearest,
    /// As `Along`; charts of the same name zoom together.
    Zooming(String),
}

/// A chart.
#[derive(Debug, Clone)]
pub(super) struct Chart {
    pub(super) title: String,
    pub(super) note: String,
    pub(super) x: Scale,
    pub(super) y: Scale,
    pub(super) layers: Vec<Layer>,
    pub(super) reading: Reading,
    /// Width and height of the figure in its own units.
    pub(super) size: (f64, f64),
}

/// A chart that shares its row with another.
pub(super) const HALF: (f64, f64) = (640.0, 400.0);
/// One as wide as the page.
pub(super) const FULL: (f64, f64) = (960.0, 300.0);
/// One that is as high as it is wide, nearly.
pub(super) const SQUARE: (f64, f64) = (640.0, 560.0);

const LEFT: f64 = 92.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 62.0;
const WHOLE: f64 = 1000.0;
/// Labels of an axis at most.
const TICKS: usize = 7;

impl Chart {
    /// The figure.
    pub(super) fn html(&self) -> Markup {
        let (width, height) = self.size;
        let near = (self.reading == Reading::Nearest).then_some("xy");
        let zoom = match &self.reading {
            Reading::Zooming(group) => Some(group),
            _ => None,
        };
        let label =
            if self.note.is_empty() { self.title.clone() } else { format!("{}. {}", self.title, self.note) };
        html! {
            figure class={ "chart" @if width > HALF.0 { " across" } } data-near=[near] data-zoom=[zoom] {
                figcaption { strong { (self.title) } @if !self.note.is_empty() { ". " (self.note) } span class="narrow" { ". Upright: " (self.y.name) } }
                (self.keys())
                svg class="axes" viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(label)
                    data-x=(self.x.words()) data-y=(self.y.words()) data-xname=(self.x.name) {
                    (self.frame())
                    svg class="plot" x=(LEFT) y=(TOP) width=(width - LEFT - RIGHT) height=(height - TOP - BOTTOM)
                        viewBox="0 0 1000 1000" preserveAspectRatio="none" {
                        @for (k, layer) in self.layers.iter().enumerate() {
                            g data-layer=(k) data-name=(layer.name) class={ "i" (layer.ink as usize) } { (self.drawn(&layer.shape)) }
                        }
                    }
                }
            }
        }
    }

    /// What the colours mean; each entry hides and shows what it names.
    fn keys(&self) -> Markup {
        html! {
            ul class="keys" {
                @for (k, layer) in self.layers.iter().enumerate() {
                    li { button type="button" aria-pressed="true" data-layer=(k) {
                        svg viewBox="0 0 26 12" aria-hidden="true" class={ "i" (layer.ink as usize) } { (sample(&layer.shape)) }
                        (layer.name)
                    } }
                }
            }
        }
    }

    fn frame(&self) -> Markup {
        let (width, height) = (self.size.0 - LEFT - RIGHT, self.size.1 - TOP - BOTTOM);
        let (right, bottom) = (LEFT + width, TOP + height);
        let ticks = |scale: &Scale| -> Vec<(f64, String)> {
            let place = |tick: crate::plots::axis::Tick| Some((scale.axis.place(tick.at)?, tick.label?));
            scale.axis.ticks(TICKS).into_iter().filter_map(place).collect()
        };
        let upright = format!("rotate(-90 20 {})", TOP + height / 2.0);
        html! {
            g class="xt" {
                @for (share, label) in ticks(&self.x) {
                    @let x = short(LEFT + share * width);
                    line class="rule" x1=(x) x2=(x) y1=(TOP) y2=(bottom) {}
                    text class="tick" x=(x) y=(bottom + 20.0) text-anchor="middle" { (label) }
                }
            }
            @for (share, label) in ticks(&self.y) {
                @let y = short(bottom - share * height);
                line class="rule" x1=(LEFT) x2=(right) y1=(y) y2=(y) {}
                text class="tick" x=(LEFT - 8.0) y=(y) dy="0.35em" text-anchor="end" { (label) }
            }
            rect class="frame" x=(LEFT) y=(TOP) width=(width) height=(height) {}
            text x=(LEFT + width / 2.0) y=(self.size.1 - 10.0) text-anchor="middle" { (self.x.name) }
            text class="upright" x="20" y=(TOP + height / 2.0) text-anchor="middle" transform=(upright) { (self.y.name) }
        }
    }

    fn drawn(&self, shape: &Shape) -> Markup {
        let path = |class: &str, d: String| html! { @if !d.is_empty() { path class=(class) d=(d) {} } };
        match shape {
            Shape::Line(points) => path("line", self.path(points)),
            Shape::Wide(points) => path("wide", self.path(points)),
            Shape::Dashes(points) => path("dash", self.path(points)),
            Shape::Dots(points) => path("dots", self.path(points)),
            Shape::Band(band) => {
                let upper = band.iter().map(|&(x, _, high)| (x, high));
                let around: Vec<_> = upper.chain(band.iter().rev().map(|&(x, low, _)| (x, low))).collect();
                path("band", self.path(&around))
            }
            Shape::Patches(patches) => path("band", patches.iter().map(|patch| self.path(patch)).collect()),
            Shape::Stems(stems) => {
                path("stem stems", stems.iter().map(|&(x, y)| self.path(&[(x, 0.0), (x, y)])).collect())
            }
            Shape::Marks(marks) => {
                self.marks(marks, "disc", |(x, y)| format!("M{} {}h0", short(x), short(y)))
            }
            Shape::Crosses(marks) => self.marks(marks, "cross", |(x, y)| {
                let (dx, dy) = (6000.0 / self.size.0, 6000.0 / self.size.1);
                let [left, right, top, bottom] = [x - dx, x + dx, y - dy, y + dy].map(short);
                let centre = format!("M{} {}h0", short(x), short(y));
                format!("{centre}M{left} {top} {right} {bottom}M{left} {bottom} {right} {top}")
            }),
        }
    }

    fn marks(&self, marks: &[Mark], class: &str, sign: impl Fn((f64, f64)) -> String) -> Markup {
        html! {
            @for mark in marks {
                @if let Some((low, high)) = mark.ends { path class="stem" d=(self.path(&[(mark.at.0, low), (mark.at.0, high)])) {} }
                @if let Some(place) = self.place(mark.at) { path class=(class) data-t=(mark.told) d=(sign(place)) {} }
            }
        }
    }

    /// Lines through points; what has no place on the axes leaves a gap.
    fn path(&self, points: &[(f64, f64)]) -> String {
        let mut d = String::new();
        let mut is_begun = false;
        for &point in points {
            let Some((x, y)) = self.place(point) else {
                is_begun = false;
                continue;
            };
            let _ = write!(d, "{}{} {}", if is_begun { " " } else { "M" }, short(x), short(y));
            is_begun = true;
        }
        d
    }

    /// A place on the square, clamped to a sheet around it.
    fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        if !(x.is_finite() && y.is_finite()) {
            return None;
        }
        let inside = |share: f64| (share * WHOLE).clamp(-WHOLE, 2.0 * WHOLE);
        Some((inside(self.x.axis.place(x)?), inside(1.0 - self.y.axis.place(y)?)))
    }
}

/// What stands in the key.
fn sample(shape: &Shape) -> Markup {
    let svg = match shape {
        Shape::Line(_) => "<path d='M0 6H26' stroke-width='2.5'/>",
        Shape::Wide(_) => "<path d='M0 6H26' stroke-width='5'/>",
        Shape::Dashes(_) => "<path d='M0 6H26' stroke-width='2.5' stroke-dasharray='6 4'/>",
        Shape::Dots(_) => "<path d='M0 6H26' stroke-width='2.5' stroke-dasharray='2 3'/>",
        Shape::Band(_) | Shape::Patches(_) => "<rect width='26' height='12' opacity='.3' stroke='none'/>",
        Shape::Marks(_) => "<circle cx='13' cy='6' r='4' stroke='none'/>",
        Shape::Crosses(_) => "<path d='M8 1L18 11M8 11L18 1' stroke-width='2.5'/>",
        Shape::Stems(_) => "<path d='M7 12V2M13 12V5M19 12V8' stroke-width='2.5'/>",
    };
    PreEscaped(svg.to_owned())
}

/// A tenth of a unit: a ten-thousandth of the frame.
fn short(x: f64) -> f64 {
    (x * 10.0).round() / 10.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(shape: Shape) -> String {
        let chart = Chart {
            title: "a <title>".to_owned(),
            note: String::new(),
            x: Scale::linear("x [mm]", [0.0, 10.0]),
            y: Scale::linear("y", [-1.0, 1.0]),
            layers: vec![Layer::new("one & only", Ink::Blue, shape)],
            reading: Reading::default(),
            size: HALF,
        };
        chart.html().into_string()
    }

    #[test]
    fn what_is_no_number_leaves_a_gap() {
        let html = chart(Shape::Line(vec![(0.0, 0.0), (1.0, f64::NAN), (5.0, 0.0), (10.0, 1.0)]));
        assert!(html.contains("d=\"M45.5 500M500 500 954.5 45.5\""), "{html}");
    }

    #[test]
    fn names_are_escaped_and_axes_say_what_the_script_reads() {
        let html = chart(Shape::Band(vec![(0.0, -1.0, 1.0), (10.0, -1.0, 1.0)]));
        assert!(html.contains("a &lt;title&gt;") && html.contains("one &amp; only"));
        assert!(html.contains("data-x=\"lin -0.5 10.5\""), "{html}");
        assert_eq!(Scale::logarithmic("f", [1.0, 100.0]).words().split(' ').next(), Some("log"));
        assert_eq!(Scale::linear("f", [1.0, 100.0]).words().split(' ').next(), Some("lin"));
    }

    #[test]
    fn what_runs_away_stays_near_the_frame() {
        let html = chart(Shape::Line(vec![(0.0, 0.0), (10.0, 1e300)]));
        assert!(html.contains("954.5 -1000\""), "{html}");
    }
}
