//! The unit of a clock without one, by speeds that were logged beside positions.

use super::guess;
use super::spelling::simplified;
use super::words::{self, Words};
use crate::table::{Column, Table};

/// Units that a clock of whole numbers may count in.
pub(super) const COUNTED: [(f64, &str); 4] = [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")];

/// A unit in which the rate of change of a position is the speed beside it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pace {
    /// Seconds.
    pub(super) unit: f64,
    pub(super) name: &'static str,
    /// Labels of a position and its speed.
    pub(super) seen: [String; 2],
}

/// Speeds of places, which are called alike but for such a word.
const SPEEDS: Words = &[
    "dq, qd, dx, xd, qvel, vel, velocity, velocities, speed, speeds, omega, geschwindigkeit, vitesse, velocidad, velocita",
    "速度, 속도",
];
/// What a path between two rows may differ by from that of the speed, as a factor.
const ALIKE: f64 = 1.4;
/// Correlation from which both are the same motion.
const SAME: f64 = 0.9;

impl Pace {
    /// By all positions that move as their speeds say; none where they do not agree on a unit. `raw` has the clock's numbers in these rows.
    pub(super) fn of(table: &Table, rows: &[usize], raw: &[f64]) -> Option<Self> {
        let columns =
            || table.columns.iter().filter(|column| column.is_number() && !guess::stands_still(column));
        let places: Vec<(&Column, Vec<String>)> = columns()
            .filter_map(|column| Some((column, without(column, &[words::PLACE, words::MOTION])?)))
            .collect();
        let mut found: Option<Self> = None;
        for speed in columns() {
            let Some(rest) = without(speed, &[SPEEDS]) else { continue };
            let of_it =
                places.iter().filter(|(place, others)| *others == rest && are_per_second(place, speed));
            for (place, _) in of_it {
                let values = |column: &Column| rows.iter().map(|&row| column.values[row]).collect::<Vec<_>>();
                let Some(ratio) = ratio(raw, &values(place), &values(speed)) else { continue };
                let is_near = |(unit, _): &(f64, &str)| (1.0 / ALIKE..ALIKE).contains(&(ratio / unit));
                let (unit, name) = COUNTED.into_iter().find(is_near)?;
                if found.as_ref().is_some_and(|found| found.unit != unit) {
                    return None;
                }
                found.get_or_insert_with(|| Self { unit, name, seen: [place.label(), speed.label()] });
            }
        }
        found
    }
}

/// The words of a name with a sign for the one that is of a list; none where it has none or several.
fn without(column: &Column, lists: &[Words]) -> Option<Vec<String>> {
    let name = simplified(&column.name);
    let is_of = |word: &str| lists.iter().any(|list| words::has(list, word));
    let once = name.split(' ').filter(|word| is_of(word)).count() == 1;
    once.then(|| name.split(' ').map(|word| if is_of(word) { "…" } else { word }.to_owned()).collect())
}

/// Whether a speed is in the unit of a place for each second, or both have none.
fn are_per_second(place: &Column, speed: &Column) -> bool {
    match (&place.unit, &speed.unit) {
        (None, None) => true,
        (Some(place), Some(speed)) => *speed == format!("{place}/s"),
        _ => false,
    }
}

/// By how much a place moves as a share of what its speed, times the clock's steps, says; none where both are no one motion. Over some rows noise
/// weighs less than from one to the next.
fn ratio(raw: &[f64], place: &[f64], speed: &[f64]) -> Option<f64> {
    /// Rows of a path.
    const PATH: usize = 25;
    let mut sums = [0.0; 3];
    let starts = (0..raw.len().saturating_sub(PATH)).step_by(PATH);
    for start in starts {
        let steps = (start..start + PATH).map(|k| 0.5 * (speed[k] + speed[k + 1]) * (raw[k + 1] - raw[k]));
        let (expected, moved) = (steps.sum::<f64>(), place[start + PATH] - place[start]);
        if expected.is_finite() && moved.is_finite() {
            sums[0] += expected * expected;
            sums[1] += expected * moved;
            sums[2] += moved * moved;
        }
    }
    let [expected, both, moved] = sums;
    (expected > 0.0 && both >= SAME * (expected * moved).sqrt()).then_some(both / expected)
}
