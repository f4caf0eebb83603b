//! The two borders with their intervals.

use crate::plots::axis::Axis;
use crate::plots::labelled;
use crate::plots::legend::Entry;
use crate::plots::panel::Mark;
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{ASCENDING, DESCENDING, OKABE_ITO, PALE, Pen, SMALL_RADIUS, tint};
use plotters::style::RGBColor;
use switchback_identify::BorderPoint;
use switchback_io::identification::Identification;
use switchback_model::rig::Rig;

/// Half-width of a 95 % interval in standard errors of a normal estimate.
const Z95: f64 = 1.96;

/// Both borders over the input, each point with its 95 % interval; none where the method sees no border.
pub fn borders(rig: &Rig, identification: &Identification) -> Option<String> {
    if !identification.has_borders() {
        return None;
    }
    let drawn = series(identification);
    let points = || drawn.iter().flat_map(|(_, _, points)| points.iter());
    let found = if identification.has_one_curve() { "static curve" } else { "borders" };
    let mut sheet = Sheet::new(
        format!("{}: {found} by the method {}", rig.name, identification.method),
        vec!["In units of u_M − u_m; bands and bars: 95 % intervals, each point's own.".to_owned()],
        Grid::new(1, 1, 420.0),
    );
    sheet.legend = drawn.iter().map(|(name, colour, _)| Entry::disc(*colour, *name)).collect();
    let axes = (
        Axis::linear(points().map(|p| p.v)),
        Axis::linear(points().flat_map(|p| <[f64; 2]>::from(interval(p)))),
    );
    Some(sheet.render(|canvas, frames| {
        let panel = frames.panel(canvas, (0, 0), axes);
        panel.x_name(&labelled(&rig.input_label, "input units"));
        panel.y_name("F", 58.0);
        for (_, colour, points) in &drawn {
            let band = points.iter().map(|p| (p.v, interval(p).0, interval(p).1));
            panel.band(&band.collect::<Vec<_>>(), tint(*colour, PALE / 2.0));
        }
        for (_, colour, points) in &drawn {
            panel.line(&points.iter().map(|p| (p.v, p.f)).collect::<Vec<_>>(), Pen::data(*colour));
            for point in *points {
                panel.mark(point.v, point.f, interval(point), Mark::disc(Pen::data(*colour), SMALL_RADIUS));
            }
        }
    }))
}

/// Name, colour and points of every curve: one border where only one was seen, one curve where both coincide.
fn series(identification: &Identification) -> Vec<(&'static str, RGBColor, &[BorderPoint])> {
    let (descending, ascending) = (&identification.estimate.descending, &identification.estimate.ascending);
    if identification.has_one_curve() {
        return vec![("both directions", OKABE_ITO[2], descending)];
    }
    let both = [
        ("descending border (v falls)", DESCENDING, &descending[..]),
        ("ascending border (v rises)", ASCENDING, ascending),
    ];
    both.into_iter().filter(|(_, _, points)| !points.is_empty()).collect()
}

/// The 95 % interval, or the bare value where no standard error is known.
fn interval(point: &BorderPoint) -> (f64, f64) {
    let half = if point.se.is_finite() { Z95 * point.se } else { 0.0 };
    (point.f - half, point.f + half)
}
