//! *Where*: the cells a diagnosis flags against the cells where the true effect acts.
//!
//! A cell is understood from its axis, its name and its ends, as a reader of `gap.json` would; its samples are found in the
//! rig here, without the diagnosis' own code.

use crate::examination::place_check::PlaceCheck;
use crate::generate::Truth;
use switchback_diagnose::Cell;
use switchback_model::rig::Rig;

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
    /// Input units a second.
    speed: f64,
    travel: f64,
    rest: f64,
    loop_size: f64,
    time: f64,
    surviving: f64,
}

/// Compares each axis that can be distinguished from the records; spectra are not.
pub(super) fn check(cells: &[Cell], rig: &Rig, truth: &[Truth]) -> Vec<PlaceCheck> {
    let samples = circumstances(rig, truth);
    let all = mean_square(samples.iter());
    let mut checks: Vec<PlaceCheck> = Vec::new();
    for cell in cells {
        let Some(region) = Region::of(cell) else { continue };
        let inside: Vec<&Circumstance<'_>> = samples.iter().filter(|s| region.holds(s)).collect();
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

/// What a cell holds, understood once.
enum Region<'a> {
    Record(&'a str),
    Branch(&'a str),
    Between(fn(&Circumstance<'_>) -> f64, std::ops::Range<f64>),
}

impl<'a> Region<'a> {
    /// None for an axis that is not a property of single samples, such as frequency.
    fn of(cell: &'a Cell) -> Option<Self> {
        let property: fn(&Circumstance<'_>) -> f64 = match cell.axis {
            "record" => return Some(Self::Record(&cell.cell)),
            "branch" => return Some(Self::Branch(&cell.cell)),
            "v" => |s| s.v,
            "y" => |s| s.y,
            // A rest has no speed and lies in no cell of it.
            "speed" => |s| if s.speed > 0.0 { s.speed } else { f64::NAN },
            "travel_since_reversal" => |s| s.travel,
            "rest_samples" => |s| s.rest,
            "loop_size" => |s| s.loop_size,
            "time" => |s| s.time,
            _ => return None,
        };
        let ends = cell.interval?;
        Some(Self::Between(property, ends.low..ends.high))
    }

    fn holds(&self, s: &Circumstance<'_>) -> bool {
        match self {
            Self::Record(name) => *name == s.record,
            Self::Branch(name) => *name == s.branch,
            Self::Between(property, range) => range.contains(&property(s)),
        }
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
                    speed: step.abs() / rig.sample_time,
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
    use crate::generate::{MakeRig, RequestedFault};
    use switchback_diagnose::{CellInterval, CellUnit};

    fn cell(axis: &'static str, cell: &str, q_value: f64) -> Cell {
        Cell {
            axis,
            cell: cell.to_owned(),
            interval: None,
            share: 0.0,
            exposure: 0.0,
            enrichment: 0.0,
            q_value,
            enrichment_q_value: q_value,
        }
    }

    fn between(axis: &'static str, [low, high]: [f64; 2], unit: CellUnit) -> Cell {
        Cell { interval: Some(CellInterval { low, high, unit }), ..cell(axis, "", 0.0) }
    }

    #[test]
    fn speeds_are_those_of_the_rig_a_second() {
        let made = MakeRig::new(4).make().unwrap();
        let fastest = circumstances(&made.rig, &made.truth).iter().map(|s| s.speed).fold(0.0, f64::max);
        let moves =
            made.rig.records.iter().flat_map(|r| r.record.v().windows(2).map(|w| (w[1] - w[0]).abs()));
        let most = moves.fold(0.0, f64::max);
        assert!((fastest * made.rig.sample_time - most).abs() < 1e-9 * most, "{fastest} {most}");
        let all = between("speed", [0.0, 2.0 * fastest], CellUnit::InputPerSecond);
        let region = Region::of(&all).unwrap();
        assert!(circumstances(&made.rig, &made.truth).iter().all(|s| region.holds(s) == (s.speed > 0.0)));
    }

    #[test]
    fn backlash_acts_soon_after_reversals() {
        let made = MakeRig::new(4).with(RequestedFault::plain("backlash", 4.0).unwrap()).make().unwrap();
        let width = made.rig.interval.unwrap().width();
        let samples = circumstances(&made.rig, &made.truth);
        let free = || samples.iter().filter(|s| s.record == "sweep");
        let near = mean_square(free().filter(|s| s.travel < 0.05 * width));
        let far = mean_square(free().filter(|s| s.travel > 0.3 * width));
        assert!(near > 3.0 * far, "{near} {far}");
    }

    #[test]
    fn flags_are_counted_against_the_truth() {
        let made = MakeRig::new(4).with(RequestedFault::plain("outliers", 4.0).unwrap()).make().unwrap();
        let records: Vec<Cell> = made.rig.records.iter().map(|r| cell("record", &r.name, 0.0)).collect();
        let all = check(&records, &made.rig, &made.truth);
        assert_eq!((all[0].hits + all[0].false_flags, all[0].misses), (7, 0));
        let whole = Cell { q_value: 1.0, ..between("time", [0.0, 1.0], CellUnit::ShareOfDataset) };
        let none = check(&[whole], &made.rig, &made.truth);
        assert_eq!((none[0].hits, none[0].misses), (0, 1));
    }
}
