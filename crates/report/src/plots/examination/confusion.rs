//! The confusion matrix as a heat map.

use crate::plots::canvas::{Canvas, Point};
use crate::plots::legend::Entry;
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{BAD, FAINT, GOOD, GREY, INK, MARGIN, NARROW, PAPER, Pen, TextLook, count, tint};
use switchback_lab::examination::Confusion;

/// Width and height of a cell, room for the names of rows and columns and for the count of a row, pixels.
const CELL: f64 = 27.0;
const LEFT: f64 = 190.0;
const TOP: f64 = 160.0;
const COUNT: f64 = 56.0;
/// A cell is shaded so much at least where it is not empty, and its number is white from so much on.
const PALEST: f64 = 0.06;
const DARK: f64 = 0.6;

/// Rows are truths, columns answers; shade and number are the row's share in percent. `rows` says which rigs have a row.
pub(super) fn confusion(table: &Confusion, rows: &str) -> String {
    let grid =
        Grid { left: LEFT, above: TOP, below: MARGIN, ..Grid::new(1, 1, CELL * table.rows.len() as f64) };
    let mut sheet = Sheet::new(
        "Confusion: what was put in and what was said",
        vec![format!(
            "A row an effect that was put in ({rows}), a column an answer; a cell is the share of its row in percent, right of it the \
             number of rigs."
        )],
        grid,
    );
    sheet.width = (LEFT + CELL * table.columns.len() as f64 + COUNT + MARGIN).max(NARROW);
    if table.counts.iter().flatten().sum::<usize>() == 0 {
        return sheet.empty("No rig of this kind was judged.");
    }
    sheet.legend = vec![Entry::patch(GOOD, "the right answer"), Entry::patch(BAD, "another one")];
    sheet.render(|canvas, frames| {
        let (left, top) = frames.corner(0, 0);
        for (j, column) in table.columns.iter().enumerate() {
            let x = left + CELL * (j as f64 + 0.5);
            let look = TextLook::number().upwards();
            canvas.text(&look.fitted(column, TOP - 16.0), (x, top - 8.0), look);
        }
        let right = left + CELL * table.columns.len() as f64 + COUNT - 6.0;
        canvas.text("rigs", (right, top - 14.0), TextLook::number().colour(GREY).end());
        for (i, (name, counts)) in table.rows.iter().zip(&table.counts).enumerate() {
            let middle = top + CELL * (i as f64 + 0.5);
            let total: usize = counts.iter().sum();
            let colour = if total == 0 { GREY } else { INK };
            let look = TextLook::number().colour(colour).end();
            canvas.text(&look.fitted(name, LEFT - 8.0 - MARGIN), (left - 8.0, middle), look);
            canvas.text(&count(total), (right, middle), TextLook::number().colour(colour).end());
            for (j, &count) in counts.iter().enumerate() {
                let share = count as f64 / total.max(1) as f64;
                let corner = (left + CELL * j as f64, top + CELL * i as f64);
                cell(canvas, corner, share, is_right(name, table.columns[j]));
            }
        }
    })
}

/// Whether an answer is the right one: the effect itself, nothing or other parameters where there is none, "none of these" for outsiders.
fn is_right(truth: &str, answer: &str) -> bool {
    truth == answer || matches!((truth, answer), ("outside", "unexplained") | ("none", "refit"))
}

fn cell(canvas: &Canvas, (x, y): Point, share: f64, right: bool) {
    let opposite = (x + CELL, y + CELL);
    if share > 0.0 {
        canvas.fill((x, y), opposite, tint(if right { GOOD } else { BAD }, share.max(PALEST)));
    }
    canvas.frame((x, y), opposite, Pen::hair(FAINT));
    if share > 0.0 {
        let look = TextLook::small().middle().colour(if share > DARK { PAPER } else { INK });
        canvas.text(&format!("{:.0}", 100.0 * share), (x + CELL / 2.0, y + CELL / 2.0), look);
    }
}
