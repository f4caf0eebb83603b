//! The diagnosis beside simpler rules, as bars.

use super::page::{COLOURS, PlotError, letters, page};
use crate::blind::BaselineRow;
use crate::examination::Share;
use plotters::prelude::*;

/// Four shares a rule.
///
/// # Errors
/// [`PlotError`] if the drawing library fails.
pub(super) fn baselines(rows: &[BaselineRow]) -> Result<String, PlotError> {
    const LEFT: i32 = 200;
    const FULL: f64 = 440.0;
    const BAR: i32 = 16;
    let names = ["exact, ≥ 1 sd", "precision", "false alarm", "outside named"];
    let shares: [fn(&BaselineRow) -> Share; 4] =
        [|r| r.exact, |r| r.precision, |r| r.false_alarm, |r| r.outside_named];
    let group = BAR * 4 + 20;
    let height = 80 + group * rows.len() as i32;
    page((760, height as u32), |canvas| {
        canvas
            .draw(&Text::new("The same rigs under simpler rules", (16, 10), letters(19)))
            .map_err(PlotError::new)?;
        for (k, name) in names.iter().enumerate() {
            let x = 20 + 170 * k as i32;
            let sample = Rectangle::new([(x, 42), (x + 20, 54)], COLOURS[k].filled());
            canvas.draw(&sample).map_err(PlotError::new)?;
            canvas.draw(&Text::new(*name, (x + 26, 41), letters(14))).map_err(PlotError::new)?;
        }
        for (i, row) in rows.iter().enumerate() {
            let top = 72 + group * i as i32;
            canvas.draw(&Text::new(row.rule, (16, top + 24), letters(15))).map_err(PlotError::new)?;
            for (k, share) in shares.iter().enumerate() {
                let y = top + BAR * k as i32;
                let value = share(row).value();
                let length = (FULL * value.unwrap_or(0.0)) as i32;
                let bar = Rectangle::new([(LEFT, y), (LEFT + length, y + BAR - 3)], COLOURS[k].filled());
                canvas.draw(&bar).map_err(PlotError::new)?;
                let text = value.map_or_else(|| "—".to_owned(), |x| format!("{:.1} %", 100.0 * x));
                canvas.draw(&Text::new(text, (LEFT + length + 6, y), letters(12))).map_err(PlotError::new)?;
            }
        }
        Ok(())
    })
}
