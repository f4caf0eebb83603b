//! Random drives, for methods that need no designed experiment.

use rand::{Rng, RngExt};
use switchback_model::hysteresis::Interval;

/// Longest move, in samples.
pub(super) const LONGEST_MOVE: u32 = 20;
/// A rest follows a move with this probability and lasts up to this many samples.
pub(super) const REST: (f64, u32) = (0.25, 5);

/// A drive that moves in straight lines between random levels, with occasional rests.
///
/// ```text
/// level      uniform on [h_m, h_M]
/// move       to the level, at constant speed, in 1 … 20 samples, uniform
/// rest       after one move in four: 1 … 5 further samples at the level, uniform
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
}

impl RandomLevels {
    /// A drive over an interval.
    ///
    /// A move and its rest take eleven samples on average and two moves in three turn back, so there are about six
    /// reversals in a hundred samples: enough to see both borders everywhere, with room for the output to follow.
    pub fn new(interval: Interval) -> Self {
        Self { interval }
    }

    /// The working interval.
    #[cfg(test)]
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
        let steps = rng.random_range(1..=LONGEST_MOVE);
        v.extend((1..steps).map(|k| from + (to - from) * (f64::from(k) / f64::from(steps))));
        // The end is written as it is, so that rounding can neither leave the interval nor shift the level.
        v.push(to);
        let (probability, longest) = REST;
        if rng.random_bool(probability) {
            let rest = rng.random_range(1..=longest);
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
    fn a_seed_keeps_its_values() {
        assert_eq!(
            input(drive(), 6, 2009),
            [
                -2.0,
                -1.9448746077000725,
                -1.8897492154001447,
                -1.8346238231002172,
                -1.7794984308002895,
                -1.724373038500362,
                -1.6692476462004344,
            ]
        );
    }
}
