//! The two borders with their intervals.

use super::style::{ASCENDING, BOTH, DESCENDING, GRID, INK, PlotError, header, letters, range, tick};
use crate::identification::Identification;
use plotters::prelude::*;
use switchback_estimator::estimators::BorderPoint;
use switchback_estimator::rig::Rig;

const SIZE: (u32, u32) = (960, 600);

/// Half-width of a 95 % interval in standard errors of a normal estimate.
const Z95: f64 = 1.96;

/// Both borders over the input, each point with its 95 % interval; none where the method sees no border.
///
/// # Errors
/// [`PlotError`] if drawing fails.
pub fn borders(rig: &Rig, identification: &Identification) -> Result<Option<String>, PlotError> {
    if !identification.has_borders() {
        return Ok(None);
    }
    let drawn = series(identification);
    let points = || drawn.iter().flat_map(|(_, _, points)| points.iter());
    let input = range(points().map(|p| p.v));
    let output = range(points().flat_map(interval));
    let names: Vec<_> = drawn.iter().map(|(name, colour, _)| (*name, *colour)).collect();
    let found = if identification.has_one_curve() { "static curve" } else { "borders" };
    let title = format!("{}: {found} by the method {}, with 95 % intervals", rig.name, identification.method);

    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        canvas.fill(&WHITE).map_err(PlotError::new)?;
        let body = header(&canvas, &title, &names)?;
        let mut chart = ChartBuilder::on(&body)
            .margin_right(24)
            .margin_left(16)
            .margin_top(10)
            .margin_bottom(6)
            .x_label_area_size(46)
            .y_label_area_size(76)
            .build_cartesian_2d(input.clone(), output.clone())
            .map_err(PlotError::new)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(INK)
            .label_style(letters(14))
            .axis_desc_style(letters(15))
            .x_desc(rig.input_label.as_str())
            .y_desc("value, in units of u_M − u_m")
            .x_label_formatter(&tick(input.end - input.start))
            .y_label_formatter(&tick(output.end - output.start))
            .draw()
            .map_err(PlotError::new)?;
        for (_, colour, points) in drawn {
            let line = points.iter().map(|p| (p.v, p.f));
            chart.draw_series(LineSeries::new(line, colour.stroke_width(2))).map_err(PlotError::new)?;
            let bars = points.iter().map(|p| {
                let [low, high] = interval(p);
                ErrorBar::new_vertical(p.v, low, p.f, high, colour.filled(), 8)
            });
            chart.draw_series(bars).map_err(PlotError::new)?;
        }
        canvas.present().map_err(PlotError::new)?;
    }
    Ok(Some(svg))
}

/// Name, colour and points of every curve: one border where only one was seen, one curve where both coincide.
fn series(identification: &Identification) -> Vec<(&'static str, RGBColor, &[BorderPoint])> {
    let (descending, ascending) = (&identification.estimate.descending, &identification.estimate.ascending);
    if identification.has_one_curve() {
        return vec![("both directions", BOTH, descending)];
    }
    let both = [
        ("descending border (v falls)", DESCENDING, &descending[..]),
        ("ascending border (v rises)", ASCENDING, ascending),
    ];
    both.into_iter().filter(|(_, _, points)| !points.is_empty()).collect()
}

/// The 95 % interval, or the bare value where no standard error is known.
fn interval(point: &BorderPoint) -> [f64; 2] {
    let half = if point.se.is_finite() { Z95 * point.se } else { 0.0 };
    [point.f - half, point.f + half]
}
