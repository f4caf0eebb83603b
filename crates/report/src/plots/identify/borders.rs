//! The two borders with their intervals.

use crate::plots::axis::Axis;
use crate::plots::labelled;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::{Mark, Reading};
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{ASCENDING, DESCENDING, OKABE_ITO, PALE, Pen, SMALL_RADIUS, tint};
use plotters::style::RGBColor;
use switchback_identify::statistics::Z95;
use switchback_io::identification::json::{EstimateFile, Point};

/// Both borders over the input, each point with its 95 % interval; none where the method sees no border.
pub fn borders(estimate: &EstimateFile) -> Option<String> {
    let drawn = series(estimate);
    if drawn.is_empty() {
        return None;
    }
    let points = || drawn.iter().flat_map(|(_, _, points)| points.iter());
    let found = if has_one_curve(estimate) { "static curve" } else { "borders" };
    let mut sheet = Sheet::new(
        format!("{}: {found} by the method {}", estimate.rig, estimate.method),
        vec!["In units of u_M − u_m; bands and bars: 95 % intervals, each point's own.".to_owned()],
        Grid::new(1, 1, 420.0),
    );
    for (name, colour, points) in &drawn {
        sheet.legend.push(Entry::disc(*colour, *name).hiding(*name));
        if points.iter().any(|p| p.se.is_finite()) {
            let band = band_key(name);
            sheet.legend.push(Entry::new(Sample::Patch(band_colour(*colour)), &band).hiding(&band));
        }
    }
    let axes = (
        Axis::linear(points().map(|p| p.v)),
        Axis::linear(points().flat_map(|p| <[f64; 2]>::from(interval(p)))),
    );
    let x = labelled(&estimate.input, "input units");
    Some(sheet.render(|canvas, frames| {
        let panel = frames.readable(canvas, (0, 0), axes, Reading { x: &x, y: "F", zooms: false });
        for (name, colour, points) in &drawn {
            let band: Vec<_> = points.iter().map(|p| (p.v, interval(p).0, interval(p).1)).collect();
            panel.series(&band_key(name), || panel.band(&band, band_colour(*colour)));
        }
        for (name, colour, points) in &drawn {
            panel.series(name, || {
                panel.line(&points.iter().map(|p| (p.v, p.f)).collect::<Vec<_>>(), Pen::data(*colour));
                for point in *points {
                    panel.mark(
                        point.v,
                        point.f,
                        interval(point),
                        Mark::disc(Pen::data(*colour), SMALL_RADIUS),
                    );
                }
            });
        }
    }))
}

fn has_one_curve(estimate: &EstimateFile) -> bool {
    let key = |points: &[Point]| points.iter().map(|p| (p.v.to_bits(), p.f.to_bits())).collect::<Vec<_>>();
    key(&estimate.descendant) == key(&estimate.ascendant)
}

/// Name, colour and points of every curve: one border where only one was seen, one curve where both coincide.
fn series(estimate: &EstimateFile) -> Vec<(&'static str, RGBColor, &[Point])> {
    let (descending, ascending) = (&estimate.descendant[..], &estimate.ascendant[..]);
    let curves = match has_one_curve(estimate) {
        true => vec![("both directions", OKABE_ITO[2], descending)],
        false => vec![
            ("descending border (v falls)", DESCENDING, descending),
            ("ascending border (v rises)", ASCENDING, ascending),
        ],
    };
    curves.into_iter().filter(|(_, _, points)| !points.is_empty()).collect()
}

fn band_key(name: &str) -> String {
    format!("{}, band", name.split(" (").next().unwrap_or(name))
}

fn band_colour(colour: RGBColor) -> RGBColor {
    tint(colour, PALE / 2.0)
}

/// The 95 % interval, or the bare value where no standard error is known.
fn interval(point: &Point) -> (f64, f64) {
    let half = if point.se.is_finite() { Z95 * point.se } else { 0.0 };
    (point.f - half, point.f + half)
}
