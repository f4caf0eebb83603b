//! From which size on faults would have been found.

use super::axis::Axis;
use super::canvas::{Canvas, Towards};
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::sheet::{Frames, Grid, Sheet};
use super::style::{GREY, INK, OKABE_ITO, PALE, Pen, RADIUS, Shape, TextLook, tint};
use switchback_lab::power::{Finding, LARGEST, Outcome, Power};

/// Height of an effect's row, half the height of its interval and of the mark in it, pixels.
const ROW: f64 = 26.0;
const HALF_INTERVAL: f64 = 8.0;
const HALF_MARK: f64 = 11.0;
/// The least size that has a place.
const LEAST: f64 = 0.25;

/// A row an effect: every fault that was put in, found or not, and the size from which nine in ten are found with its interval.
pub fn figure(power: &Power, rig: &str) -> String {
    let rows = power.findings.len();
    let mut sheet = Sheet::new(
        format!("{rig}: which faults would have been found"),
        vec![
            "Size: what is left of a fault on held-out records after identification anew, over what the model misses there without it."
                .to_owned(),
        ],
        Grid { left: 190.0, ..Grid::new(1, 1, ROW * rows as f64) },
    );
    if rows == 0 {
        return sheet.empty("No effect was asked for.");
    }
    sheet.legend = vec![
        Entry::disc(OKABE_ITO[0], "a fault that was found"),
        Entry::new(Sample::Mark(Shape::Disc, Pen::data(GREY), false), "one that was not"),
        Entry::new(Sample::Line(Pen::broad(INK)), "from here on nine in ten are found"),
        Entry::patch(tint(OKABE_ITO[0], PALE), "90 % interval of that size"),
        Entry::new(Sample::Arrow(Towards::Right, GREY), "beyond the frame"),
    ];
    let axes = (Axis::doublings([LEAST, LARGEST]), Axis::rows(rows as f64));
    sheet.render(|canvas, frames| {
        // Intervals stand behind the grid.
        for (i, finding) in power.findings.iter().enumerate() {
            name(canvas, frames, (i, axes.0), finding);
        }
        let panel = frames.panel(canvas, (0, 0), axes);
        panel.x_name("size of the fault");
        for (i, finding) in power.findings.iter().enumerate() {
            row(canvas, &panel, (i, axes.0), finding);
        }
    })
}

/// What an effect is called, and the interval of its size.
fn name(canvas: &Canvas, frames: &Frames, (index, axis): (usize, Axis), finding: &Finding) {
    let ((left, top), width) = (frames.corner(0, 0), frames.size().0);
    let middle = top + ROW * (index as f64 + 0.5);
    canvas.text(finding.effect, (left - 10.0, middle), TextLook::label().end());
    let [low, high] = finding.conclusion.interval;
    let is_planted = !matches!(finding.outcome(), Outcome::NotInjected(_));
    // One that begins beyond the sizes asked for has no place here.
    if is_planted && low.is_finite() {
        let place = |size: f64| left + width * axis.place(axis.clamp(size)).unwrap_or(0.0);
        let (low, high) = (place(low), place(high));
        let corner = (low, middle - HALF_INTERVAL);
        canvas.fill(corner, (high.max(low + 1.0), middle + HALF_INTERVAL), tint(OKABE_ITO[0], PALE));
    }
}

fn row(canvas: &Canvas, panel: &Panel<'_>, (index, axis): (usize, Axis), finding: &Finding) {
    let middle = index as f64 + 0.5;
    let outcome = finding.outcome();
    if let Outcome::NotInjected(_) = outcome {
        panel.text("cannot be planted", (axis.low(), middle), (8.0, 0.0), TextLook::number().colour(GREY));
        return;
    }
    if let Outcome::From(size) = outcome
        && let Some((x, y)) = panel.place(axis.clamp(size), middle)
    {
        canvas.line(&[(x, y - HALF_MARK), (x, y + HALF_MARK)], Pen::broad(INK));
    }
    for (fault, answer) in finding.diagnosed() {
        let found = answer.is_found();
        let pen = Pen::data(if found { OKABE_ITO[0] } else { GREY });
        panel.point(fault.size, middle, Mark { filled: found, ..Mark::disc(pen, RADIUS) });
    }
}
