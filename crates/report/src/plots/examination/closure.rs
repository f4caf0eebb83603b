//! Stated closure against what the stated models really close.

use crate::plots::axis::Axis;
use crate::plots::canvas::{Dash, Towards};
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::Mark;
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{GREY, INK, NARROW, OKABE_ITO, Pen, SMALL_RADIUS};
use switchback_lab::examination::ClosureCheck;

/// Where the axes begin and end.
const LEAST: f64 = -0.5;
const MOST: f64 = 1.0;
/// The frame is square, but for rounding.
const HEIGHT: f64 = 520.0;

/// One dot a rig; large gaps and small ones in two colours.
pub(super) fn closure(rigs: &[(bool, ClosureCheck)]) -> String {
    let axis = Axis::percent(LEAST, MOST);
    let beyond = rigs.iter().filter(|(_, c)| !(axis.holds(c.actual) && axis.holds(c.estimate))).count();
    let mut sheet = Sheet::new(
        "Closure on held-out records: stated against real",
        vec![format!("A dot a rig. Beyond the frame: {beyond} of {}, as arrows at its edge.", rigs.len())],
        Grid::new(1, 1, HEIGHT),
    );
    sheet.width = NARROW;
    if rigs.is_empty() {
        return sheet.empty("No rig has a stated closure.");
    }
    let colours = [(true, OKABE_ITO[0], "surviving gap ≥ 1 sd"), (false, OKABE_ITO[1], "smaller gap")];
    sheet.legend = colours.iter().map(|(_, colour, name)| Entry::disc(*colour, *name)).collect();
    sheet.legend.push(Entry::new(Sample::Arrow(Towards::Down, INK), "beyond the frame, in that direction"));
    sheet.legend.push(Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dashes), "stated as it is"));
    sheet.render(|canvas, frames| {
        let panel = frames.panel(canvas, (0, 0), (axis, axis));
        panel.x_name("closure that the stated models have");
        panel.y_name("closure stated", 64.0);
        panel.dashes(&[(-1.0, -1.0), (2.0, 2.0)], Dash::Dashes, Pen::data(GREY));
        for (large, colour, _) in colours.into_iter().rev() {
            for (_, check) in rigs.iter().filter(|(is_large, _)| *is_large == large) {
                let mark = Mark::disc(Pen::data(colour), SMALL_RADIUS);
                panel.point(check.actual, check.estimate, mark);
            }
        }
    })
}
