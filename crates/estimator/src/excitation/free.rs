//! Random drives, for methods that need no designed experiment.

use super::ExcitationError;
use crate::hysteresis::Interval;
use rand::{Rng, RngExt};

/// A drive that moves in straight lines between random levels, with occasional rests.
///
/// ```text
/// level      uniform on [h_m, h_M]
/// move       to the level, at constant speed, in 1 … longest_move samples, uniform
/// rest       after a move, with probability rest_probability: 1 … longest_rest further samples at the level, uniform
/// ```
///
/// Reversals of every amplitude occur, at many speeds, and `v` stands exactly still during rests, so that all three
/// cases of (2.3) appear. The input starts at `h_m`, from which its first move loads the ascending border.
///
/// ```
/// use rand::SeedableRng;
/// use switchback_estimator::{excitation::RandomLevels, hysteresis::Interval};
/// let drive = RandomLevels::new(Interval::new(-2.0, 5.0)?);
/// let v = drive.record_input(500, &mut rand_chacha::ChaCha8Rng::seed_from_u64(1));
/// assert_eq!((v.len(), v[0]), (501, -2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomLevels {
    interval: Interval,
    longest_move: u32,
    longest_rest: u32,
    rest_probability: f64,
}

impl RandomLevels {
    /// Moves of up to 20 samples; after one move in four, a rest of up to 5 samples.
    ///
    /// These lengths keep some ten reversals in a hundred samples and still show the settling of a linear part
    /// whose slowest pole takes a few tens of samples.
    pub fn new(interval: Interval) -> Self {
        Self { interval, longest_move: 20, longest_rest: 5, rest_probability: 0.25 }
    }

    /// The same drive with moves of up to `samples` samples.
    ///
    /// # Errors
    /// [`ExcitationError::DriveSetting`] if zero.
    pub fn with_longest_move(self, samples: u32) -> Result<Self, ExcitationError> {
        if samples == 0 {
            let remedy = "a move takes at least one sample; give 1 or more";
            return Err(ExcitationError::DriveSetting { setting: "longest_move", value: 0.0, remedy });
        }
        Ok(Self { longest_move: samples, ..self })
    }

    /// The same drive, resting after a move with the given probability for up to `longest` samples.
    ///
    /// # Errors
    /// [`ExcitationError::DriveSetting`] if the probability is not in `[0, 1]`, or positive with `longest` zero.
    pub fn with_rests(self, probability: f64, longest: u32) -> Result<Self, ExcitationError> {
        if !(0.0..=1.0).contains(&probability) {
            let remedy = "a probability lies between 0 and 1";
            return Err(ExcitationError::DriveSetting {
                setting: "rest_probability",
                value: probability,
                remedy,
            });
        }
        if probability > 0.0 && longest == 0 {
            let remedy = "a rest takes at least one sample; give 1 or more, or rest_probability = 0";
            return Err(ExcitationError::DriveSetting { setting: "longest_rest", value: 0.0, remedy });
        }
        Ok(Self { rest_probability: probability, longest_rest: longest, ..self })
    }

    /// The working interval.
    pub fn interval(&self) -> Interval {
        self.interval
    }

    /// The input of a whole record: the loading sample at `h_m`, then `samples` samples of the drive.
    ///
    /// The same generator state gives the same input, and a longer record begins with the shorter one.
    pub fn record_input<R: Rng + ?Sized>(&self, samples: usize, rng: &mut R) -> Vec<f64> {
        let length = samples + 1;
        let mut v = Vec::with_capacity(length);
        v.push(self.interval.low());
        while v.len() < length {
            self.move_and_rest(&mut v, rng);
        }
        v.truncate(length);
        v
    }

    fn move_and_rest<R: Rng + ?Sized>(&self, v: &mut Vec<f64>, rng: &mut R) {
        let from = v[v.len() - 1];
        let to = rng.random_range(self.interval.low()..=self.interval.high());
        let steps = rng.random_range(1..=self.longest_move);
        v.extend((1..steps).map(|k| from + (to - from) * (f64::from(k) / f64::from(steps))));
        // The end is written as it is, so that rounding can neither leave the interval nor shift the level.
        v.push(to);
        if rng.random_bool(self.rest_probability) {
            let rest = rng.random_range(1..=self.longest_rest);
            v.extend(std::iter::repeat_n(to, rest as usize));
        }
    }
}
