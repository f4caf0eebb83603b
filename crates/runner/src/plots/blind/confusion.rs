//! The confusion matrix as a heat map.

use super::page::{INK, PlotError, letters, page};
use crate::blind::Confusion;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const CELL: i32 = 27;
const LEFT: i32 = 180;
const TOP: i32 = 190;

/// Rows are truths, columns answers; shade and number are the row's share in percent. `rows` says which rigs have a row.
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub(in crate::plots) fn confusion(table: &Confusion, rows: &str) -> Result<String, PlotError> {
    let width = LEFT + CELL * table.columns.len() as i32 + 20;
    let height = TOP + CELL * table.rows.len() as i32 + 20;
    page((width as u32, height as u32), |canvas| {
        let title = format!("What was put in (rows, {rows}) and what was said (columns), % of a row");
        canvas.draw(&Text::new(title, (16, 10), letters(17))).map_err(PlotError::new)?;
        let key = "blue: the right answer; orange: another one";
        canvas.draw(&Text::new(key, (16, 34), letters(14))).map_err(PlotError::new)?;
        let name = letters(13).pos(Pos::new(HPos::Right, VPos::Center));
        for (i, row) in table.rows.iter().enumerate() {
            let at = (LEFT - 8, TOP + CELL * i as i32 + CELL / 2);
            canvas.draw(&Text::new(*row, at, name.clone())).map_err(PlotError::new)?;
        }
        let upright = ("sans-serif", 13).into_font().transform(FontTransform::Rotate270).color(&INK);
        for (j, column) in table.columns.iter().enumerate() {
            let at = (LEFT + CELL * j as i32 + 6, TOP - 8);
            canvas.draw(&Text::new(*column, at, upright.clone())).map_err(PlotError::new)?;
        }
        for (i, counts) in table.counts.iter().enumerate() {
            let total: usize = counts.iter().sum();
            for (j, &count) in counts.iter().enumerate() {
                let share = count as f64 / total.max(1) as f64;
                draw_cell(canvas, (i, j), share, is_right(table.rows[i], table.columns[j]))?;
            }
        }
        Ok(())
    })
}

/// Whether an answer is the right one: the effect itself, nothing or other parameters where there is none, "none of these" for outsiders.
fn is_right(truth: &str, answer: &str) -> bool {
    truth == answer || matches!((truth, answer), ("outside", "unexplained") | ("none", "refit"))
}

fn draw_cell(
    canvas: &super::page::Canvas<'_>,
    (i, j): (usize, usize),
    share: f64,
    right: bool,
) -> Result<(), PlotError> {
    let (x, y) = (LEFT + CELL * j as i32, TOP + CELL * i as i32);
    let shade = |full: u8| (255.0 - share * (255.0 - f64::from(full))) as u8;
    let (r, g, b) = if right { (0x00, 0x72, 0xB2) } else { (0xD5, 0x5E, 0x00) };
    let colour = RGBColor(shade(r), shade(g), shade(b));
    let area = [(x, y), (x + CELL - 1, y + CELL - 1)];
    canvas.draw(&Rectangle::new(area, colour.filled())).map_err(PlotError::new)?;
    canvas.draw(&Rectangle::new(area, INK.mix(0.15))).map_err(PlotError::new)?;
    if share > 0.0 {
        let ink = if share > 0.6 { WHITE } else { INK };
        let style = letters(11).color(&ink).pos(Pos::new(HPos::Center, VPos::Center));
        let text = format!("{:.0}", 100.0 * share);
        canvas.draw(&Text::new(text, (x + CELL / 2, y + CELL / 2), style)).map_err(PlotError::new)?;
    }
    Ok(())
}
