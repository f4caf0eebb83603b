//! Time stamps that stand still, run back or start anew, brought into order.

use super::input_form::InputForm;
use super::sampling::{APART, Fault, nice, rounded};
use crate::table::{DataProblem, Step};

/// Time stamps in order, of fewer rows than before where some shared an instant.
#[derive(Debug, Default)]
pub(super) struct Instants {
    /// Which stamps are left.
    pub(super) kept: Vec<usize>,
    /// Seconds of those, increasing; where time starts anew a long gap stands between.
    pub(super) t: Vec<f64>,
    /// Of those, the ones from which time starts anew.
    pub(super) starts: Vec<usize>,
    /// What was done.
    pub(super) notes: Vec<String>,
}

/// Share of stamps equal to the one before from which the clock is called coarse.
const COARSE: f64 = 0.3;
/// Rows on both sides of a jump that show whether time goes on evenly there.
const BESIDE: usize = 8;
/// Steps before and behind that show that time goes on where it starts anew.
const GOES_ON: usize = 3;
/// The column as messages call it, and its stamps.
pub(super) struct Written<'a> {
    pub(super) column: &'a str,
    /// Each stamp as it stands in the file.
    pub(super) stamp: &'a dyn Fn(usize) -> String,
    /// `line 3`.
    pub(super) place: &'a dyn Fn(usize) -> String,
    pub(super) input_form: &'a InputForm,
}

impl Instants {
    /// # Errors
    /// Stamps in disorder, and those whose unit changes.
    pub(super) fn of(t: &[f64], written: &Written<'_>) -> Result<Self, Fault> {
        let whole = || Self { kept: (0..t.len()).collect(), t: t.to_vec(), ..Self::default() };
        let steps: Vec<f64> = t.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let Some(usual) = median(steps.iter().copied().filter(|step| *step > 0.0)) else {
            return Ok(whole());
        };
        check_unit(&steps, usual, written)?;
        if steps.iter().all(|step| *step > 0.0) {
            return Ok(whole());
        }
        let equal = steps.iter().filter(|step| **step == 0.0).count();
        let runs_back = steps.iter().any(|step| *step < 0.0);
        if equal as f64 >= COARSE * steps.len() as f64 && !runs_back {
            return coarse(t, usual, written).map_or_else(|| Ok(whole()), Ok);
        }
        let mut instants = Self::default();
        let is_last = |k: &usize| k + 1 == t.len() || t[k + 1] != t[*k];
        instants.kept = (0..t.len()).filter(is_last).collect();
        if let Some(first) = (1..t.len()).find(|k| t[*k] == t[k - 1]) {
            let count = t.len() - instants.kept.len();
            instants.notes.push(format!(
                "`{}` stands still at {count} {}, the first of them {}: of rows of one instant the last counts",
                written.column,
                if count == 1 { "row" } else { "rows" },
                (written.place)(first)
            ));
        }
        instants.start_anew(t, usual, written);
        Ok(instants)
    }

    /// Moves every part from which time starts anew behind the one before it.
    fn start_anew(&mut self, t: &[f64], usual: f64, written: &Written<'_>) {
        let own: Vec<f64> = self.kept.iter().map(|k| t[*k]).collect();
        let steps: Vec<f64> = own.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // A single stamp that is off is followed by a jump back.
        let is_usual = |steps: &[f64]| steps.iter().all(|step| *step > 0.0 && *step < 3.0 * usual);
        let mut offset = 0.0;
        for (k, now) in own.iter().enumerate() {
            let step = k.checked_sub(1).map_or(0.0, |before| steps[before]);
            let goes_on = || {
                is_usual(&steps[k.saturating_sub(GOES_ON + 1)..k - 1])
                    && is_usual(&steps[k..(k + GOES_ON).min(steps.len())])
            };
            if step < -2.0 * usual && goes_on() {
                offset += APART * usual - step;
                self.starts.push(k);
            }
            self.t.push(now + offset);
        }
        if let Some(first) = self.starts.first() {
            let place = (written.place)(self.kept[*first]);
            let column = written.column;
            self.notes.push(match self.starts.len() {
                1 => format!("`{column}` starts anew at {place}, where another record begins"),
                count => format!(
                    "`{column}` starts anew {count} times, first at {place}: each time another record begins"
                ),
            });
        }
    }
}

/// Rows that share a coarse stamp, spread evenly; none where they cannot have been even.
fn coarse(t: &[f64], unit: f64, written: &Written<'_>) -> Option<Instants> {
    let changes: Vec<usize> = (1..t.len()).filter(|k| t[*k] > t[k - 1]).collect();
    let (first, last) = (*changes.first()?, *changes.last()?);
    let steps = (last - first) as f64;
    let mean = (t[last] - t[first]) / steps;
    let step = nice(mean, unit / steps);
    let even = |k: usize| t[first] + step * (k as f64 - first as f64);
    let is_even = (0..t.len()).all(|k| (even(k) - t[k]).abs() <= 1.01 * unit);
    (steps > 0.0 && is_even).then(|| Instants {
        kept: (0..t.len()).collect(),
        t: (0..t.len()).map(even).collect(),
        notes: vec![format!(
            "`{}` is written to {} s only, so that up to {} rows share an instant: they are taken as even",
            written.column,
            rounded(unit),
            (unit / step).round()
        )],
        ..Instants::default()
    })
}

/// Steps that become a thousand times longer or shorter are of another unit.
fn check_unit(steps: &[f64], usual: f64, written: &Written<'_>) -> Result<(), Fault> {
    const RATIOS: [f64; 5] = [60.0, 1e3, 3.6e3, 1e6, 1e9];
    let pure = |part: &[f64]| {
        let (low, high) =
            part.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), step| (low.min(*step), high.max(*step)));
        (low > 0.0 && high < 2.0 * low).then_some(high)
    };
    for k in 1..steps.len().saturating_sub(1) {
        if (0.05 * usual..20.0 * usual).contains(&steps[k - 1])
            && (0.05 * usual..20.0 * usual).contains(&steps[k + 1])
        {
            continue;
        }
        let (before, behind) =
            (&steps[k.saturating_sub(BESIDE)..k], &steps[k + 1..(k + 1 + BESIDE).min(steps.len())]);
        let (Some(before), Some(behind)) = (pure(before), pure(behind)) else { continue };
        let ratio = (before / behind).max(behind / before);
        if RATIOS.iter().any(|unit| (ratio / unit - 1.0).abs() < 0.05) {
            let step = Step {
                column: written.column.to_owned(),
                before: (written.stamp)(k),
                now: (written.stamp)(k + 1),
                step: rounded(behind),
                sample_time: rounded(before),
                remedy: format!(
                    "write the whole column in one unit, or take {} if the rows are even",
                    written.input_form.without_time()
                ),
            };
            return Err((Some(k + 1), DataProblem::UnitChanges(Box::new(step))));
        }
    }
    Ok(())
}

fn median(of: impl Iterator<Item = f64>) -> Option<f64> {
    let mut of: Vec<f64> = of.collect();
    of.sort_by(f64::total_cmp);
    of.get(of.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(t: &[f64]) -> Result<Instants, Fault> {
        let written = Written {
            column: "t",
            stamp: &|k| t[k].to_string(),
            place: &|k| format!("line {}", k + 2),
            input_form: &InputForm::Manifest,
        };
        Instants::of(t, &written)
    }

    fn even(rows: usize, step: f64) -> Vec<f64> {
        (0..rows).map(|k| step * k as f64).collect()
    }

    #[test]
    fn of_one_instant_the_last_row_counts() {
        let mut t = even(50, 0.01);
        t.insert(20, t[20]);
        let instants = settled(&t).unwrap();
        assert_eq!((instants.kept.len(), instants.kept[20]), (50, 21));
        assert!(instants.notes[0].contains("line 23"), "{:?}", instants.notes);
    }

    #[test]
    fn time_that_starts_anew_begins_a_record() {
        let t = [even(100, 0.01), even(100, 0.01), even(100, 0.01)].concat();
        let instants = settled(&t).unwrap();
        assert_eq!(instants.starts, [100, 200]);
        assert!(instants.t.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn coarse_stamps_are_spread_evenly() {
        let t: Vec<f64> = (0..4000).map(|k| (10_000.0 + 0.005 * f64::from(k)).round()).collect();
        let spread = settled(&t).unwrap().t;
        assert!(spread.windows(2).all(|pair| (pair[1] - pair[0] - 0.005).abs() < 1e-9));
    }

    #[test]
    fn a_unit_that_changes_is_named() {
        let t: Vec<f64> =
            (0..400).map(|k| 0.005 * f64::from(k)).map(|t| if t < 1.0 { 1000.0 * t } else { t }).collect();
        assert!(matches!(settled(&t), Err((Some(200), DataProblem::UnitChanges(_)))));
    }

    #[test]
    fn disorder_is_left_for_others_to_refuse() {
        let mut t = even(50, 0.01);
        t.swap(20, 21);
        assert!(settled(&t).unwrap().starts.is_empty());
    }
}
