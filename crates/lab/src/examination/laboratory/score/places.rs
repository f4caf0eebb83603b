//! Where: flagged cells against true ones, summed over rigs.

use super::accuracy::singles;
use crate::blind::case::Case;
use crate::blind::place::PlaceCheck;

/// Cells of one axis over all plain single effects of size ≥ 1.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceRow {
    /// The axis.
    pub axis: &'static str,
    /// Flagged cells in which the effect acts, over all flagged.
    pub precision: f64,
    /// Flagged cells in which the effect acts, over all in which it acts.
    pub recall: f64,
    /// Harmonic mean of both.
    pub f1: f64,
    /// Cells in which the effect acts.
    pub cells: usize,
}

pub(super) fn rows(cases: &[Case]) -> Vec<PlaceRow> {
    let checks: Vec<&PlaceCheck> = judged(cases).collect();
    let mut axes: Vec<&'static str> = Vec::new();
    for check in &checks {
        if !axes.contains(&check.axis) {
            axes.push(check.axis);
        }
    }
    let mut rows: Vec<PlaceRow> =
        axes.iter().map(|axis| row(axis, checks.iter().filter(|c| c.axis == *axis))).collect();
    if !checks.is_empty() {
        rows.push(row("all", checks.iter()));
    }
    rows
}

fn judged(cases: &[Case]) -> impl Iterator<Item = &PlaceCheck> {
    singles(cases).filter(|c| c.is_large()).flat_map(|c| &c.places)
}

fn row<'a>(axis: &'static str, checks: impl Iterator<Item = &'a &'a PlaceCheck>) -> PlaceRow {
    let (mut hits, mut false_flags, mut misses) = (0, 0, 0);
    for check in checks {
        hits += check.hits;
        false_flags += check.false_flags;
        misses += check.misses;
    }
    let share = |part: usize, whole: usize| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
    PlaceRow {
        axis,
        precision: share(hits, hits + false_flags),
        recall: share(hits, hits + misses),
        f1: share(2 * hits, 2 * hits + false_flags + misses),
        cells: hits + misses,
    }
}
