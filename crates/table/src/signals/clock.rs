//! What the numbers of a time column mean.

use super::input_form::InputForm;
use super::sampling::rounded;
use super::spelling::simplified;
use crate::table::{Column, DataProblem, Kind, unit};

/// From a time column's numbers to seconds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Clock {
    /// Seconds in the column's unit.
    pub unit: f64,
    /// Subtracted first, so that small steps of large numbers keep their digits.
    origin: f64,
    column: String,
    /// What a number without a unit was taken for, where it is no plain number of seconds.
    epoch: Option<&'static str>,
    /// Whether nobody named the unit.
    is_assumed: bool,
    /// Whether numbers without a unit were taken as days.
    is_days: bool,
}

/// Numbers of days: since 1899-12-30, as spreadsheets count them, from 1954 to 2119; since the year 0, as MATLAB does, from 1900 to 2190.
const DAYS: [(f64, f64); 2] = [(20_000.0, 80_000.0), (693_962.0, 800_000.0)];
/// Steps below this are no seconds where the number is one of such a day.
const SHORT: f64 = 1e-3;
/// Rates outside of these are doubted: no machine with hysteresis is sampled a million times a second, and few once an hour.
const LIKELY: [f64; 2] = [1.0 / 3600.0, 1e6];

/// Numbers beyond these, and what they must be: seconds since 1970 reach 1e11 in the year 5138, and a thousand times as many milliseconds
/// do so in the same year, while they passed 1e11 in 1973.
const EPOCHS: [(f64, f64, &str); 3] =
    [(1e17, 1e-9, "nanoseconds"), (1e14, 1e-6, "microseconds"), (1e11, 1e-3, "milliseconds")];

impl Clock {
    /// By the unit in the header, else by the size of the numbers.
    ///
    /// # Errors
    /// A unit that is no time's.
    pub(super) fn of(column: &Column, raw: &[f64], input_form: &InputForm) -> Result<Self, DataProblem> {
        let first = raw.first().copied().unwrap_or(0.0);
        // Subtracted already where a number has more digits than a value keeps.
        let size = (first + column.origin as f64).abs();
        let clock = |unit| Self {
            unit,
            origin: 0.0,
            column: column.label(),
            epoch: None,
            is_assumed: false,
            is_days: false,
        };
        let by_name = simplified(&column.name).rsplit(' ').next().and_then(unit_named);
        let is_day =
            DAYS.iter().any(|(low, high)| (*low..*high).contains(&first)) && median_step(raw) < SHORT;
        match &column.unit {
            _ if column.kind == Kind::Stamp => Ok(clock(1.0)),
            Some(unit) => unit::seconds(unit).map(clock).ok_or_else(|| DataProblem::NoSampleTime {
                reason: format!("`{unit}`, the unit of `{}`, is no time", column.label()),
                remedy: format!(
                    "write s, ms, us, min or h, or name another time column; {} goes without one",
                    input_form.without_time()
                ),
            }),
            None if by_name.is_some() => Ok(clock(by_name.unwrap_or(1.0))),
            None => Ok(match EPOCHS.into_iter().find(|(least, ..)| size >= *least) {
                Some((_, unit, name)) => Self { origin: first, epoch: Some(name), ..clock(unit) },
                None if is_day => Self { origin: first, is_days: true, ..clock(86_400.0) },
                None => Self { is_assumed: true, ..clock(1.0) },
            }),
        }
    }

    /// Seconds, from 1970 on or whatever instant the column counts from.
    pub(super) fn seconds(&self, stamp: f64) -> f64 {
        self.unit * (stamp - self.origin)
    }

    /// What was assumed and may be wrong.
    pub(super) fn notes(&self, raw: &[f64], sample_time: f64, input_form: &InputForm) -> Vec<String> {
        let column = &self.column;
        let is_whole = || raw.iter().all(|stamp| stamp.fract() == 0.0);
        if let Some(unit) = self.epoch {
            return vec![format!("`{column}` is taken as {unit} since 1970")];
        }
        if self.is_days {
            return vec![format!(
                "`{column}` is taken as days; write the unit into the header if it is another, as in `{column} [s]`"
            )];
        }
        if self.is_assumed && sample_time >= 1.0 && is_whole() {
            return vec![format!(
                "`{column}` is taken as seconds; write the unit into the header, as in `{column} [ms]`, or give {}",
                input_form.without_time()
            )];
        }
        Vec::new()
    }

    /// A rate that no such machine is sampled at, in words.
    pub(super) fn doubt(&self, sample_time: f64, input_form: &InputForm) -> Option<String> {
        let [low, high] = LIKELY;
        let rate = 1.0 / sample_time;
        (!(low..=high).contains(&rate)).then(|| {
            format!(
                "{} Hz, from `{}`, is no likely sample rate: write the unit of the column into the header, as in `time [ms]` or `time [d]`, or give {}",
                rounded(rate),
                self.column,
                input_form.without_time()
            )
        })
    }
}

/// Seconds in a unit that is the last word of a column's name: `millis`, `TimeUS`. Single letters are no such word.
fn unit_named(word: &str) -> Option<f64> {
    match word {
        "millis" => Some(1e-3),
        "micros" => Some(1e-6),
        "nanos" | "nanosec" | "nsec" => Some(1e-9),
        word => unit::seconds(word).filter(|_| word.len() > 1),
    }
}

/// The usual step of some numbers.
fn median_step(raw: &[f64]) -> f64 {
    let mut steps: Vec<f64> = raw.windows(2).take(2000).map(|pair| (pair[1] - pair[0]).abs()).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY)
}
