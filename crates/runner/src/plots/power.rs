//! From which size on faults would have been found.

use super::canvas::{Canvas, Pen, TextLook};
use super::legend::{Entry, Sample};
use super::palette::{FAINT, GREY, INK, OKABE_ITO, tint};
use super::sheet::{Frames, Grid, Sheet};
use crate::power::{Finding, LARGEST, Outcome, Power};

/// Height of an effect's row, pixels.
const ROW: f64 = 26.0;
/// The sizes at the ends of the axis: half of the least that is tried, and a little more than the largest.
const ENDS: [f64; 2] = [0.25, 12.0];
const MARKS: [f64; 5] = [0.5, 1.0, 2.0, 4.0, LARGEST];

/// A row an effect: every fault that was put in, found or not, and the size from which nine in ten are found with its interval.
pub fn figure(power: &Power, rig: &str) -> String {
    let found = Pen::new(OKABE_ITO[0], 1.5);
    let missed = Pen::new(GREY, 1.5);
    let legend = vec![
        Entry::new(Sample::Disc(found, true), "a fault that was found"),
        Entry::new(Sample::Disc(missed, false), "one that was not"),
        Entry::new(Sample::Line(Pen::new(INK, 3.0)), "from here on nine in ten are found"),
        Entry::new(Sample::Line(Pen::new(tint(OKABE_ITO[0], 0.3), 10.0)), "90 % interval of that size"),
    ];
    let sheet = Sheet {
        title: format!("{rig}: which faults would have been found"),
        notes: vec![
            "Size: what is left of a fault on held-out records after identification anew, over what the model misses there without it.".to_owned(),
        ],
        legend,
        grid: Grid {
            columns: 1,
            rows: 1,
            height: ROW * power.findings.len() as f64,
            left: 190.0,
            between: 24.0,
            above: 40.0,
        },
    };
    sheet.render(|canvas, frames| {
        let bottom = frames.corner(0, 0).1 + frames.size().1;
        for size in MARKS {
            let x = place(frames, size);
            canvas.line(&[(x, frames.corner(0, 0).1), (x, bottom)], Pen::new(FAINT, 1.0));
            let look = TextLook::new(14.0).middle();
            canvas.text(&size.to_string(), (x, frames.corner(0, 0).1 - 12.0), look);
        }
        for (i, finding) in power.findings.iter().enumerate() {
            row(canvas, frames, i, finding);
        }
    })
}

/// Where a size lies, logarithmically; sizes beyond the ends lie at them.
fn place(frames: &Frames, size: f64) -> f64 {
    let share = (size.clamp(ENDS[0], ENDS[1]) / ENDS[0]).ln() / (ENDS[1] / ENDS[0]).ln();
    frames.corner(0, 0).0 + share * frames.size().0
}

fn row(canvas: &Canvas<'_>, frames: &Frames, index: usize, finding: &Finding) {
    let (left, top) = frames.corner(0, 0);
    let middle = top + ROW * (index as f64 + 0.5);
    canvas.text(finding.effect, (left - 10.0, middle), TextLook::new(15.0).end());
    let outcome = finding.outcome();
    if let Outcome::NotPlanted(_) = outcome {
        canvas.text("cannot be planted", (left + 8.0, middle), TextLook::new(14.0).colour(GREY));
        return;
    }
    let [low, high] = finding.conclusion.interval.map(|size| place(frames, size));
    // One that begins beyond the sizes asked for has no place here.
    if finding.conclusion.interval[0].is_finite() {
        canvas.fill((low, middle - 8.0), (high.max(low + 1.0), middle + 8.0), tint(OKABE_ITO[0], 0.3));
    }
    if let Outcome::From(size) = outcome {
        let x = place(frames, size);
        canvas.line(&[(x, middle - 11.0), (x, middle + 11.0)], Pen::new(INK, 3.0));
    }
    for (fault, answer) in finding.diagnosed() {
        let colour = if answer.is_found() { OKABE_ITO[0] } else { GREY };
        canvas.disc((place(frames, fault.size), middle), 4.0, Pen::new(colour, 1.5), answer.is_found());
    }
}
