//! Autocorrelation and spectrum of the one-step errors, before and after.

use crate::diagnosis::Report;
use crate::plots::axis::Axis;
use crate::plots::canvas::{Canvas, Dash, Pen};
use crate::plots::legend::{Entry, Sample};
use crate::plots::palette::{GREY, OKABE_ITO};
use crate::plots::panel::{Mark, Panel};
use crate::plots::sheet::{Frames, Grid, Sheet};
use plotters::style::RGBColor;
use switchback_gap::ResidualPicture;

const BEFORE: RGBColor = OKABE_ITO[1];
const AFTER: RGBColor = OKABE_ITO[0];

/// Autocorrelations with the band of white noise, and spectra.
pub(super) fn figure(report: &Report) -> String {
    let sheet = Sheet {
        title: format!("{}: what the model misses, before and after", report.rig.name),
        notes: vec!["Fit records. White noise stays within the dotted band at 19 of 20 lags, and has a flat spectrum.".to_owned()],
        legend: vec![
            Entry::new(Sample::Disc(Pen::new(BEFORE, 1.5), false), "nominal model"),
            Entry::new(Sample::Disc(Pen::new(AFTER, 1.5), true), "augmented model"),
        ],
        grid: Grid { columns: 2, rows: 1, height: 330.0, left: 86.0, between: 110.0, above: 44.0 },
    };
    let diagnosis = &report.diagnosis;
    let pictures = [(&diagnosis.residuals_before, BEFORE, false), (&diagnosis.residuals_after, AFTER, true)];
    sheet.render(|canvas, frames| {
        autocorrelation(canvas, frames, &pictures);
        let unit = crate::identification::unit(&report.rig.output_label);
        spectrum(canvas, frames, &pictures, (report.rig.sample_time, unit));
    })
}

type Picture<'a> = (&'a ResidualPicture, RGBColor, bool);

fn autocorrelation(canvas: &Canvas<'_>, frames: &Frames, pictures: &[Picture<'_>; 2]) {
    let lags = pictures.iter().map(|(p, ..)| p.autocorrelation.len()).max().unwrap_or(1).max(2) - 1;
    let band = pictures[1].0.band;
    let values = pictures.iter().flat_map(|(p, ..)| p.autocorrelation.iter().skip(1).copied());
    let y = Axis::linear(values.chain([2.0 * band, -2.0 * band, 0.0]));
    let x = Axis::linear([0.0, lags as f64 + 1.0]);
    let panel = Panel::new(canvas, frames.corner(0, 0), frames.size(), (x, y));
    let level = |at: f64| [(x.low(), at), (x.high(), at)];
    panel.line(&level(0.0), Pen::new(GREY, 1.0));
    for edge in [band, -band] {
        panel.dashes(&level(edge), Dash::Dots, Pen::new(GREY, 1.2));
    }
    for (i, (picture, colour, filled)) in pictures.iter().enumerate() {
        let aside = if i == 0 { -3.0 } else { 3.0 };
        let mark = Mark { pen: Pen::new(*colour, 1.5), radius: 3.0, filled: *filled, aside };
        for (lag, r) in picture.autocorrelation.iter().enumerate().skip(1) {
            panel.mark(lag as f64, *r, (r.min(0.0), r.max(0.0)), mark);
        }
    }
    panel.title("autocorrelation");
    panel.x_name("lag [samples]");
    panel.y_name("correlation", 62.0);
}

fn spectrum(
    canvas: &Canvas<'_>,
    frames: &Frames,
    pictures: &[Picture<'_>; 2],
    (sample_time, unit): (f64, &str),
) {
    // Per hertz instead of per cycle a sample.
    let lines = pictures.map(|(p, colour, _)| {
        let points = p.frequency.iter().zip(&p.spectrum);
        let line: Vec<(f64, f64)> = points.skip(1).map(|(f, s)| (f / sample_time, s * sample_time)).collect();
        (line, colour)
    });
    let x = Axis::linear(lines.iter().flat_map(|(line, _)| line.iter().map(|p| p.0)));
    let y = Axis::logarithmic(lines.iter().flat_map(|(line, _)| line.iter().map(|p| p.1)));
    let panel = Panel::new(canvas, frames.corner(0, 1), frames.size(), (x, y));
    for (line, colour) in &lines {
        panel.line(line, Pen::new(*colour, 1.8));
    }
    panel.title("power spectrum");
    panel.x_name("frequency [Hz]");
    let unit = if unit.is_empty() { "output units".to_owned() } else { unit.to_owned() };
    panel.y_name(&format!("density [({unit})²/Hz]"), 70.0);
}
