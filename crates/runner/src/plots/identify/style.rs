//! What both figures share: colours, letters, the row that explains the lines.

use miette::Diagnostic;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::fmt::Display;
use thiserror::Error;

/// A figure could not be drawn.
#[derive(Debug, Error, Diagnostic)]
#[error("a figure could not be drawn: {reason}")]
pub struct PlotError {
    reason: String,
}

impl PlotError {
    /// From whatever the drawing library said.
    pub(super) fn new(reason: impl Display) -> Self {
        Self { reason: reason.to_string() }
    }
}

/// A drawing area on SVG text.
pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Colours of Okabe and Ito (2008), which readers with any colour vision tell apart, plus a grey for what is given.
pub(super) const MEASURED: RGBColor = RGBColor(0x99, 0x99, 0x99);
pub(super) const SIMULATED: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
pub(super) const ERROR: RGBColor = RGBColor(0x00, 0x72, 0xB2);
pub(super) const DESCENDING: RGBColor = RGBColor(0x00, 0x72, 0xB2);
pub(super) const ASCENDING: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
pub(super) const BOTH: RGBColor = RGBColor(0x00, 0x9E, 0x73);
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
pub(super) const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

const FONT: &str = "sans-serif";

/// Text of a size, in the ink of the page.
pub(super) fn letters(size: u32) -> TextStyle<'static> {
    (FONT, size).into_font().color(&INK)
}

/// Draws the title and, under it, one line sample and name a series; returns what is left below them.
///
/// The names stand outside the axes, so that they never cover data.
pub(super) fn header<'a>(
    canvas: &Canvas<'a>,
    title: &str,
    names: &[(&str, RGBColor)],
) -> Result<Canvas<'a>, PlotError> {
    let (head, body) = canvas.split_vertically(62);
    head.draw(&Text::new(title.to_owned(), (16, 12), letters(20))).map_err(PlotError::new)?;
    let mut x = 18;
    for (name, colour) in names {
        let sample = PathElement::new([(x, 49), (x + 26, 49)], colour.stroke_width(3));
        head.draw(&sample).map_err(PlotError::new)?;
        head.draw(&Text::new((*name).to_owned(), (x + 33, 42), letters(15))).map_err(PlotError::new)?;
        // A letter of this size takes about seven pixels.
        x += 33 + 7 * name.chars().count() as i32 + 26;
    }
    Ok(body)
}

/// The range of some values with a margin of 5 %, never empty.
pub(super) fn range(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) = values
        .filter(|x| x.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return -1.0..1.0;
    }
    let margin = if high > low { 0.05 * (high - low) } else { 0.5 * high.abs().max(1.0) };
    low - margin..high + margin
}

/// A tick label for an axis of the given length: enough decimals to tell neighbours apart, no trailing noise.
pub(super) fn tick(length: f64) -> impl Fn(&f64) -> String {
    let decimals = (1.0 - length.log10().floor()).clamp(0.0, 9.0) as usize;
    move |x| {
        // Adding zero turns the −0 of rounding into 0.
        let rounded = format!("{x:.decimals$}").parse::<f64>().unwrap_or(*x) + 0.0;
        let text = format!("{rounded:.decimals$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
            .replace('-', "−")
    }
}
