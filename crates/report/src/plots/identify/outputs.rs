//! Measured against simulated output of one record.

use super::series::{thinned, worst_window};
use crate::plots::axis::Axis;
use crate::plots::canvas::Canvas;
use crate::plots::labelled;
use crate::plots::legend::{Entry, Sample};
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{AFTER, BEFORE, FAINT, GREY, PALE, Pen, WIDTH, tint};
use std::ops::Range;
use switchback_io::identification::FreeRun;
use switchback_model::rig::{Rig, RigRecord, Usage};

/// Samples of the stretch that is drawn enlarged.
const WINDOW: usize = 300;

/// A series over time: stamps in seconds, values in output units.
type Series = Vec<(f64, f64)>;

/// What the diagrams draw.
struct Drawing<'a> {
    label: &'a str,
    measured: Series,
    simulated: Series,
    errors: Series,
}

/// Above, over the whole record, what the simulation misses, before the measured output as a scale; below, enlarged, the
/// measured and the simulated output where it misses most.
pub fn outputs(rig: &Rig, record: &RigRecord, run: &FreeRun) -> String {
    let drawing = Drawing::new(rig, record, run);
    let samples = drawing.measured.len();
    let misses: Vec<f64> = drawing.errors.iter().map(|error| error.1).collect();
    let start = worst_window(&misses, WINDOW);
    let window = start..(start + WINDOW).min(samples);
    let notes = vec!["The shaded stretch, where the simulation misses most, is enlarged below.".to_owned()];
    let mut sheet =
        Sheet::new(title(rig, record, run), notes, Grid { apart: 76.0, ..Grid::new(2, 1, 230.0) });
    if samples == 0 {
        return sheet.empty("The record has no sample.");
    }
    sheet.legend = vec![
        Entry::new(Sample::Line(Pen::broad(tint(GREY, PALE))), "measured"),
        Entry::line(BEFORE, "simulated from v alone"),
        Entry::line(AFTER, "measured − simulated"),
    ];
    sheet.render(|canvas, frames| {
        drawing.panel(canvas, frames, (0, 0..samples), Some(window.clone()));
        drawing.panel(canvas, frames, (1, window), None);
    })
}

fn title(rig: &Rig, record: &RigRecord, run: &FreeRun) -> String {
    let usage = match record.usage {
        Usage::Fit => "fitted",
        Usage::Holdout => "held out",
    };
    let fit = match run.fit_percent {
        fit if fit.is_finite() => format!("fit {fit:.1} % in free run"),
        _ => "free run".to_owned(),
    };
    format!("{}, record {} ({usage}): {fit}", rig.name, record.name)
}

impl<'a> Drawing<'a> {
    fn new(rig: &'a Rig, record: &RigRecord, run: &FreeRun) -> Self {
        let stamped = |values: &mut dyn Iterator<Item = f64>| -> Series {
            values.enumerate().map(|(k, y)| (k as f64 * rig.sample_time, y)).collect()
        };
        let measured = record.record.y();
        Self {
            label: &rig.output_label,
            measured: stamped(&mut measured.iter().copied()),
            simulated: stamped(&mut run.simulated.iter().copied()),
            errors: stamped(&mut measured.iter().zip(&run.simulated).map(|(y, s)| y - s)),
        }
    }

    /// One diagram over a stretch of samples: with `shaded`, the whole record; without, the enlarged stretch.
    fn panel(
        &self,
        canvas: &Canvas,
        frames: &Frames,
        (row, stretch): (usize, Range<usize>),
        shaded: Option<Range<usize>>,
    ) {
        let (foreground, colour) =
            if shaded.is_some() { (&self.errors, AFTER) } else { (&self.simulated, BEFORE) };
        let (measured, drawn) = (&self.measured[stretch.clone()], &foreground[stretch.clone()]);
        let (x, y) = (Axis::linear(measured.iter().map(|p| p.0)), output_axis(measured, drawn));
        if let Some(window) = &shaded {
            let (corner, size) = (frames.corner(row, 0), frames.size());
            let edge = |k: usize| corner.0 + size.0 * x.place(self.measured[k].0).unwrap_or(0.0);
            let ends = (edge(window.start), edge(window.end - 1));
            canvas.fill((ends.0, corner.1), (ends.1, corner.1 + size.1), FAINT);
        }
        let panel = frames.panel(canvas, (row, 0), (x, y));
        for (points, pen) in [(measured, Pen::broad(tint(GREY, PALE))), (drawn, Pen::data(colour))] {
            let finite: Series = points.iter().copied().filter(|p| p.1.is_finite()).collect();
            panel.line(&thinned(&finite, WIDTH as usize), pen);
        }
        panel.title(&match shaded {
            Some(_) => "the whole record".to_owned(),
            None => format!("enlarged: the {} samples where the simulation misses most", stretch.len()),
        });
        panel.x_name("time since the record's start [s]");
        panel.y_name(&labelled(self.label, "output units"), 64.0);
    }
}

/// Room for both series, but never more than thrice the measured one's: a simulation that runs away must not flatten
/// the measured output to a line.
fn output_axis(measured: &[(f64, f64)], drawn: &[(f64, f64)]) -> Axis {
    let seen = Axis::linear(measured.iter().map(|p| p.1));
    let both = Axis::linear(measured.iter().chain(drawn).map(|p| p.1));
    let reach = seen.high() - seen.low();
    Axis::between(both.low().max(seen.low() - reach), both.high().min(seen.high() + reach))
}
