//! A whole dataset: every record that an identification and its check ask for.

use super::{Direction, ExcitationError, PulseExperiment, Reversals, StepExperiment};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Role, Usage, samples_needed};

/// The inputs of a measuring dataset, one record after the other.
///
/// ```text
/// descendant, ascendant   K periods of T = s(m + 3) samples each, N = K·T
/// step_high, step_low     N/6 samples each
/// free                    2N/3 samples, reversals of many sizes
/// holdout                 N/3 samples, the same drive drawn anew, held out
/// ```
///
/// so that each pulse experiment takes three tenths of the whole, 10N/3. Every record begins with one more sample, from which the first
/// move loads a known border. The first period settles the output; the pulse methods regress on measured lags and may use it.
#[derive(Debug, Clone, PartialEq)]
pub struct Dataset {
    pulses: [PulseExperiment; 2],
    periods: usize,
    free: Reversals,
    seed: u64,
}

/// One record to be played.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRecord {
    /// What it is called; also the name of its file, without an ending.
    pub name: &'static str,
    /// What drives the input.
    pub role: Role,
    /// Fit or hold-out.
    pub usage: Usage,
    /// The input, one value a sample.
    pub v: Vec<f64>,
}

/// Of the whole dataset's samples, those of one pulse experiment.
const PULSE_SHARE: f64 = 0.3;

impl Dataset {
    /// Fewest periods: one settles, and each level must come back once more to be distinguished from a free input.
    pub const FEWEST_PERIODS: usize = 3;

    /// Plans for a linear part of order `order` and `points` evenly spaced levels on each border.
    ///
    /// # Errors
    /// [`ExcitationError`] if `order`, `points` or `periods` is too small, or the levels are too many for the interval.
    pub fn new(
        interval: Interval,
        order: usize,
        points: usize,
        periods: usize,
    ) -> Result<Self, ExcitationError> {
        let experiment = |direction| PulseExperiment::evenly_spaced(interval, direction, points, order);
        let pulses = [experiment(Direction::Descendant)?, experiment(Direction::Ascendant)?];
        let plan = Self { pulses, periods: Self::FEWEST_PERIODS, free: Reversals::new(interval), seed: 1 };
        plan.with_periods(periods)
    }

    /// The same dataset with another length.
    ///
    /// # Errors
    /// [`ExcitationError::TooFewPeriods`] below [`Dataset::FEWEST_PERIODS`].
    pub fn with_periods(self, periods: usize) -> Result<Self, ExcitationError> {
        if periods < Self::FEWEST_PERIODS {
            return Err(ExcitationError::TooFewPeriods { periods, minimum: Self::FEWEST_PERIODS });
        }
        Ok(Self { periods, ..self })
    }

    /// The same dataset with another drive of the free records, drawn from `seed`.
    pub fn with_free(self, free: Reversals, seed: u64) -> Self {
        Self { free, seed, ..self }
    }

    /// Periods of each pulse experiment.
    pub fn periods(&self) -> usize {
        self.periods
    }

    /// The descendant and the ascendant experiment.
    pub fn pulses(&self) -> &[PulseExperiment; 2] {
        &self.pulses
    }

    /// `N`: samples of each pulse experiment, the loading one apart.
    pub fn samples(&self) -> usize {
        self.periods * self.pulses[0].period()
    }

    /// Samples of the whole dataset.
    pub fn total(&self) -> usize {
        let [step, free, holdout] = self.lengths();
        2 * (self.samples() + 1) + 2 * (step + 1) + free + holdout + 2
    }

    /// Periods of a dataset that takes at most `total` samples, as near as whole periods come.
    pub fn periods_within(&self, total: f64) -> usize {
        (PULSE_SHARE * total / self.pulses[0].period() as f64).floor().max(0.0) as usize
    }

    /// Samples of a step, of the free and of the held-out record, the first one apart: none is too short to be read again.
    fn lengths(&self) -> [usize; 3] {
        let (n, fewest) = (self.samples(), samples_needed(Some(self.pulses[0].order())));
        [n.div_ceil(6), (2 * n).div_ceil(3), n.div_ceil(3)].map(|samples| samples.max(fewest))
    }

    /// Every record, in the order in which to play them.
    pub fn records(&self) -> Vec<PlannedRecord> {
        let interval = self.pulses[0].interval();
        let [step, free, holdout] = self.lengths();
        let drive = |stream: u64, samples| {
            let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
            rng.set_stream(stream);
            self.free.record_input(samples, &mut rng)
        };
        let pulse = |k: usize| self.pulses[k].record_input(self.samples());
        let fit = |name, role, v| PlannedRecord { name, role, usage: Usage::Fit, v };
        vec![
            fit("step_high", Role::StepHigh, StepExperiment::high(interval).record_input(step)),
            fit("step_low", Role::StepLow, StepExperiment::low(interval).record_input(step)),
            fit("descendant", Role::Descendant, pulse(0)),
            fit("ascendant", Role::Ascendant, pulse(1)),
            fit("free", Role::Free, drive(0, free)),
            PlannedRecord { name: "holdout", role: Role::Free, usage: Usage::Holdout, v: drive(1, holdout) },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_is_what_its_records_add_up_to() {
        for (order, points, periods) in [(1, 1, 3), (2, 8, 100), (5, 7, 11)] {
            let plan = Dataset::new(Interval::new(-1.0, 2.0).unwrap(), order, points, periods).unwrap();
            assert_eq!(plan.total(), plan.records().iter().map(|r| r.v.len()).sum::<usize>());
        }
    }

    #[test]
    fn a_duration_is_filled_and_not_exceeded_by_more_than_the_first_samples() {
        let plan = Dataset::new(Interval::new(0.0, 1.0).unwrap(), 2, 8, 3).unwrap();
        for total in [1000.0, 6000.0, 123_456.0] {
            let periods = plan.periods_within(total);
            let longer = plan.clone().with_periods(periods + 1).unwrap();
            let filled = plan.clone().with_periods(periods).unwrap();
            assert!(filled.total() as f64 <= total + 10.0 && longer.total() as f64 > total);
        }
    }

    #[test]
    fn no_record_is_shorter_than_is_read() {
        for (order, points) in (1..=20).flat_map(|order| [1, 2, 8].map(|points| (order, points))) {
            let plan = Dataset::new(Interval::new(-1.0, 2.0).unwrap(), order, points, 3).unwrap();
            for record in plan.records() {
                assert!(record.v.len() > samples_needed(Some(order)), "{}: {}", record.name, record.v.len());
            }
            assert_eq!(plan.total(), plan.records().iter().map(|r| r.v.len()).sum::<usize>());
        }
    }

    #[test]
    fn too_few_periods_are_refused_with_the_reason() {
        let error = Dataset::new(Interval::new(0.0, 1.0).unwrap(), 2, 8, 2).unwrap_err();
        assert!(error.to_string().starts_with("periods = 2"), "{error}");
    }
}
