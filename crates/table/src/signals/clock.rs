//! What the numbers of a time column mean.

use super::input_form::InputForm;
use super::pace::{COUNTED, Pace};
use super::sampling::rounded;
use super::spelling::simplified;
use super::time_of_day;
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
    /// Whether numbers are times of day as HHMMSS.
    is_time_of_day: bool,
    /// A unit other than seconds that whole numbers without one were taken for.
    guessed: Option<&'static str>,
    /// A position and its speed that show the unit.
    seen: Option<[String; 2]>,
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

/// Rates between which a unit is sought for a clock of whole numbers, and their middle: of two units the nearer one is likelier.
const SOUGHT: [f64; 2] = [0.5, 1e6];
const MIDDLE: f64 = 100.0;

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
            is_time_of_day: false,
            guessed: None,
            seen: None,
        };
        let by_name = simplified(&column.name).rsplit(' ').next().and_then(unit_named);
        let is_day =
            DAYS.iter().any(|(low, high)| (*low..*high).contains(&first)) && median_step(raw) < SHORT;
        let is_time_of_day = || {
            column.unit.as_deref().is_none_or(|unit| unit::seconds(unit) == Some(1.0))
                && column.origin == 0
                && time_of_day::is_time_of_day(raw)
        };
        match &column.unit {
            _ if column.kind == Kind::Stamp => Ok(clock(1.0)),
            _ if is_time_of_day() => Ok(Self { is_time_of_day: true, ..clock(1.0) }),
            Some(unit) => unit::seconds(unit).map(clock).ok_or_else(|| DataProblem::NoSampleTime {
                reason: format!("`{unit}`, the unit of `{}`, is no time", column.label()),
                remedy: format!(
                    "write s, ms, us, min or h, or name another time column; {} goes without one",
                    input_form.without_time()
                ),
            }),
            None if by_name.is_some() => Ok(clock(by_name.unwrap_or(1.0))),
            None => Ok(match EPOCHS.into_iter().find(|(least, ..)| size >= *least) {
                // Counted since a start rather than since 1970.
                Some((_, unit, _)) if is_counted(unit, size, median_step(raw)) => {
                    Self { origin: first, is_assumed: true, ..clock(1.0) }
                }
                Some((_, unit, name)) => Self { origin: first, epoch: Some(name), ..clock(unit) },
                None if is_day => Self { origin: first, is_days: true, ..clock(86_400.0) },
                None => Self { is_assumed: true, ..clock(1.0) },
            }),
        }
    }

    /// Whole numbers without a unit, in the one that speeds beside positions show.
    pub(super) fn paced(self, raw: &[f64], pace: impl FnOnce() -> Option<Pace>) -> Self {
        if !self.is_assumed || !are_whole(raw) {
            return self;
        }
        match pace() {
            Some(Pace { unit, name, seen }) => {
                let guessed = (unit < 1.0).then_some(name);
                Self { unit, is_assumed: false, guessed, seen: Some(seen), ..self }
            }
            None => self,
        }
    }

    /// With a unit that is no assumption: the program's own, or that of a sample time given.
    pub(super) fn settled(self) -> Self {
        Self { is_assumed: false, ..self }
    }

    /// Whole numbers in steps of two or more, without a unit, in the one that fits the sample time given, else in one of a likely rate.
    pub(super) fn counting(self, raw: &[f64], sample_time: Option<f64>) -> Self {
        let step = median_step(raw);
        if !self.is_assumed || !(2.0..1e12).contains(&step) || !are_whole(raw) {
            return self;
        }
        let rate = |unit: f64| 1.0 / (unit * step);
        let found = match sample_time {
            Some(given) => COUNTED.into_iter().find(|(unit, _)| (unit * step / given - 1.0).abs() < 0.3),
            None => {
                let far = |unit: f64| (rate(unit) / MIDDLE).ln().abs();
                let likely =
                    COUNTED.into_iter().filter(|(unit, _)| (SOUGHT[0]..=SOUGHT[1]).contains(&rate(*unit)));
                likely.min_by(|a, b| far(a.0).total_cmp(&far(b.0)))
            }
        };
        match found {
            Some((unit, name)) if unit < 1.0 => {
                Self { unit, is_assumed: false, guessed: sample_time.is_none().then_some(name), ..self }
            }
            _ => self,
        }
    }

    /// Seconds, from 1970 on or whatever instant the column counts from.
    pub(super) fn seconds(&self, stamp: f64) -> f64 {
        if self.is_time_of_day { time_of_day::seconds(stamp) } else { self.unit * (stamp - self.origin) }
    }

    /// Seconds from an instant that clocks of this kind share.
    pub(super) fn shared_seconds(&self, stamp: f64) -> f64 {
        self.seconds(stamp) + self.unit * self.origin
    }

    /// What was assumed and may be wrong.
    pub(super) fn notes(&self) -> Vec<String> {
        let column = &self.column;
        if let Some(unit) = self.epoch {
            return vec![format!("`{column}` is taken as {unit} since 1970")];
        }
        if self.is_days {
            return vec![format!(
                "`{column}` is taken as days; write the unit into the header if it is another, as in `{column} [s]`"
            )];
        }
        if self.is_time_of_day {
            return vec![format!("`{column}` is taken as the time of day, HHMMSS in one number")];
        }
        Vec::new()
    }

    /// A unit that was guessed, or a rate that no such machine is sampled at, in words.
    pub(super) fn doubt(&self, raw: &[f64], sample_time: f64, input_form: &InputForm) -> Option<String> {
        let [low, high] = LIKELY;
        let rate = 1.0 / sample_time;
        if let Some(unit) = self.guessed {
            let column = &self.column;
            let why = self.seen.as_ref().map_or_else(String::new, |[place, speed]| {
                format!(", in which `{place}` changes as `{speed}` says")
            });
            return Some(format!(
                "`{column}` has no unit and is taken as {unit}{why}, which makes {} Hz: write the unit into the header, as in `{column} [{unit}]`, or give {}",
                rounded(rate),
                input_form.without_time()
            ));
        }
        if self.is_assumed && sample_time >= 1.0 && are_whole(raw) {
            let column = &self.column;
            return Some(format!(
                "`{column}` has no unit and is taken as seconds, which makes {} Hz: write the unit into the header, as in `{column} [s]` or `{column} [ms]`, or give {}",
                rounded(rate),
                input_form.without_time()
            ));
        }
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

/// Whether numbers as large as instants since 1970 in some unit are none: they would be of no year in which logs were written, at no likely rate,
/// or of any year at a rate that is doubted, while another unit makes a likely rate.
fn is_counted(unit: f64, size: f64, step: f64) -> bool {
    /// Seconds from 1970 to 1990 and to 2060.
    const LOGGED: [f64; 2] = [6.3e8, 2.84e9];
    let is_within = |[low, high]: [f64; 2], x: f64| (low..=high).contains(&x);
    let rate = |unit: f64| 1.0 / (unit * step);
    let is_likely = match is_within(LOGGED, unit * size) {
        true => is_within(LIKELY, rate(unit)),
        false => is_within(SOUGHT, rate(unit)),
    };
    !is_likely && COUNTED.into_iter().any(|(other, _)| other < unit && is_within(SOUGHT, rate(other)))
}

fn are_whole(raw: &[f64]) -> bool {
    raw.iter().all(|stamp| stamp.fract() == 0.0)
}

/// The usual step of some numbers.
fn median_step(raw: &[f64]) -> f64 {
    let mut steps: Vec<f64> = raw.windows(2).take(2000).map(|pair| (pair[1] - pair[0]).abs()).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY)
}
