//! What is asked of a design.

use super::DesignError;
use super::forecast::PlanMethod;
use super::plan::{DEFAULT_PERIODS, Length};
use std::ops::RangeInclusive;
use std::path::PathBuf;
use switchback_io::values::is_positive;
use switchback_model::hysteresis::Interval;

/// The experiments that are asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Order of the linear part; else that of the rig.
    pub order: Option<u8>,
    /// Levels to visit on each border; else those of the rig, or 8.
    pub points: Option<u16>,
    /// Working interval of the input, input units.
    pub interval: Option<Interval>,
    /// Samples a second.
    pub rate: Option<f64>,
    /// The rig file to plan for, in place of interval and rate: its designed experiments, or else its free records.
    pub from: Option<PathBuf>,
    /// Largest standard error of a border point, as a share of `u_M − u_m`: it decides how long to measure.
    pub precision: Option<f64>,
    /// Method to predict for.
    pub method: PlanMethod,
    /// Periods of each pulse experiment, [`DEFAULT_PERIODS`] where no length is given.
    pub periods: Option<u32>,
    /// Seconds of all records together, instead of the periods.
    pub duration: Option<f64>,
    /// Smallest and largest move of the free records, input units.
    pub amplitude: Option<[f64; 2]>,
    /// What the actuator can do, input units a second.
    pub max_speed: Option<f64>,
    /// Whether to leave the designed experiments out.
    pub free_only: bool,
    /// Seed of the free records.
    pub seed: u64,
    /// Label and unit of the input; else that of the rig.
    pub input: Option<String>,
    /// Label and unit of the output; else that of the rig.
    pub output: Option<String>,
    /// Name of the rig to be measured; else that of the folder.
    pub name: Option<String>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            order: None,
            points: None,
            interval: None,
            rate: None,
            from: None,
            precision: None,
            method: PlanMethod::Efficient,
            periods: None,
            duration: None,
            amplitude: None,
            max_speed: None,
            free_only: false,
            seed: 1,
            input: None,
            output: None,
            name: None,
        }
    }
}

impl Options {
    /// The orders that an experiment is designed for.
    pub const ORDERS: RangeInclusive<u64> = 1..=20;

    /// The numbers of levels that fit on a border.
    pub const LEVELS: RangeInclusive<u64> = 1..=65_535;

    /// Refuses what is no number of its kind, and what does not go together.
    pub(super) fn check(&self) -> Result<(), DesignError> {
        self.check_numbers()?;
        if self.precision.is_some() && self.from.is_none() {
            return Err(DesignError::PrecisionOfWhat);
        }
        self.check_together()
    }

    fn check_numbers(&self) -> Result<(), DesignError> {
        let positive = [
            ("--rate", self.rate),
            ("--precision", self.precision),
            ("--duration", self.duration),
            ("--max-speed", self.max_speed),
        ];
        let wrong = positive.into_iter().find(|(_, value)| value.is_some_and(|value| !is_positive(value)));
        match wrong {
            Some((option, _)) => Err(DesignError::NotPositive { option }),
            None => Ok(()),
        }
    }

    fn check_together(&self) -> Result<(), DesignError> {
        let (from, precision) = (self.from.is_some(), self.precision.is_some());
        let (periods, duration) = (self.periods.is_some(), self.duration.is_some());
        let exclusive = [
            (self.interval.is_some() && from, "--interval <LO,HI>", "--from <RIG.toml>"),
            (self.rate.is_some() && from, "--rate <HZ>", "--from <RIG.toml>"),
            (precision && periods, "--precision <P>", "--periods <K>"),
            (precision && duration, "--precision <P>", "--duration <S>"),
            (precision && self.free_only, "--precision <P>", "--free-only"),
            (periods && duration, "--periods <K>", "--duration <S>"),
        ];
        match exclusive.into_iter().find(|(are_both, ..)| *are_both) {
            Some((_, option, other)) => Err(DesignError::Exclusive { option, other }),
            None => Ok(()),
        }
    }

    /// The length, where no precision decides it.
    pub(super) fn length(&self) -> Length {
        match (self.duration, self.periods) {
            (Some(seconds), _) => Length::Duration(seconds),
            (None, Some(periods)) => Length::Periods(periods as usize),
            (None, None) => Length::Periods(DEFAULT_PERIODS),
        }
    }
}
