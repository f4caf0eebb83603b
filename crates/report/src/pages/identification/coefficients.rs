//! Every number of the estimate with its interval.

use crate::pages::table::{Cell, Table};
use maud::{Markup, html};
use switchback_identify::statistics::Z95;
use switchback_io::diagnosis::digits;
use switchback_io::identification::json::EstimateFile;
use switchback_io::identification::unit;

/// A row a coefficient.
pub(super) fn coefficients(estimate: &EstimateFile) -> Markup {
    let unit = unit(&estimate.output);
    let mut table = Table::new(
        "Coefficients with 95 % intervals",
        ["coefficient", "estimate", "standard error", "95 % interval", "unit"],
    );
    let mut row = |name: String, value: f64, se: Option<f64>, unit: &str| {
        let se = se.filter(|se| se.is_finite());
        let reported = |x: f64| digits(x, 5);
        table.row([
            Cell::word(name),
            Cell::number(reported(value), Some(value)),
            Cell::number(se.map_or_else(|| "–".to_owned(), |se| digits(se, 2)), se),
            Cell::word(se.map_or_else(
                || "–".to_owned(),
                |se| format!("[{}, {}]", reported(value - Z95 * se), reported(value + Z95 * se)),
            )),
            Cell::word(unit),
        ]);
    };
    for (letter, values, errors, unit) in
        [("a", &estimate.a, &estimate.a_se, ""), ("b", &estimate.b, &estimate.b_se, unit)]
    {
        for (k, value) in values.iter().enumerate() {
            row(format!("{letter}{}", k + 1), *value, errors.get(k).copied(), unit);
        }
    }
    row("static gain".to_owned(), estimate.gain, estimate.gain_se, unit);
    row("output at rest at u_m".to_owned(), estimate.y_low, estimate.y_low_se, unit);
    row("output at rest at u_M".to_owned(), estimate.y_high, estimate.y_high_se, unit);
    row("sd of the equation error".to_owned(), estimate.noise_sd, None, unit);
    html! {
        (table.html())
        p class="note" { "A(q⁻¹) y(t) = Σ bᵢ u(t − delay − i) + e(t), i from 1, for a u that runs from u_m to u_m + 1. Points of the borders are in the figure above and in estimate.json." }
    }
}
