//! What must be reached, and what was.

use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_lab::examination::{Bound, Measure};

/// The answer in a sentence.
pub(super) fn answer(measures: &[Measure]) -> Markup {
    let judged: Vec<&Measure> = measures.iter().filter(|m| m.target.is_some() && m.meets.is_some()).collect();
    let short: Vec<&str> =
        judged.iter().filter(|m| m.meets == Some(false)).map(|m| m.text.as_str()).collect();
    let open = measures.iter().filter(|m| m.target.is_some() && m.meets.is_none()).count();
    html! {
        p class="lead" {
            (judged.len() - short.len()) " of " (judged.len()) " measures reach what they must."
            @if open > 0 { " " (open) " cannot be distinguished from so few rigs." }
        }
        @if !short.is_empty() { p class="bad" { "Short: " (short.join("; ")) "." } }
    }
}

/// A row a measure.
pub(super) fn table(measures: &[Measure]) -> Markup {
    let mut table = Table::new(
        "What must be reached, and what was",
        ["measure", "must reach", "reached", "95 % interval", "rigs", "verdict"],
    );
    for measure in measures {
        let figure = |x| measure.figure(x);
        let bound = |bound: Bound| match bound {
            Bound::AtLeast(x) => format!("≥ {}", figure(x)),
            Bound::AtMost(x) => format!("≤ {}", figure(x)),
            Bound::Within(low, high) => format!("{} to {}", figure(low), figure(high)),
        };
        let verdict = match (measure.target, measure.meets) {
            (None, _) => "",
            (_, None) => "not reported",
            (_, Some(true)) => "reached",
            (_, Some(false)) => "short",
        };
        table.row([
            Cell::word(measure.text.clone()),
            Cell::word(measure.target.map_or_else(String::new, bound)),
            Cell::number(measure.reached.map_or_else(|| "–".to_owned(), figure), measure.reached),
            Cell::word(
                measure.interval.map_or_else(String::new, |[low, high]| {
                    format!("{:.1}–{:.1} %", 100.0 * low, 100.0 * high)
                }),
            ),
            Cell::number(measure.rigs.to_string(), Some(measure.rigs as f64)),
            Cell::word(verdict),
        ]);
    }
    html! {
        (table.html())
        p class="note" { "Intervals of shares are Wilson's. A size of 1 sd is an effect whose surviving gap is as large as the noise." }
    }
}
