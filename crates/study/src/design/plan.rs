//! A dataset in physical units.

use super::DesignError;
use switchback_identify::excitation::{Dataset, PlannedRecord, Reversals};
use switchback_io::diagnosis::digits;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::Role;

/// Periods of each pulse experiment where no length is asked for: a hundred visits of every level make the mean output there ten times
/// as certain as one.
pub const DEFAULT_PERIODS: usize = 100;

/// Most samples of one pulse experiment: ten million rows are some 200 MB of text.
const MOST_SAMPLES: f64 = 1e7;

/// What to design, in physical units.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Name of the rig to be measured.
    pub name: String,
    /// Order of the linear part.
    pub order: usize,
    /// Levels on each border.
    pub points: usize,
    /// Working interval, input units.
    pub interval: Interval,
    /// Seconds between samples, positive.
    pub sample_time: f64,
    /// Label and unit of input and output.
    pub labels: [String; 2],
    /// Smallest and largest move of the free records, input units; none: from 2 % of the interval to all of it.
    pub amplitude: Option<[f64; 2]>,
    /// What the actuator can do, input units a second.
    pub max_speed: Option<f64>,
    /// Whether to leave the designed experiments out.
    pub free_only: bool,
    /// Seed of the free records.
    pub seed: u64,
}

/// How long to measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Length {
    /// Periods of each pulse experiment.
    Periods(usize),
    /// Seconds of the whole dataset.
    Duration(f64),
}

/// A dataset that the actuator can play.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    request: Request,
    dataset: Dataset,
}

impl Plan {
    /// Lays out the dataset.
    ///
    /// # Errors
    /// [`DesignError`] if the experiments are impossible, too fast for the actuator, or too short or long to be of use.
    pub fn new(request: Request, length: Length) -> Result<Self, DesignError> {
        let Request { interval, order, points, sample_time, .. } = request;
        let shortest = Dataset::new(interval, order, points, Dataset::FEWEST_PERIODS)?;
        let periods = match length {
            Length::Periods(periods) if periods < Dataset::FEWEST_PERIODS => {
                return Err(DesignError::TooFewPeriods { periods, minimum: Dataset::FEWEST_PERIODS });
            }
            Length::Periods(periods) => periods,
            Length::Duration(given) => match shortest.periods_within(given / sample_time) {
                periods if periods >= Dataset::FEWEST_PERIODS => periods,
                _ => {
                    let needed = shortest.total() as f64 * sample_time;
                    return Err(DesignError::TooShort { given, needed, fewest: Dataset::FEWEST_PERIODS });
                }
            },
        };
        let samples = periods as f64 * shortest.pulses()[0].period() as f64;
        if samples > MOST_SAMPLES {
            return Err(DesignError::TooLong { samples, seconds: samples * sample_time, most: MOST_SAMPLES });
        }
        let dataset = shortest.with_periods(periods)?.with_free(drive(&request)?, request.seed);
        check_speed(&request)?;
        check_strokes(&request, &dataset)?;
        Ok(Self { request, dataset })
    }

    /// What was asked for.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// The dataset in samples.
    pub fn dataset(&self) -> &Dataset {
        &self.dataset
    }

    /// Every record to be played, inputs rounded to what a file shows.
    pub fn records(&self) -> Vec<PlannedRecord> {
        let mut records = self.dataset.records();
        records.retain(|record| !self.request.free_only || record.role == Role::Free);
        for record in records.iter_mut().filter(|record| record.role == Role::Free) {
            record.v.iter_mut().for_each(|v| *v = rounded(*v, self.request.interval));
        }
        records
    }

    /// Seconds that some samples take.
    pub(crate) fn seconds(&self, samples: usize) -> f64 {
        samples as f64 * self.request.sample_time
    }
}

fn drive(request: &Request) -> Result<Reversals, DesignError> {
    let mut drive = Reversals::new(request.interval);
    if let Some([smallest, largest]) = request.amplitude {
        check_moves(request.interval, smallest, largest)?;
        drive = drive.with_sizes(smallest, largest)?;
    }
    if let Some(speed) = request.max_speed {
        drive = drive.with_fastest(speed * request.sample_time)?;
    }
    Ok(drive)
}

fn check_moves(interval: Interval, smallest: f64, largest: f64) -> Result<(), DesignError> {
    let width = interval.width();
    for (which, size) in [("smallest", smallest), ("largest", largest)] {
        let reason = if size.is_nan() || size <= 0.0 {
            "is not positive".to_owned()
        } else if size > width {
            format!(
                "does not fit into the interval {}…{}, which is {width} wide",
                interval.low(),
                interval.high()
            )
            .replace('-', "−")
        } else if size < smallest {
            format!("is less than the smallest, {smallest}")
        } else {
            continue;
        };
        return Err(DesignError::Amplitude { which, size, reason, width });
    }
    Ok(())
}

/// A visit takes one sample, from one end of the interval to the other at the most.
fn check_speed(request: &Request) -> Result<(), DesignError> {
    let (width, sample_time) = (request.interval.width(), request.sample_time);
    let needed = width / sample_time;
    match request.max_speed {
        Some(limit) if needed > limit && !request.free_only => {
            let (needed, rate) = (digits(needed, 4), floored(limit / width));
            Err(DesignError::TooFast { width, sample_time, needed, limit, rate })
        }
        _ => Ok(()),
    }
}

/// The free records begin with a stroke up and one down, which must fit into the shortest of them.
fn check_strokes(request: &Request, dataset: &Dataset) -> Result<(), DesignError> {
    let Some(limit) = request.max_speed else { return Ok(()) };
    let stroke = (request.interval.width() / (limit * request.sample_time)).ceil();
    let record = (dataset.samples() as f64 / 3.0).ceil();
    if 2.0 * stroke <= record {
        return Ok(());
    }
    let [stroke_seconds, record] = [stroke, record].map(|samples| digits(samples * request.sample_time, 3));
    let periods = (6.0 * stroke / dataset.pulses()[0].period() as f64).ceil() as usize;
    Err(DesignError::TooSlow { limit, stroke: stroke_seconds, record, periods })
}

/// Four significant digits, never more than the number itself.
fn floored(x: f64) -> String {
    let unit = 10f64.powf(x.log10().floor() - 3.0);
    digits((x / unit).floor() * unit, 4)
}

/// A millionth of the interval is finer than any actuator resolves; beyond it, digits only fill the file.
fn rounded(v: f64, interval: Interval) -> f64 {
    let decimals = (6.0 - interval.width().log10().floor()).max(0.0) as usize;
    let short: f64 = format!("{v:.decimals$}").parse().unwrap_or(v);
    short.clamp(interval.low(), interval.high())
}
