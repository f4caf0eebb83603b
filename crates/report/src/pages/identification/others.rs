//! What other models do on the held-out records.

use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_io::diagnosis::fit_percent;
use switchback_io::identification::json::{Beside, EstimateFile};

/// Yardsticks, and the best model that could run in real time where this one could not.
pub(super) fn others(estimate: &EstimateFile) -> Markup {
    let mut table = Table::new(
        "Other models on the held-out records",
        [
            "model",
            "its fit",
            "fit of this one",
            "this one's squared error less that, share of the output's variance, 95 % interval",
        ],
    );
    let mut row = |name: String, beside: &Beside| {
        let percent = |fit: f64| Cell::number(format!("{} %", fit_percent(fit)), Some(fit));
        let excess = beside.excess.map(|[mean, low, high]| {
            format!("{:.2} % [{:.2}, {:.2}]", 100.0 * mean, 100.0 * low, 100.0 * high).replace('-', "−")
        });
        table.row([
            Cell::word(name),
            percent(beside.fit_percent),
            percent(beside.own_fit_percent),
            Cell::number(excess.unwrap_or_else(|| "–".to_owned()), beside.excess.map(|e| e[0])),
        ]);
    };
    estimate.baselines.iter().for_each(|beside| row(beside.method.clone(), beside));
    if let Some(held_out) = estimate.causal_alternative.as_ref().and_then(|causal| causal.held_out.as_ref()) {
        row("the same, in real time".to_owned(), held_out);
    }
    html! {
        (table.html())
        p {
            @if estimate.causal { "The model could run in real time." }
            @else if let Some(causal) = &estimate.causal_alternative {
                "The model looks ahead and could not run in real time; the best that could has order " (causal.order) " and delay " (causal.delay) "."
            } @else { "The model looks ahead and could not run in real time." }
        }
    }
}
