//! A legend above the diagrams, where it covers nothing.

use super::canvas::{Canvas, Dash, Pen, TextLook, text_width};

/// What stands beside a legend's text.
#[derive(Debug, Clone, Copy)]
pub enum Sample {
    /// A disc, filled or hollow.
    Disc(Pen, bool),
    /// A line.
    Line(Pen),
    /// A broken line.
    Dashes(Pen, Dash),
    /// An error bar.
    Bar(Pen),
}

/// One entry.
#[derive(Debug, Clone)]
pub struct Entry {
    /// What the figure shows.
    pub sample: Sample,
    /// What it means.
    pub text: String,
}

impl Entry {
    /// An entry.
    pub fn new(sample: Sample, text: impl Into<String>) -> Self {
        Self { sample, text: text.into() }
    }
}

const TEXT: f64 = 16.0;
const SAMPLE_WIDTH: f64 = 28.0;
const GAP: f64 = 24.0;

/// Height of one line of the legend, pixels.
pub const LINE: f64 = 24.0;

/// Breaks entries into lines no wider than `width` pixels.
pub fn lines(entries: &[Entry], width: f64) -> Vec<Vec<&Entry>> {
    let mut lines: Vec<Vec<&Entry>> = vec![Vec::new()];
    let mut used = 0.0;
    for entry in entries {
        let wide = entry_width(entry);
        if used > 0.0 && used + wide > width {
            lines.push(Vec::new());
            used = 0.0;
        }
        lines.last_mut().expect("there is a first line").push(entry);
        used += wide;
    }
    lines
}

fn entry_width(entry: &Entry) -> f64 {
    SAMPLE_WIDTH + 8.0 + text_width(&entry.text, TEXT) + GAP
}

/// Draws the lines, the first at `top`.
pub fn draw(canvas: &Canvas<'_>, (left, top): (f64, f64), lines: &[Vec<&Entry>]) {
    for (i, line) in lines.iter().enumerate() {
        let (mut x, y) = (left, top + i as f64 * LINE);
        for entry in line {
            sample(canvas, (x, y), entry.sample);
            canvas.text(&entry.text, (x + SAMPLE_WIDTH + 8.0, y), TextLook::new(TEXT));
            x += entry_width(entry);
        }
    }
}

fn sample(canvas: &Canvas<'_>, (x, y): (f64, f64), sample: Sample) {
    let ends = [(x, y), (x + SAMPLE_WIDTH, y)];
    let middle = (x + SAMPLE_WIDTH / 2.0, y);
    match sample {
        Sample::Disc(pen, filled) => canvas.disc(middle, 5.0, pen, filled),
        Sample::Line(pen) => canvas.line(&ends, pen),
        Sample::Dashes(pen, dash) => canvas.dashes(&ends, dash, pen),
        Sample::Bar(pen) => {
            let (foot, head) = ((middle.0, y + 9.0), (middle.0, y - 9.0));
            canvas.line(&[foot, head], pen);
            for end in [foot, head] {
                canvas.line(&[(end.0 - 3.0, end.1), (end.0 + 3.0, end.1)], pen);
            }
        }
    }
}
