//! Localisation maps: a panel an axis, a bar a cell.

use crate::diagnosis::{Report, SIGNIFICANT, Units, digits, edges};
use crate::plots::canvas::{Canvas, Pen, Point, TextLook};
use crate::plots::legend::{Entry, Sample};
use crate::plots::palette::{FAINT, GREY, INK, OKABE_ITO, tint};
use crate::plots::sheet::{Frames, Grid, Sheet};
use switchback_gap::Cell;

const COLUMNS: usize = 2;
/// Height of a cell's row, pixels.
const ROW: f64 = 20.0;
/// Room for the cells' names left of the bars and for their figures right of them, pixels.
const NAMES: f64 = 150.0;
const FIGURES: f64 = 150.0;

/// Bars of share of the excess energy, a panel an axis, the cells that chance does not explain in colour.
pub(super) fn figure(report: &Report) -> String {
    let axes = axes(&report.diagnosis.where_);
    let tallest = axes.iter().map(|(_, cells)| cells.len()).max().unwrap_or(1);
    let units = Units::of(&report.rig);
    let sheet = Sheet {
        title: format!("{}: where the gap lies", report.rig.name),
        notes: vec![format!(
            "Share of the errors' energy beyond the noise, axis by axis; all records, {}.",
            report.source.model()
        )],
        legend: vec![
            Entry::new(Sample::Line(Pen::new(HOT, 10.0)), format!("significant: q < {SIGNIFICANT}")),
            Entry::new(Sample::Line(Pen::new(tint(GREY, 0.4), 10.0)), "may be chance"),
        ],
        grid: Grid {
            columns: COLUMNS,
            rows: axes.len().div_ceil(COLUMNS).max(1),
            height: ROW * tallest as f64 + 4.0,
            left: NAMES + 20.0,
            between: NAMES + 30.0,
            above: 42.0,
        },
    };
    sheet.render(|canvas, frames| {
        for (i, (axis, cells)) in axes.iter().enumerate() {
            let (row, column) = (i / COLUMNS, i % COLUMNS);
            panel(canvas, frames, (row, column), &axis_name(axis, &units), cells);
        }
    })
}

const HOT: plotters::style::RGBColor = OKABE_ITO[1];

/// The cells by axis, both in their order.
fn axes(cells: &[Cell]) -> Vec<(&'static str, Vec<&Cell>)> {
    let mut axes: Vec<(&'static str, Vec<&Cell>)> = Vec::new();
    for cell in cells {
        match axes.iter_mut().find(|(axis, _)| *axis == cell.axis) {
            Some((_, cells)) => cells.push(cell),
            None => axes.push((cell.axis, vec![cell])),
        }
    }
    axes
}

fn panel(canvas: &Canvas<'_>, frames: &Frames, (row, column): (usize, usize), title: &str, cells: &[&Cell]) {
    let (left, top) = frames.corner(row, column);
    let width = frames.size().0 - FIGURES;
    canvas.text(title, (left - NAMES, top - 16.0), TextLook::new(16.0).bold());
    for (i, cell) in cells.iter().enumerate() {
        let middle = top + ROW * (i as f64 + 0.5);
        let significant = cell.q_value < SIGNIFICANT;
        let colour = if significant { HOT } else { tint(GREY, 0.4) };
        canvas.text(&cell_name(&cell.cell), (left - 8.0, middle), TextLook::new(14.0).end());
        let end: Point = (left + width, middle + 7.0);
        canvas.fill((left, middle - 7.0), end, tint(FAINT, 0.6));
        canvas.fill((left, middle - 7.0), (left + width * cell.share.clamp(0.0, 1.0), middle + 7.0), colour);
        let look = TextLook::new(14.0).colour(if significant { INK } else { GREY });
        let share = format!("{:.0} %", 100.0 * cell.share);
        canvas.text(&share, (left + width + 48.0, middle), look.end());
        canvas.text(&q_value(cell.q_value), (left + width + 60.0, middle), look);
    }
}

fn q_value(q: f64) -> String {
    match q {
        q if q < 1e-6 => "q < 10⁻⁶".to_owned(),
        q if q < 1e-3 => "q < 0.001".to_owned(),
        q => format!("q = {}", digits(q.min(1.0), 2)),
    }
}

/// The axis in words, with the unit of its cells.
fn axis_name(axis: &str, units: &Units) -> String {
    match axis {
        "v" => format!("input v [{}]", units.input),
        "y" => format!("output y [{}]", units.output),
        "travel_since_reversal" => format!("travel since the last reversal [{}]", units.input),
        "rest_samples" => "samples since the last move".to_owned(),
        "loop_size" => format!("size of the loop [{}]", units.input),
        "speed" => format!("speed |Δv| [{} per sample]", units.input),
        "time" => "time, as a share of the campaign".to_owned(),
        "frequency" => "frequency [cycles per sample]".to_owned(),
        other => other.replace('_', " "),
    }
}

/// `0.1 to 0.2`; names stay as they are, cut where they are long.
fn cell_name(cell: &str) -> String {
    let Some([low, high]) = edges(cell) else {
        return match cell.chars().count() {
            0..=20 => cell.to_owned(),
            _ => cell.chars().take(19).chain(['…']).collect(),
        };
    };
    let plain = |x: f64| crate::plots::axis::plain(format!("{x:.3e}").parse().unwrap_or(x));
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{} to {}", plain(low), plain(high)),
        (true, false) => format!("above {}", plain(low)),
        _ => format!("below {}", plain(high)),
    }
}
