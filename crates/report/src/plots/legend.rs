//! A legend above the diagrams, where it covers nothing.

use super::canvas::{Canvas, Dash, Towards};
use super::style::{Pen, RADIUS, Shape, TextLook};
use plotters::style::RGBColor;

/// The picture beside a legend's text.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Sample {
    /// A mark, filled or hollow.
    Mark(Shape, Pen, bool),
    /// A line.
    Line(Pen),
    /// A broken line.
    Dashes(Pen, Dash),
    /// A line upon a broader one.
    Upon(Pen, Pen),
    /// An error bar.
    Bar(Pen),
    /// A filled rectangle.
    Patch(RGBColor),
    /// A value beyond the frame.
    Arrow(Towards, RGBColor),
}

/// One entry.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// The picture.
    pub sample: Sample,
    /// Its meaning.
    pub text: String,
    /// The series that a reader hides and shows by the entry.
    pub hides: Option<String>,
}

impl Entry {
    /// An entry.
    pub(crate) fn new(sample: Sample, text: impl Into<String>) -> Self {
        Self { sample, text: text.into(), hides: None }
    }

    /// The same for a series that a reader hides and shows by it.
    #[must_use]
    pub(crate) fn hiding(self, series: impl Into<String>) -> Self {
        Self { hides: Some(series.into()), ..self }
    }

    /// A filled disc.
    pub(crate) fn disc(colour: RGBColor, text: impl Into<String>) -> Self {
        Self::new(Sample::Mark(Shape::Disc, Pen::data(colour), true), text)
    }

    /// A filled rectangle.
    pub(crate) fn patch(colour: RGBColor, text: impl Into<String>) -> Self {
        Self::new(Sample::Patch(colour), text)
    }

    /// A line.
    pub(crate) fn line(colour: RGBColor, text: impl Into<String>) -> Self {
        Self::new(Sample::Line(Pen::data(colour)), text)
    }
}

const SAMPLE_WIDTH: f64 = 26.0;
const BESIDE: f64 = 7.0;
const GAP: f64 = 20.0;
/// Half the height of an error bar and of a rectangle, and half the width of the former's ends, pixels.
const HALF_BAR: f64 = 8.0;
const HALF_PATCH: f64 = 5.0;
const CAP: f64 = 3.0;

/// Height of one line of the legend, pixels.
pub(crate) const LINE: f64 = 23.0;

/// Breaks entries into lines no wider than `width` pixels.
pub(crate) fn lines(entries: &[Entry], width: f64) -> Vec<Vec<&Entry>> {
    let mut lines: Vec<Vec<&Entry>> = Vec::new();
    let mut used = 0.0;
    for entry in entries {
        let wide = entry_width(entry);
        match lines.last_mut() {
            Some(line) if used + wide - GAP <= width => line.push(entry),
            _ => {
                lines.push(vec![entry]);
                used = 0.0;
            }
        }
        used += wide;
    }
    lines
}

fn entry_width(entry: &Entry) -> f64 {
    SAMPLE_WIDTH + BESIDE + TextLook::label().width(&entry.text) + GAP
}

/// Draws the lines, the first at `top`.
pub(crate) fn draw(canvas: &Canvas, (left, top): (f64, f64), lines: &[Vec<&Entry>]) {
    for (i, line) in lines.iter().enumerate() {
        let (mut x, y) = (left, top + i as f64 * LINE);
        for entry in line {
            let draw = || {
                sample(canvas, (x, y), entry.sample);
                canvas.text(&entry.text, (x + SAMPLE_WIDTH + BESIDE, y), TextLook::label());
            };
            match &entry.hides {
                None => draw(),
                Some(series) => canvas.group(&[("hides", series)], || {
                    let right = x + entry_width(entry) - GAP + BESIDE;
                    canvas.ground((x - BESIDE, y - LINE / 2.0), (right, y + LINE / 2.0));
                    draw();
                }),
            }
            x += entry_width(entry);
        }
    }
}

fn sample(canvas: &Canvas, (x, y): (f64, f64), sample: Sample) {
    let ends = [(x, y), (x + SAMPLE_WIDTH, y)];
    let middle = (x + SAMPLE_WIDTH / 2.0, y);
    match sample {
        Sample::Mark(shape, pen, filled) => canvas.shape(shape, middle, RADIUS + 1.0, (pen, filled)),
        Sample::Line(pen) => canvas.line(&ends, pen),
        Sample::Dashes(pen, dash) => canvas.dashes(&ends, dash, pen),
        Sample::Upon(pen, broad) => {
            canvas.line(&ends, broad);
            canvas.line(&ends, pen);
        }
        Sample::Bar(pen) => {
            let (foot, head) = ((middle.0, y + HALF_BAR), (middle.0, y - HALF_BAR));
            canvas.line(&[foot, head], pen);
            for end in [foot, head] {
                canvas.line(&[(end.0 - CAP, end.1), (end.0 + CAP, end.1)], pen);
            }
        }
        Sample::Patch(colour) => canvas.fill((x, y - HALF_PATCH), (x + SAMPLE_WIDTH, y + HALF_PATCH), colour),
        Sample::Arrow(towards, colour) => {
            let half = HALF_BAR / 2.0;
            let tip = match towards {
                Towards::Up => (middle.0, y - half),
                Towards::Down => (middle.0, y + half),
                Towards::Left => (middle.0 - half, y),
                Towards::Right => (middle.0 + half, y),
            };
            canvas.arrow(tip, towards, HALF_BAR, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::style::INK;

    #[test]
    fn entries_fill_lines_and_none_is_lost() {
        let entries: Vec<Entry> = (0..7).map(|i| Entry::line(INK, format!("series number {i}"))).collect();
        let broken = lines(&entries, 400.0);
        assert!(broken.len() > 1);
        assert_eq!(broken.iter().map(Vec::len).sum::<usize>(), 7);
        let widths = broken.iter().map(|line| line.iter().map(|e| entry_width(e)).sum::<f64>() - GAP);
        assert!(widths.into_iter().all(|width| width <= 400.0));
        assert!(lines(&[], 400.0).is_empty());
    }
}
