//! Localisation maps: a panel an axis, a bar a cell.

use crate::diagnosis::{Report, SIGNIFICANT, Units};
use crate::plots::canvas::{Canvas, Pen, Point, TextLook};
use crate::plots::legend::{Entry, Sample};
use crate::plots::palette::{FAINT, GREY, INK, OKABE_ITO, tint};
use crate::plots::sheet::{Frames, Grid, Sheet};
use plotters::style::RGBColor;
use switchback_gap::{Cell, CellInterval};

const COLUMNS: usize = 2;
/// Height of a cell's row, pixels.
const ROW: f64 = 20.0;
/// Room for the cells' names left of the bars and for their figures right of them, pixels.
const NAMES: f64 = 150.0;
const FIGURES: f64 = 150.0;

/// Bars of the share of the excess energy with ticks at the share of the samples, a panel an axis; in colour the cells whose energy chance
/// does not explain, in full colour those where it is denser than elsewhere.
pub(super) fn figure(report: &Report) -> String {
    let axes = axes(&report.diagnosis.where_);
    let tallest = axes.iter().map(|(_, cells)| cells.len()).max().unwrap_or(1);
    let units = Units::of(&report.rig);
    let sheet = Sheet {
        title: format!("{}: where the gap lies", report.rig.name),
        notes: vec![
            format!(
                "Share of the errors' energy beyond the noise, axis by axis; all records, {}.",
                report.source.model()
            ),
            "Right of the bars: share of the energy, share of the samples (on the frequency axis, of the range), and the one over the other."
                .to_owned(),
        ],
        legend: vec![
            bar(Kind::Dense, &format!("denser than elsewhere (q < {SIGNIFICANT})")),
            bar(Kind::Present, "beyond the noise, no denser than elsewhere"),
            bar(Kind::Chance, "may be chance"),
            Entry::new(Sample::Bar(Pen::new(INK, 2.0)), "share of the samples there (exposure)"),
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

/// What a cell's energy is beside chance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Dense,
    Present,
    Chance,
}

impl Kind {
    fn of(cell: &Cell) -> Self {
        match (cell.q_value < SIGNIFICANT, cell.enrichment_q_value < SIGNIFICANT) {
            (true, true) => Self::Dense,
            (true, false) => Self::Present,
            (false, _) => Self::Chance,
        }
    }

    fn colour(self) -> RGBColor {
        match self {
            Self::Dense => OKABE_ITO[1],
            Self::Present => tint(OKABE_ITO[1], 0.4),
            Self::Chance => tint(GREY, 0.4),
        }
    }
}

fn bar(kind: Kind, text: &str) -> Entry {
    Entry::new(Sample::Line(Pen::new(kind.colour(), 10.0)), text)
}

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
        let kind = Kind::of(cell);
        canvas.text(&cell_name(cell), (left - 8.0, middle), TextLook::new(14.0).end());
        let end: Point = (left + width, middle + 7.0);
        canvas.fill((left, middle - 7.0), end, tint(FAINT, 0.6));
        canvas.fill(
            (left, middle - 7.0),
            (left + width * cell.share.clamp(0.0, 1.0), middle + 7.0),
            kind.colour(),
        );
        let tick = left + width * cell.exposure.clamp(0.0, 1.0);
        canvas.line(&[(tick, middle - 9.0), (tick, middle + 9.0)], Pen::new(INK, 2.0));
        let look = TextLook::new(14.0).colour(if kind == Kind::Chance { GREY } else { INK });
        let percent = |x: f64| format!("{:.0} %", 100.0 * x);
        let figures = [percent(cell.share), percent(cell.exposure), times(cell.enrichment)];
        for (figure, right) in figures.iter().zip([46.0, 94.0, 144.0]) {
            canvas.text(figure, (left + width + right, middle), look.end());
        }
    }
}

/// How many times the average, to a tenth below ten.
fn times(enrichment: f64) -> String {
    let decimals = usize::from(enrichment < 9.95);
    format!("× {enrichment:.decimals$}")
}

/// The axis in words, with the unit of its cells.
fn axis_name(axis: &str, units: &Units) -> String {
    match axis {
        "v" => format!("input v [{}]", units.input),
        "y" => format!("output y [{}]", units.output),
        "travel_since_reversal" => format!("travel since the last reversal [{}]", units.input),
        "rest_samples" => "samples since the last move".to_owned(),
        "loop_size" => format!("size of the loop [{}]", units.input),
        "speed" => format!("speed |Δv/Δt| [{}/s]", units.input),
        "time" => "time, as a share of the campaign".to_owned(),
        "frequency" => "frequency [Hz]".to_owned(),
        other => other.replace('_', " "),
    }
}

/// `0.1 to 0.2`; names stay as they are, cut where they are long.
fn cell_name(cell: &Cell) -> String {
    let Some(CellInterval { low, high, .. }) = cell.interval else {
        return match cell.cell.chars().count() {
            0..=20 => cell.cell.clone(),
            _ => cell.cell.chars().take(19).chain(['…']).collect(),
        };
    };
    let plain = |x: f64| crate::plots::axis::plain(format!("{x:.3e}").parse().unwrap_or(x));
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{} to {}", plain(low), plain(high)),
        (true, false) => format!("above {}", plain(low)),
        _ => format!("below {}", plain(high)),
    }
}
