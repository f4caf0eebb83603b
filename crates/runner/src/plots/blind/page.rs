//! What the figures share: page, letters, colours, axes from 0 to 1.

use miette::Diagnostic;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::fmt::Display;
use thiserror::Error;

/// A figure could not be drawn.
#[derive(Debug, Error, Diagnostic)]
#[error("a figure of the examination could not be drawn: {0}")]
pub struct PlotError(String);

impl PlotError {
    /// From whatever the drawing library said.
    pub(super) fn new(reason: impl Display) -> Self {
        Self(reason.to_string())
    }
}

pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Colours of Okabe and Ito (2008), which readers with any colour vision tell apart.
pub(super) const COLOURS: [RGBColor; 4] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
];
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
pub(super) const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

pub(super) fn letters(size: u32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}

/// Draws on a page of the given size and returns its SVG.
pub(super) fn page(
    size: (u32, u32),
    draw: impl FnOnce(&Canvas<'_>) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        canvas.fill(&WHITE).map_err(PlotError::new)?;
        draw(&canvas)?;
        canvas.present().map_err(PlotError::new)?;
    }
    Ok(svg)
}

/// What stands beside the name of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sample {
    Line,
    Dot,
}

/// A title, the names of the series, and axes below them.
pub(super) struct Frame<'t> {
    pub(super) title: &'t str,
    pub(super) sample: Sample,
    pub(super) names: &'t [&'t str],
    pub(super) x: (&'t str, std::ops::Range<f64>),
    pub(super) y: (&'t str, std::ops::Range<f64>),
}

impl Frame<'_> {
    /// Draws the frame and lets `fill` draw the series into it.
    pub(super) fn draw(
        &self,
        canvas: &Canvas<'_>,
        x_label: impl Fn(&f64) -> String,
        fill: impl FnOnce(&mut Chart<'_, '_>) -> Result<(), PlotError>,
    ) -> Result<(), PlotError> {
        let (head, body) = canvas.split_vertically(58);
        head.draw(&Text::new(self.title.to_owned(), (16, 10), letters(19))).map_err(PlotError::new)?;
        let mut x = 18;
        for (name, colour) in self.names.iter().zip(COLOURS) {
            match self.sample {
                Sample::Line => head.draw(&PathElement::new([(x, 46), (x + 24, 46)], colour.stroke_width(3))),
                Sample::Dot => head.draw(&Circle::new((x + 12, 46), 4, colour.filled())),
            }
            .map_err(PlotError::new)?;
            head.draw(&Text::new((*name).to_owned(), (x + 30, 39), letters(14))).map_err(PlotError::new)?;
            x += 30 + 8 * name.chars().count() as i32 + 22;
        }
        let mut chart = ChartBuilder::on(&body)
            .margin(14)
            .x_label_area_size(44)
            .y_label_area_size(58)
            .build_cartesian_2d(self.x.1.clone(), self.y.1.clone())
            .map_err(PlotError::new)?;
        chart
            .configure_mesh()
            .x_desc(self.x.0)
            .y_desc(self.y.0)
            .axis_desc_style(letters(15))
            .label_style(letters(13))
            .x_label_formatter(&x_label)
            .y_label_formatter(&|y| tick(*y, 2))
            .bold_line_style(GRID)
            .light_line_style(WHITE)
            .draw()
            .map_err(PlotError::new)?;
        fill(&mut chart)
    }
}

/// A tick's figure; rounding must leave no minus before a zero.
pub(super) fn tick(x: f64, decimals: usize) -> String {
    let unit = 10f64.powi(decimals as i32);
    // Adding zero turns −0 into 0.
    format!("{:.decimals$}", (x * unit).round() / unit + 0.0)
}

#[cfg(test)]
mod tests {
    use super::tick;

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(tick(-1e-17, 2), "0.00");
        assert_eq!(tick(-0.25, 2), "-0.25");
    }
}
