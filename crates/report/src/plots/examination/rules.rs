//! The diagnosis beside simpler rules: what should be large, and what should be small.

use crate::plots::axis::Axis;
use crate::plots::legend::Entry;
use crate::plots::panel::{Mark, Panel};
use crate::plots::sheet::{Grid, Sheet};
use crate::plots::style::{OKABE_ITO, Pen, RADIUS, TextLook, percent};
use switchback_lab::examination::{Cell, Table};

/// Height of a rule's row, and how far its marks stand from its middle, pixels.
const ROW: f64 = 52.0;
const ASIDE: f64 = 11.0;
/// Room for the figures right of a frame, pixels.
const FIGURES: f64 = 70.0;

/// A diagram: what its direction means, and its two shares with the columns that hold them.
type Half = (&'static str, [(&'static str, &'static str); 2]);

const HALVES: [Half; 2] = [
    (
        "the more the better →",
        [("exact, gap ≥ 1 sd", "exact"), ("of the causes named, right ones", "precision")],
    ),
    (
        "← the less the better",
        [
            ("a cause named where there is none", "false_alarm"),
            ("… where it is outside the library", "outside_named"),
        ],
    ),
];

/// Four shares a rule with their intervals.
pub(super) fn baselines(table: &Table) -> String {
    let rows = &table.rows;
    let grid = Grid { left: 180.0, between: 20.0, ..Grid::new(1, HALVES.len(), ROW * rows.len() as f64) };
    let mut sheet = Sheet::new(
        "Baselines: the same rigs under simpler rules",
        vec!["Shares of rigs with 95 % intervals (Wilson).".to_owned()],
        grid,
    );
    if rows.is_empty() {
        return sheet.empty("No rig was judged.");
    }
    let names = HALVES.iter().flat_map(|(_, shares)| shares.iter().map(|(name, _)| *name));
    sheet.legend = names.zip(OKABE_ITO).map(|(name, colour)| Entry::disc(colour, name)).collect();
    sheet.render(|canvas, frames| {
        let (width, height) = frames.size();
        for (h, (direction, shares)) in HALVES.into_iter().enumerate() {
            let (left, top) = frames.corner(0, h);
            let width = width - FIGURES;
            let axes = (Axis::percent(0.0, 1.0), Axis::rows(rows.len() as f64));
            let panel = Panel::new(canvas, (left, top), (width, height), axes);
            panel.title(direction);
            panel.x_name("share");
            for (i, row) in rows.iter().enumerate() {
                let middle = i as f64 + 0.5;
                if let (0, Some(Cell::Word(rule))) = (h, row.get("rule")) {
                    canvas.text(rule, (left - 10.0, top + ROW * middle), TextLook::label().end());
                }
                for (k, (_, column)) in shares.into_iter().enumerate() {
                    let aside = if k == 0 { -ASIDE } else { ASIDE };
                    let at = (left + width + FIGURES - 12.0, top + ROW * middle + aside);
                    let look = TextLook::number().end();
                    let share = Table::share(row, column);
                    let (Some(value), Some([low, high])) = (share.value(), share.interval()) else {
                        canvas.text("–", at, look);
                        continue;
                    };
                    let mark = Mark { aside, ..Mark::disc(Pen::data(OKABE_ITO[2 * h + k]), RADIUS) };
                    panel.level_mark((low, high), value, middle, mark);
                    canvas.text(&percent(value, 1), at, look);
                }
            }
        }
    })
}
