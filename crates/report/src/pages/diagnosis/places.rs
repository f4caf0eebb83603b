//! Where the gap lies, as a table.

use crate::diagnosis::SIGNIFICANT;
use crate::diagnosis::json::{GapFile, Place};
use crate::pages::table::{Cell, Table};
use crate::plots::style::plain;
use maud::{Markup, html};

/// A row a cell of the map.
pub(super) fn places(gap: &GapFile) -> Markup {
    let head = ["axis", "place", "energy", "exposure", "enrichment", "denser, q", "beyond noise, q"];
    let mut table = Table::new("The map, cell by cell", head);
    for place in &gap.r#where {
        let percent = |x: f64| Cell::number(format!("{:.1} %", 100.0 * x), Some(x));
        let q =
            |x: f64| Cell::number(if x < 0.001 { "< 0.001".to_owned() } else { format!("{x:.3}") }, Some(x));
        table.row([
            Cell::word(place.axis.replace('_', " ")),
            Cell::word(reported(place)),
            percent(place.share),
            percent(place.exposure),
            Cell::number(format!("× {:.2}", place.enrichment), Some(place.enrichment)),
            q(place.enrichment_q_value),
            q(place.q_value),
        ]);
    }
    html! {
        p class="note" {
            "Energy: share of the errors' energy beyond the noise. Exposure: share of the samples there (on the frequency axis, of the range). "
            "Enrichment: the one over the other; above 1 the gap is denser there than on average. A place counts from q < " (SIGNIFICANT)
            " on; false discoveries are controlled. Axes overlap: one fault shows on several."
        }
        (table.html())
    }
}

fn reported(place: &Place) -> String {
    let plain = |x: f64| plain(format!("{x:.3e}").parse().unwrap_or(x));
    let unit = place.unit.as_deref().unwrap_or_default();
    match (place.low, place.high) {
        (Some(low), Some(high)) => format!("{} to {} {unit}", plain(low), plain(high)),
        (Some(low), None) => format!("above {} {unit}", plain(low)),
        (None, Some(high)) => format!("below {} {unit}", plain(high)),
        (None, None) => place.cell.replace('_', " "),
    }
}
