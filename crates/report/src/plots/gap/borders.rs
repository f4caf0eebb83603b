//! The borders of the model before and after what was found was added.

use crate::plots::axis::Axis;
use crate::plots::canvas::Dash;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::Reading;
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{ASCENDING, DESCENDING, NARROW, Pen};
use plotters::style::RGBColor;
use switchback_io::model::Described;

const HEIGHT: f64 = 330.0;

struct Curve<'a> {
    key: String,
    colour: RGBColor,
    dash: Option<Dash>,
    points: &'a [(f64, f64)],
}

/// Both borders of the augmented model, and in dashes those of the nominal one.
pub fn borders(input: &str, nominal: Option<&Described>, augmented: &Described) -> String {
    let models = [("nominal", nominal, Some(Dash::Dashes)), ("augmented", Some(augmented), None)];
    let mut curves = Vec::new();
    for (name, system, dash) in models {
        let Some(system) = system else { continue };
        for (border, colour, points) in
            [("descending", DESCENDING, &system.descending), ("ascending", ASCENDING, &system.ascending)]
        {
            curves.push(Curve { key: format!("{border}, {name}"), colour, dash, points });
        }
    }
    let note = "In units of u; the scale between u and y is in b.".to_owned();
    let mut sheet =
        Sheet { width: NARROW, ..Sheet::new("Borders of the models", vec![note], Grid::new(1, 1, HEIGHT)) };
    for Curve { key, colour, dash, .. } in &curves {
        let pen = Pen::data(*colour);
        let sample = dash.map_or(Sample::Line(pen), |dash| Sample::Dashes(pen, dash));
        sheet.legend.push(Entry::new(sample, key).hiding(key));
    }
    let points = || curves.iter().flat_map(|curve| curve.points);
    let axes = (Axis::linear(points().map(|p| p.0)), Axis::linear(points().map(|p| p.1)));
    sheet.render(|canvas, frames| {
        let panel = frames.readable(canvas, (0, 0), axes, Reading { x: input, y: "u", zooms: false });
        for Curve { key, colour, dash, points } in &curves {
            panel.series(key, || match dash {
                Some(dash) => panel.dashes(points, *dash, Pen::data(*colour)),
                None => panel.line(points, Pen::data(*colour)),
            });
        }
    })
}
