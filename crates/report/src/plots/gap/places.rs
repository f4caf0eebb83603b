//! Localisation maps: a block an axis, a bar a cell.

use crate::diagnosis::SIGNIFICANT;
use crate::plots::canvas::{Canvas, Point};
use crate::plots::legend::{Entry, Sample};
use crate::plots::sheet::{Frames, Grid, Sheet};
use crate::plots::style::{FAINT, GREY, INK, OKABE_ITO, PALE, Pen, TextLook, percent, rounded, tint};
use plotters::style::RGBColor;
use switchback_diagnose::Cell;
use switchback_diagnose::CellInterval;
use switchback_io::diagnosis::{Report, Units};

const COLUMNS: usize = 2;
/// Height of a cell's row, of an axis' name, and room below its cells, pixels.
const ROW: f64 = 21.0;
const NAME: f64 = 24.0;
const BELOW: f64 = 16.0;
/// Half the height of a bar and of the tick upon it, pixels.
const HALF_BAR: f64 = 7.0;
const HALF_TICK: f64 = 9.5;
/// Room for the cells' names left of the bars and for their figures right of them, pixels.
const NAMES: f64 = 140.0;
const FIGURES: f64 = 140.0;
/// Where the figures end, pixels right of the bars.
const ENDS: [f64; 3] = [44.0, 88.0, 138.0];

/// Bars of the share of the excess energy with ticks at the share of the samples, a block an axis; in colour the cells whose energy chance
/// does not explain, in full colour those where it is denser than elsewhere. Axes where it is densest come first.
pub(super) fn figure(report: &Report) -> String {
    let units = Units::of(&report.rig);
    let (axes, single): (Vec<_>, Vec<_>) =
        axes(&report.diagnosis.where_).into_iter().partition(|(_, cells)| cells.len() > 1);
    let blocks = arranged(axes);
    let height = blocks.iter().map(|b| b.top + b.height()).fold(0.0, f64::max);
    let mut notes = vec![format!(
        "Bar: share of the errors' energy beyond the noise; tick: share of the samples there (exposure; on the frequency axis, of the \
             range). Right: both, and the one over the other. All records, {}.",
        report.source.model()
    )];
    if !single.is_empty() {
        let names: Vec<String> = single.iter().map(|(axis, _)| axis_name(axis, &units)).collect();
        notes.push(format!("Left out, as all samples lie in one cell: {}.", names.join(", ")));
    }
    let grid = Grid {
        left: NAMES + 20.0,
        between: NAMES + 24.0,
        above: 12.0,
        below: 4.0,
        ..Grid::new(1, COLUMNS, height)
    };
    let mut sheet = Sheet::new(format!("{}: where the gap lies", report.rig.name), notes, grid);
    if blocks.is_empty() {
        return sheet.empty("The errors were not split by place: there is nothing beyond the noise.");
    }
    sheet.legend = vec![
        Entry::patch(Kind::Dense.colour(), format!("denser than elsewhere (q < {SIGNIFICANT})")),
        Entry::patch(Kind::Present.colour(), "beyond the noise, no denser than elsewhere"),
        Entry::patch(Kind::Chance.colour(), "may be chance"),
        Entry::new(Sample::Bar(Pen::data(INK)), "share of the samples there"),
    ];
    sheet.render(|canvas, frames| {
        for block in &blocks {
            block.draw(canvas, frames, &axis_name(block.axis, &units));
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
            Self::Present => tint(OKABE_ITO[1], PALE),
            Self::Chance => tint(GREY, PALE),
        }
    }
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

/// An axis and where it stands.
struct Block<'r> {
    axis: &'static str,
    cells: Vec<&'r Cell>,
    column: usize,
    /// Below the top of the diagrams, pixels.
    top: f64,
}

/// Each axis goes below the shorter column, so that the page is filled; those with the densest cells first.
fn arranged<'r>(mut axes: Vec<(&'static str, Vec<&'r Cell>)>) -> Vec<Block<'r>> {
    let dense = |cells: &[&Cell]| {
        let dense = cells.iter().filter(|c| Kind::of(c) == Kind::Dense);
        dense.map(|c| c.share - c.exposure).sum::<f64>()
    };
    axes.sort_by(|a, b| dense(&b.1).total_cmp(&dense(&a.1)));
    let mut ends = [0.0; COLUMNS];
    let mut blocks = Vec::new();
    for (axis, cells) in axes {
        let column = if ends[1] < ends[0] { 1 } else { 0 };
        let block = Block { axis, cells, column, top: ends[column] };
        ends[column] += block.height();
        blocks.push(block);
    }
    blocks
}

impl Block<'_> {
    fn height(&self) -> f64 {
        NAME + ROW * self.cells.len() as f64 + BELOW
    }

    fn draw(&self, canvas: &Canvas, frames: &Frames, name: &str) {
        let (left, top) = frames.corner(0, self.column);
        let top = top + self.top;
        let width = frames.size().0 - FIGURES;
        canvas.text(name, (left - NAMES, top + NAME / 2.0), TextLook::heading());
        for (i, cell) in self.cells.iter().enumerate() {
            let middle = top + NAME + ROW * (i as f64 + 0.5);
            row(canvas, (left, middle), width, cell);
        }
    }
}

fn row(canvas: &Canvas, (left, middle): Point, width: f64, cell: &Cell) {
    let kind = Kind::of(cell);
    canvas.text(&cell_name(cell), (left - 8.0, middle), TextLook::number().end());
    let bar = |share: f64, colour: RGBColor| {
        let end = left + width * share.clamp(0.0, 1.0);
        canvas.fill((left, middle - HALF_BAR), (end, middle + HALF_BAR), colour);
    };
    bar(1.0, tint(FAINT, 0.6));
    bar(cell.share, kind.colour());
    let tick = left + width * cell.exposure.clamp(0.0, 1.0);
    canvas.line(&[(tick, middle - HALF_TICK), (tick, middle + HALF_TICK)], Pen::data(INK));
    let look = TextLook::number().colour(if kind == Kind::Chance { GREY } else { INK });
    let figures = [percent(cell.share, 0), percent(cell.exposure, 0), times(cell.enrichment)];
    for (figure, right) in figures.iter().zip(ENDS) {
        canvas.text(figure, (left + width + right, middle), look.end());
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
        "time" => "time, as a share of the dataset".to_owned(),
        "frequency" => "frequency [Hz]".to_owned(),
        other => other.replace('_', " "),
    }
}

/// `0.1 to 0.2`; names stay as they are, cut where they are long.
fn cell_name(cell: &Cell) -> String {
    let Some(CellInterval { low, high, .. }) = cell.interval else {
        return match cell.cell.chars().count() {
            0..=18 => cell.cell.clone(),
            _ => cell.cell.chars().take(17).chain(['…']).collect(),
        };
    };
    let plain = |x: f64| rounded(x, 4);
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{} to {}", plain(low), plain(high)),
        (true, false) => format!("above {}", plain(low)),
        _ => format!("below {}", plain(high)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(axis: &'static str, share: f64, exposure: f64) -> Cell {
        let dense = if share > exposure { 0.001 } else { 0.9 };
        Cell {
            axis,
            cell: "somewhere".to_owned(),
            interval: None,
            share,
            exposure,
            enrichment: share / exposure,
            q_value: 0.001,
            enrichment_q_value: dense,
        }
    }

    #[test]
    fn the_densest_axis_comes_first_and_columns_end_level() {
        let mut cells: Vec<Cell> = (0..10).map(|_| cell("v", 0.1, 0.1)).collect();
        cells.extend([cell("speed", 0.9, 0.2), cell("speed", 0.1, 0.8)]);
        cells.extend((0..6).map(|_| cell("y", 1.0 / 6.0, 1.0 / 6.0)));
        let blocks = arranged(axes(&cells));
        assert_eq!(blocks.iter().map(|b| b.axis).collect::<Vec<_>>(), ["speed", "v", "y"]);
        assert_eq!(blocks.iter().map(|b| b.column).collect::<Vec<_>>(), [0, 1, 0]);
        assert_eq!(blocks[2].top, blocks[0].height());
    }
}
