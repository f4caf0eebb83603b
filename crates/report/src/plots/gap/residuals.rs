//! Autocorrelation and spectrum of the one-step errors, before and after.

use crate::plots::axis::Axis;
use crate::plots::canvas::{Canvas, Dash};
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::Mark;
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{AFTER, BEFORE, GREY, Pen, SMALL_RADIUS, Shape};
use plotters::style::RGBColor;
use switchback_diagnose::ResidualPicture;
use switchback_io::diagnosis::Report;

/// Autocorrelations with the band of white noise, and spectra.
pub(super) fn figure(report: &Report) -> String {
    let mut sheet = Sheet::new(
        format!("{}: what the model misses, before and after", report.rig.name),
        vec![
            "Errors one step ahead on the fit records. White noise stays within the dotted band at 19 of 20 lags, and has a flat spectrum."
                .to_owned(),
        ],
        Grid { between: 92.0, ..Grid::new(1, 2, 300.0) },
    );
    sheet.legend = vec![
        Entry::new(Sample::Mark(Shape::Disc, Pen::data(BEFORE), false), "nominal model"),
        Entry::disc(AFTER, "augmented model"),
    ];
    let diagnosis = &report.diagnosis;
    if [&diagnosis.residuals_before, &diagnosis.residuals_after].iter().all(|p| p.autocorrelation.is_empty())
    {
        return sheet.empty(
            "No errors one step ahead are known: the fit records are too short, or there is no model.",
        );
    }
    let pictures = [(&diagnosis.residuals_before, BEFORE, false), (&diagnosis.residuals_after, AFTER, true)];
    sheet.render(|canvas, frames| {
        autocorrelation(canvas, frames, &pictures);
        let unit = switchback_io::identification::unit(&report.rig.output_label);
        spectrum(canvas, frames, &pictures, (report.rig.sample_time, unit));
    })
}

type Picture<'a> = (&'a ResidualPicture, RGBColor, bool);

fn autocorrelation(canvas: &Canvas, frames: &Frames, pictures: &[Picture<'_>; 2]) {
    let lags = pictures.iter().map(|(p, ..)| p.autocorrelation.len()).max().unwrap_or(1).max(2) - 1;
    let band = pictures[1].0.band;
    let values = pictures.iter().flat_map(|(p, ..)| p.autocorrelation.iter().skip(1).copied());
    let y = Axis::linear(values.chain([2.0 * band, -2.0 * band, 0.0]));
    let x = Axis::linear([0.0, lags as f64 + 1.0]);
    let panel = frames.panel(canvas, (0, 0), (x, y));
    panel.level(0.0, None, Pen::hair(GREY));
    for edge in [band, -band] {
        panel.level(edge, Some(Dash::Dots), Pen::data(GREY));
    }
    for (i, (picture, colour, filled)) in pictures.iter().enumerate() {
        let aside = if i == 0 { -3.0 } else { 3.0 };
        let mark = Mark { filled: *filled, aside, ..Mark::disc(Pen::data(*colour), SMALL_RADIUS) };
        for (lag, r) in picture.autocorrelation.iter().enumerate().skip(1) {
            panel.mark(lag as f64, *r, (r.min(0.0), r.max(0.0)), mark);
        }
    }
    panel.title("autocorrelation");
    panel.x_name("lag [samples]");
    panel.y_name("correlation", 62.0);
}

fn spectrum(canvas: &Canvas, frames: &Frames, pictures: &[Picture<'_>; 2], (sample_time, unit): (f64, &str)) {
    // Per hertz instead of per cycle a sample.
    let lines = pictures.map(|(p, colour, _)| {
        let points = p.frequency.iter().zip(&p.spectrum);
        let line: Vec<(f64, f64)> = points.skip(1).map(|(f, s)| (f / sample_time, s * sample_time)).collect();
        (line, colour)
    });
    let x = Axis::linear(lines.iter().flat_map(|(line, _)| line.iter().map(|p| p.0)));
    let y = Axis::logarithmic(lines.iter().flat_map(|(line, _)| line.iter().map(|p| p.1)));
    let panel = frames.panel(canvas, (0, 1), (x, y));
    for (line, colour) in &lines {
        panel.line(line, Pen::data(*colour));
    }
    panel.title("power spectrum");
    panel.x_name("frequency [Hz]");
    let unit = if unit.is_empty() { "output units".to_owned() } else { unit.to_owned() };
    panel.y_name(&format!("density [({unit})²/Hz]"), 70.0);
}
