//! Random drives, for methods that need no designed experiment.

use super::ExcitationError;
use rand::{Rng, RngExt};
use switchback_model::hysteresis::Interval;

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
/// use switchback_identify::excitation::RandomLevels;
/// use switchback_model::hysteresis::Interval;
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
    /// A move and its rest take eleven samples on average and two moves in three turn back, so there are about six
    /// reversals in a hundred samples: enough to see both borders everywhere, with room for the output to follow.
    pub fn new(interval: Interval) -> Self {
        Self { interval, longest_move: 20, longest_rest: 5, rest_probability: 0.25 }
    }

    /// The same drive with moves of up to `samples` samples.
    ///
    /// # Errors
    /// [`ExcitationError::DriveSetting`] if zero.
    pub(crate) fn with_longest_move(self, samples: u32) -> Result<Self, ExcitationError> {
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
    pub(crate) fn with_rests(self, probability: f64, longest: u32) -> Result<Self, ExcitationError> {
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
    pub(crate) fn interval(&self) -> Interval {
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn drive() -> RandomLevels {
        RandomLevels::new(Interval::new(-2.0, 5.0).unwrap())
    }

    fn input(drive: RandomLevels, samples: usize, seed: u64) -> Vec<f64> {
        drive.record_input(samples, &mut ChaCha8Rng::seed_from_u64(seed))
    }

    #[test]
    fn the_input_stays_in_the_interval_and_covers_it() {
        let v = input(drive(), 5000, 3);
        assert!(v.iter().all(|&now| drive().interval().contains(now)));
        for cell in 0..20 {
            let from = -2.0 + 7.0 * f64::from(cell) / 20.0;
            assert!(v.iter().any(|now| (from..from + 0.35).contains(now)), "nothing near {from}");
        }
    }

    #[test]
    fn rises_falls_and_rests_all_occur() {
        let v = input(drive(), 5000, 4);
        let share =
            |case: fn(f64) -> bool| v.windows(2).filter(|w| case(w[1] - w[0])).count() as f64 / 5000.0;
        assert!(share(|step| step > 0.0) > 0.3);
        assert!(share(|step| step < 0.0) > 0.3);
        // A rest follows one move in four and lasts three samples on average, after moves of 10.5.
        assert!((share(|step| step == 0.0) - 0.75 / 11.25).abs() < 0.03);
    }

    #[test]
    fn about_six_samples_in_a_hundred_are_reversals() {
        let v = input(drive(), 20_000, 5);
        let steps: Vec<f64> = v.windows(2).map(|w| w[1] - w[0]).filter(|&step| step != 0.0).collect();
        let reversals = steps.windows(2).filter(|w| w[0].signum() != w[1].signum()).count();
        assert!((reversals as f64 / 20_000.0 - 2.0 / 3.0 / 11.25).abs() < 0.005);
    }

    #[test]
    fn the_first_move_loads_the_ascending_border() {
        for seed in 0..50 {
            let v = input(drive(), 30, seed);
            assert!(v[0] == -2.0 && v[1] > v[0]);
        }
    }

    #[test]
    fn a_longer_record_begins_with_the_shorter_one() {
        assert_eq!(input(drive(), 700, 6)[..=300], input(drive(), 300, 6)[..]);
        assert_eq!(input(drive(), 0, 6), [-2.0]);
    }

    #[test]
    fn without_rests_the_input_never_stands_still() {
        let restless = drive().with_rests(0.0, 0).unwrap();
        assert!(input(restless, 5000, 7).windows(2).all(|w| w[0] != w[1]));
    }

    #[test]
    fn moves_of_one_sample_jump_from_level_to_level() {
        let jumps = drive().with_longest_move(1).unwrap().with_rests(1.0, 1).unwrap();
        let v = input(jumps, 400, 8);
        assert!(
            v[1..].chunks_exact(2).all(|pair| pair[0] == pair[1]),
            "each level is held for one more sample"
        );
    }

    #[test]
    fn settings_out_of_range_are_refused_by_name() {
        let message = |result: Result<RandomLevels, ExcitationError>| result.unwrap_err().to_string();
        assert!(message(drive().with_longest_move(0)).starts_with("longest_move = 0"));
        assert!(message(drive().with_rests(1.5, 3)).starts_with("rest_probability = 1.5"));
        assert!(message(drive().with_rests(f64::NAN, 3)).starts_with("rest_probability = NaN"));
        assert!(message(drive().with_rests(0.5, 0)).starts_with("longest_rest = 0"));
    }

    #[test]
    fn a_seed_keeps_its_values() {
        let lively = drive().with_longest_move(2).unwrap().with_rests(0.5, 2).unwrap();
        assert_eq!(
            input(lively, 6, 2009),
            [
                -2.0,
                -1.5589968616005792,
                0.3827372415238648,
                2.324471344648309,
                4.516595733560304,
                4.516595733560304,
                -1.766922820384029,
            ]
        );
    }
}
