//! *Where*: the cells a diagnosis flags against the cells where the true effect acts.
//!
//! A cell is understood from its axis and its label alone, as a reader of `gap.json` would; its samples are found in the
//! rig here, without the diagnosis' own code.

use switchback_estimator::rig::Rig;
use switchback_gap::Cell;
use switchback_maker::Truth;

/// Cells of one axis, flagged and true.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaceCheck {
    /// The axis.
    pub axis: &'static str,
    /// Flagged, and the effect acts there.
    pub hits: usize,
    /// Flagged, but it does not.
    pub false_flags: usize,
    /// Not flagged, but it does.
    pub misses: usize,
}

/// A cell is flagged at this q-value.
const FLAGGED: f64 = 0.05;
/// The effect acts in a cell when its mean square there is at least this share of its mean square over all samples.
const ACTS: f64 = 0.1;
/// Cells with fewer samples are not judged.
const FEWEST: usize = 30;

/// What is known of the sample whose input drove a prediction.
struct Circumstance<'a> {
    record: &'a str,
    branch: &'static str,
    v: f64,
    y: f64,
    speed: f64,
    travel: f64,
    rest: f64,
    loop_size: f64,
    time: f64,
    surviving: f64,
}

/// Compares each axis that can be told from the records; spectra are not.
pub(super) fn check(cells: &[Cell], rig: &Rig, truth: &[Truth]) -> Vec<PlaceCheck> {
    let samples = circumstances(rig, truth);
    let all = mean_square(samples.iter());
    let mut checks: Vec<PlaceCheck> = Vec::new();
    for cell in cells {
        let inside: Vec<&Circumstance<'_>> =
            samples.iter().filter(|s| holds(cell, s).unwrap_or(false)).collect();
        if inside.len() < FEWEST {
            continue;
        }
        let acts = all > 0.0 && mean_square(inside.into_iter()) >= ACTS * all;
        let flagged = cell.q_value <= FLAGGED;
        let at = checks.iter().position(|c| c.axis == cell.axis).unwrap_or_else(|| {
            checks.push(PlaceCheck { axis: cell.axis, hits: 0, false_flags: 0, misses: 0 });
            checks.len() - 1
        });
        checks[at].hits += usize::from(flagged && acts);
        checks[at].false_flags += usize::from(flagged && !acts);
        checks[at].misses += usize::from(!flagged && acts);
    }
    checks
}

fn mean_square<'s, 'r: 's>(samples: impl Iterator<Item = &'s Circumstance<'r>>) -> f64 {
    let (mut sum, mut count) = (0.0, 0_usize);
    for s in samples {
        sum += s.surviving * s.surviving;
        count += 1;
    }
    sum / count.max(1) as f64
}

/// Whether a sample lies in a cell; none for an axis that is not a property of single samples.
fn holds(cell: &Cell, s: &Circumstance<'_>) -> Option<bool> {
    let between = |x: f64| {
        let (low, high) = cell.cell.split_once("..")?;
        let (low, high): (f64, f64) = (low.parse().ok()?, high.parse().ok()?);
        Some(low <= x && x < high)
    };
    match cell.axis {
        "record" => Some(cell.cell == s.record),
        "branch" => Some(cell.cell == s.branch),
        "v" => between(s.v),
        "y" => between(s.y),
        "speed" if s.speed > 0.0 => between(s.speed),
        "travel_since_reversal" => between(s.travel),
        "rest_samples" => between(s.rest),
        "loop_size" => between(s.loop_size),
        "time" => between(s.time),
        _ => None,
    }
}

fn circumstances<'a>(rig: &'a Rig, truth: &[Truth]) -> Vec<Circumstance<'a>> {
    let total: usize = rig.records.iter().map(|r| r.record.len()).sum();
    let mut samples = Vec::with_capacity(total);
    let mut clock = 0;
    for (record, truth) in rig.records.iter().zip(truth) {
        let (v, y) = (record.record.v(), record.record.y());
        let (mut branch, mut travel, mut rest) = ("holding", 0.0, 0.0);
        let (mut turned_at, mut loop_size) = (v[0], 0.0);
        for t in 1..v.len() {
            // The prediction of sample t answers to the input one sample before.
            let (before, now) = (if t >= 2 { v[t - 2] } else { v[0] }, v[t - 1]);
            let step = now - before;
            if step == 0.0 {
                rest += 1.0;
            } else {
                let direction = if step > 0.0 { "ascending" } else { "descending" };
                if direction != branch {
                    loop_size = f64::abs(before - turned_at);
                    (branch, turned_at, travel) = (direction, before, 0.0);
                }
                (travel, rest) = (travel + step.abs(), 0.0);
            }
            if t >= truth.first {
                samples.push(Circumstance {
                    record: &record.name,
                    branch: if step == 0.0 { "holding" } else { branch },
                    v: now,
                    y: y[t - 1],
                    speed: step.abs(),
                    travel,
                    rest,
                    loop_size,
                    time: (clock + t) as f64 / total as f64,
                    surviving: truth.surviving[t],
                });
            }
        }
        clock += v.len();
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_maker::{Ingredient, MakeRig};

    fn cell(axis: &'static str, cell: &str, q_value: f64) -> Cell {
        Cell { axis, cell: cell.to_owned(), share: 0.0, q_value }
    }

    #[test]
    fn backlash_acts_soon_after_reversals() {
        let made = MakeRig::new(4).with(Ingredient::plain("backlash", 4.0).unwrap()).make().unwrap();
        let width = made.rig.interval.unwrap().width();
        let samples = circumstances(&made.rig, &made.truth);
        let free = || samples.iter().filter(|s| s.record == "sweep");
        let near = mean_square(free().filter(|s| s.travel < 0.05 * width));
        let far = mean_square(free().filter(|s| s.travel > 0.3 * width));
        assert!(near > 3.0 * far, "{near} {far}");
    }

    #[test]
    fn flags_are_counted_against_the_truth() {
        let made = MakeRig::new(4).with(Ingredient::plain("outliers", 4.0).unwrap()).make().unwrap();
        let records: Vec<Cell> = made.rig.records.iter().map(|r| cell("record", &r.name, 0.0)).collect();
        let all = check(&records, &made.rig, &made.truth);
        assert_eq!((all[0].hits + all[0].false_flags, all[0].misses), (7, 0));
        let none = check(&[cell("time", "0.0000..1.0000", 1.0)], &made.rig, &made.truth);
        assert_eq!((none[0].hits, none[0].misses), (0, 1));
    }
}
