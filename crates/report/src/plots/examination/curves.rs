//! Shares against size, probability and threshold, with 95 % intervals (Wilson).

use crate::plots::axis::Axis;
use crate::plots::canvas::Dash;
use crate::plots::legend::{Entry, Sample};
use crate::plots::panel::{Mark, Panel};
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{GREY, INK, NARROW, OKABE_ITO, Pen, RADIUS, SMALL_RADIUS, TextLook};
use plotters::style::RGBColor;
use switchback_lab::examination::{CalibrationBin, Cell, Row, Table};

const HEIGHT: f64 = 360.0;
/// Pixels between marks at the same place.
const APART: f64 = 6.0;
const SHARES: &str = "share of rigs";
const INTERVALS: &str = "95 % intervals (Wilson)";

fn sheet(title: &str, notes: Vec<String>) -> Sheet {
    Sheet { width: NARROW, ..Sheet::new(title, notes, Grid::new(1, 1, HEIGHT)) }
}

/// A bar in a legend.
fn bars() -> Entry {
    Entry::new(Sample::Bar(Pen::data(INK)), INTERVALS)
}

/// Names of curves, and the columns of a table that hold their shares.
type Curves = [(&'static str, &'static str)];

fn number(row: &Row, column: &str) -> f64 {
    row.get(column).and_then(Cell::number).unwrap_or(f64::NAN)
}

/// Draws a curve a share, marks a little apart so that intervals do not cover each other.
fn curves(panel: &Panel<'_>, table: &Table, x: &str, curves: &Curves) {
    for (k, ((_, column), colour)) in curves.iter().zip(OKABE_ITO).enumerate() {
        let reported = |row: &Row| {
            let share = Table::share(row, column);
            Some((number(row, x), share.value()?, share.interval()?))
        };
        let reported: Vec<_> = table.rows.iter().filter_map(reported).collect();
        let line: Vec<(f64, f64)> = reported.iter().map(|(x, y, _)| (*x, *y)).collect();
        panel.line(&line, Pen::hair(colour));
        let aside = APART * (k as f64 - (curves.len() - 1) as f64 / 2.0);
        for (x, y, [low, high]) in reported {
            panel.mark(x, y, (low, high), Mark { aside, ..Mark::disc(Pen::data(colour), RADIUS) });
        }
    }
}

fn legend(curves: &Curves) -> Vec<Entry> {
    let entry = |((name, _), colour): (&(&'static str, &'static str), RGBColor)| Entry::disc(colour, *name);
    curves.iter().zip(OKABE_ITO).map(entry).chain([bars()]).collect()
}

/// Accuracy against the size of the surviving gap.
pub(super) fn accuracy(sizes: &Table) -> String {
    const CURVES: &Curves = &[
        ("exact", "exact"),
        ("right class", "class"),
        ("other laws, right class", "mismatch_class"),
        ("a wrong cause", "wrong"),
    ];
    let mut sheet = sheet("Accuracy: what was put in is named", Vec::new());
    if sizes.is_empty() {
        return sheet.empty("No rig with a single effect was judged.");
    }
    sheet.legend = legend(CURVES);
    let axes = (Axis::doublings(sizes.rows.iter().map(|row| number(row, "size"))), Axis::percent(0.0, 1.0));
    sheet.render(|canvas, frames| {
        let panel = frames.panel(canvas, (0, 0), axes);
        panel.x_name("surviving gap asked for, noise sd");
        panel.y_name(SHARES, 64.0);
        curves(&panel, sizes, "size", CURVES);
    })
}

/// Share of verdicts that hold against the probability they claim: a disc a bin, as large as it has verdicts.
pub(super) fn calibration(bins: &[CalibrationBin]) -> String {
    let total: usize = bins.iter().map(|b| b.held.of).sum();
    let mut sheet = sheet(
        "Calibration: what is claimed and what holds",
        vec![format!(
            "{total} verdicts in ten bins of equal width; a disc's area and the number beside it are the verdicts of its bin. Probabilities \
             mean what they say where bars meet the diagonal."
        )],
    );
    if total == 0 {
        return sheet.empty("No rig has a verdict with a probability.");
    }
    sheet.legend = vec![
        Entry::disc(OKABE_ITO[0], "verdicts of a bin"),
        bars(),
        Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dashes), "as much holds as is claimed"),
    ];
    let most = bins.iter().map(|b| b.held.of).max().unwrap_or(1) as f64;
    sheet.render(|canvas, frames| {
        let panel = frames.panel(canvas, (0, 0), (Axis::percent(0.0, 1.0), Axis::percent(0.0, 1.0)));
        panel.x_name("probability claimed");
        panel.y_name("share that holds", 64.0);
        panel.dashes(&[(0.0, 0.0), (1.0, 1.0)], Dash::Dashes, Pen::data(GREY));
        for bin in bins {
            let (Some(held), Some([low, high])) = (bin.held.value(), bin.held.interval()) else { continue };
            let radius = (2.2 * RADIUS * (bin.held.of as f64 / most).sqrt()).max(SMALL_RADIUS);
            panel.mark(bin.claimed, held, (low, high), Mark::disc(Pen::data(OKABE_ITO[0]), radius));
            // Left of the disc where the frame ends right of it.
            let look = TextLook::small();
            let (aside, look) =
                if bin.claimed > 0.9 { (-radius - 4.0, look.end()) } else { (radius + 4.0, look) };
            panel.text(&bin.held.of.to_string(), (bin.claimed, held), (aside, 0.0), look);
        }
    })
}

/// Share of right verdicts against the share that is still given.
pub(super) fn abstention(table: &Table) -> String {
    const CURVES: &Curves = &[("verdicts still given", "answered"), ("of these, right", "right")];
    let mut sheet = sheet("Abstention: staying silent below a probability", Vec::new());
    if table.is_empty() {
        return sheet.empty("No rig has a verdict with a probability.");
    }
    sheet.legend = legend(CURVES);
    sheet.render(|canvas, frames| {
        let panel = frames.panel(canvas, (0, 0), (Axis::percent(0.0, 1.0), Axis::percent(0.0, 1.0)));
        panel.x_name("least probability of a verdict");
        panel.y_name("share", 64.0);
        curves(&panel, table, "threshold", CURVES);
    })
}
