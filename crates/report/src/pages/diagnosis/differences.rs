//! What differs between the machine and what was compared with it.

use crate::diagnosis::Difference;
use crate::diagnosis::json::GapFile;
use crate::diagnosis::probability;
use maud::{Markup, html};
use switchback_io::diagnosis::{digits, whole_percent};

/// One row each: value in the source and in the machine, both on an axis with the interval of the latter, closure as a bar; rows that are the same folded.
pub(super) fn differences(gap: &GapFile) -> Markup {
    let (off, same): (Vec<_>, Vec<_>) = gap.differences.iter().partition(|row| row.differs);
    html! {
        @if off.is_empty() { p { "No value differs." } } @else { (table(&off, "Values that differ, those that matter most first")) }
        @if !same.is_empty() {
            details { summary { "The same on both sides (" (same.len()) ")" } (table(&same, "Values that are the same")) }
        }
        p class="note" {
            "Filled: the machine, with its 95 % interval; hollow: what was compared with it. A delay is relative to the machine's. Closure: the share of the gap that "
            "would stay without this value, the others fitted again."
        }
    }
}

fn table(rows: &[&Difference], caption: &str) -> Markup {
    html! {
        div class="scroll" tabindex="0" role="region" aria-label=(caption) {
            table {
                caption { (caption) }
                thead { tr {
                    th scope="col" { "quantity" } th scope="col" class="n" { "there" } th scope="col" class="n" { "in the machine" }
                    th scope="col" { "unit" } th scope="col" { "both on one axis" } th scope="col" class="n" { "probability" } th scope="col" { "closure" }
                } }
                tbody { @for row in rows { (line(row)) } }
            }
        }
    }
}

fn line(row: &Difference) -> Markup {
    let there = row.in_a.map_or_else(|| "–".to_owned(), |x| digits(x, 4));
    html! {
        tr {
            th scope="row" {
                (row.what.replace('_', " "))
                @if let Some(attribute) = &row.attribute { span class="note" { " (MuJoCo: " (attribute) ")" } }
            }
            td class="n" { (there) }
            td class="n" { (digits(row.in_b, 4)) " ± " (digits(row.se, 2)) }
            td { (row.unit) }
            td { (axis(row)) }
            td class="n" { (probability(row.probability)) }
            td class="n" { @if row.differs { (bar(row.closure)) } }
        }
    }
}

/// Width of the drawings.
const WIDTH: f64 = 180.0;
/// Standard errors of an interval at 95 %.
const HALF: f64 = 1.96;

/// Both values on an axis that holds them and the interval.
fn axis(row: &Difference) -> Markup {
    let (low, high) = (row.in_b - HALF * row.se, row.in_b + HALF * row.se);
    let (Some(there), true) = (row.in_a, low.is_finite() && high.is_finite()) else { return html! {} };
    let (from, to) = (low.min(there), high.max(there));
    let room = if to > from { 0.08 * (to - from) } else { 1.0 };
    let place = |x: f64| (WIDTH * (x - from + room) / (to - from + 2.0 * room)).round();
    html! {
        svg class="bar" width=(WIDTH) height="16" viewBox={ "0 0 " (WIDTH) " 16" } aria-hidden="true" {
            path d={ "M0 8H" (WIDTH) } stroke="var(--grey)" {}
            path d={ "M" (place(low)) " 8H" (place(high)) } stroke="var(--c0)" stroke-width="4" {}
            circle cx=(place(row.in_b)) cy="8" r="5" fill="var(--c0)" {}
            circle cx=(place(there)) cy="8" r="5" fill="none" stroke="var(--c1)" stroke-width="2" {}
        }
    }
}

fn bar(closure: f64) -> Markup {
    let share = closure.clamp(0.0, 1.0);
    html! {
        svg class="bar" width="110" height="16" viewBox="0 0 110 16" aria-hidden="true" {
            path d="M5 14H105" stroke="var(--grey)" {}
            path d={ "M5 8H" (5.0 + (100.0 * share).round()) } stroke="var(--c0)" stroke-width="8" {}
        }
        " " (whole_percent(100.0 * share)) " %"
    }
}
