//! Measured, nominal and augmented output of one hold-out record.

use crate::plots::axis::Axis;
use crate::plots::canvas::{Canvas, Dash};
use crate::plots::identify::series::{thinned, worst_window};
use crate::plots::labelled;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::Panel;
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{AFTER, BEFORE, FAINT, GREY, PALE, Pen, WIDTH, tint};
use std::ops::Range;
use switchback_diagnose::HoldoutSeries;
use switchback_io::diagnosis::{Report, Units, fit_percent};

/// Samples of the stretch that is drawn enlarged.
const WINDOW: usize = 300;

type Series = Vec<(f64, f64)>;

/// Above, the errors over the whole record; in the middle, enlarged, the outputs where the model under diagnosis misses
/// most; below, the errors there.
pub(super) fn figure(report: &Report, series: &HoldoutSeries) -> String {
    let drawing = Drawing::new(report, series);
    let before = report.source.label();
    let mut sheet = Sheet::new(
        drawing.title(),
        vec![format!(
            "Free runs, from v alone. The dotted lines are the noise floor, ±2 sd; the shaded stretch, where the {} misses most, is \
             enlarged below.",
            report.source.model()
        )],
        Grid { apart: 76.0, ..Grid::new(3, 1, 200.0) },
    );
    if series.measured.is_empty() {
        return sheet.empty("The record has no sample.");
    }
    sheet.legend = vec![
        Entry::new(Sample::Line(Pen::broad(tint(GREY, PALE))), "measured"),
        Entry::line(BEFORE, format!("{before}, and measured − {before}")),
        Entry::line(AFTER, "augmented, and measured − augmented"),
    ];
    sheet.render(|canvas, frames| {
        drawing.errors(canvas, frames, 0, 0..series.measured.len());
        drawing.outputs(canvas, frames, 1);
        drawing.errors(canvas, frames, 2, drawing.window.clone());
    })
}

struct Drawing<'a> {
    report: &'a Report,
    series: &'a HoldoutSeries,
    window: Range<usize>,
    before: Vec<f64>,
    after: Vec<f64>,
}

impl<'a> Drawing<'a> {
    fn new(report: &'a Report, series: &'a HoldoutSeries) -> Self {
        let missed = |run: &[f64]| series.measured.iter().zip(run).map(|(y, s)| y - s).collect::<Vec<f64>>();
        let (before, after) = (missed(&series.nominal), missed(&series.augmented));
        let start = worst_window(&before, WINDOW);
        let window = start..(start + WINDOW).min(before.len());
        Self { report, series, window, before, after }
    }

    fn title(&self) -> String {
        let fits = self.report.diagnosis.gap.per_record.iter().find(|r| r.record == self.series.record);
        let fits = fits.map_or_else(String::new, |r| {
            format!(": fit {} % before, {} % after", fit_percent(r.fit_before), fit_percent(r.fit_after))
        });
        format!("{}, record {}{fits}", self.report.rig.name, self.series.record)
    }

    fn timed(&self, values: &[f64], stretch: &Range<usize>) -> Series {
        stretch.clone().map(|k| (k as f64 * self.report.rig.sample_time, values[k])).collect()
    }

    /// Range of the measured output. A run that leaves it further than this must not flatten all else to a line.
    fn reach(&self) -> f64 {
        let [low, high] = extremes(self.series.measured.iter().copied());
        (high - low).max(f64::MIN_POSITIVE)
    }

    /// Errors over a stretch of samples; over the whole record the enlarged stretch is shaded.
    fn errors(&self, canvas: &Canvas, frames: &Frames, row: usize, stretch: Range<usize>) {
        let (before, after) = (self.timed(&self.before, &stretch), self.timed(&self.after, &stretch));
        let floor = 2.0 * self.report.diagnosis.gap.noise_floor;
        let reach = self.reach();
        let errors = before.iter().chain(&after).map(|p| p.1.clamp(-reach, reach));
        let shown = errors.chain([floor.min(reach), -floor.min(reach)]);
        let y = Axis::linear(shown);
        let x = Axis::linear([before[0].0, before[before.len() - 1].0]);
        let whole = stretch.len() > self.window.len();
        if whole {
            let (corner, size) = (frames.corner(row, 0), frames.size());
            let edge = |k: usize| {
                let t = k as f64 * self.report.rig.sample_time;
                corner.0 + size.0 * x.place(t).unwrap_or(0.0)
            };
            let ends = (edge(self.window.start), edge(self.window.end - 1));
            canvas.fill((ends.0, corner.1), (ends.1, corner.1 + size.1), FAINT);
        }
        let panel = frames.panel(canvas, (row, 0), (x, y));
        for level in [floor, -floor] {
            panel.level(level, Some(Dash::Dots), Pen::data(GREY));
        }
        for (line, colour) in [(before, BEFORE), (after, AFTER)] {
            panel.line(&thinned(&line, WIDTH as usize), Pen::data(colour));
        }
        panel.title(if whole { "errors over the whole record" } else { "errors, enlarged" });
        self.names(&panel, &format!("error [{}]", Units::of(&self.report.rig).output));
    }

    fn outputs(&self, canvas: &Canvas, frames: &Frames, row: usize) {
        let lines = [
            (&self.series.measured, Pen::broad(tint(GREY, PALE))),
            (&self.series.nominal, Pen::data(BEFORE)),
            (&self.series.augmented, Pen::data(AFTER)),
        ];
        let lines = lines.map(|(values, pen)| (self.timed(values, &self.window), pen));
        let times = &lines[0].0;
        let x = Axis::linear([times[0].0, times[times.len() - 1].0]);
        let [low, high] = extremes(lines[0].0.iter().map(|p| p.1));
        let reach = self.reach();
        let inside = |y: f64| y.clamp(low - reach, high + reach);
        let y = Axis::linear(lines.iter().flat_map(|(line, _)| line.iter().map(|p| inside(p.1))));
        let panel = frames.panel(canvas, (row, 0), (x, y));
        for (line, pen) in &lines {
            panel.line(line, *pen);
        }
        panel.title(&format!(
            "outputs, enlarged: the {} samples where the {} misses most",
            self.window.len(),
            self.report.source.model()
        ));
        self.names(&panel, &labelled(&self.report.rig.output_label, "output units"));
    }

    fn names(&self, panel: &Panel<'_>, y: &str) {
        panel.x_name("time since the record's start [s]");
        panel.y_name(y, 64.0);
    }
}

fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}
