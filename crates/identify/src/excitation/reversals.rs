//! A free drive whose reversals come in many sizes.

use super::ExcitationError;
use super::free::{LONGEST_MOVE, REST};
use rand::{Rng, RngExt};
use switchback_model::hysteresis::Interval;

/// Share of the moves that go to a level drawn from the whole interval.
const TRAVEL: f64 = 0.25;
/// The smallest move, as a share of the interval, where none is given.
const SMALLEST_SHARE: f64 = 0.02;

/// A drive that turns back again and again, by distances spread evenly over their logarithm.
///
/// ```text
/// first      the whole interval up, and down again
/// turn       three moves in four turn back by a size that is log-uniform on [smallest, largest]; at the end of the
///            interval they stop short, and where less than `smallest` is left they go on in the other direction
/// travel     one move in four goes to a level that is uniform on the interval, so that turns happen everywhere
/// speed      a move takes 1 … 20 samples, uniform, and never less than the speed limit allows
/// rest       after one move in four: 1 … 5 further samples at its end, uniform
/// ```
///
/// [`RandomLevels`](super::RandomLevels) draws levels; most of its moves are large. Effects that live right after a reversal (play, a
/// gradual transition) need small ones too, which are drawn here. Inputs are input units, speeds input units a sample.
///
/// ```
/// use rand::SeedableRng;
/// use switchback_identify::excitation::Reversals;
/// use switchback_model::hysteresis::Interval;
/// let drive = Reversals::new(Interval::new(-2.0, 5.0)?);
/// let v = drive.record_input(500, &mut rand_chacha::ChaCha8Rng::seed_from_u64(1));
/// assert_eq!((v.len(), v[0]), (501, -2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reversals {
    interval: Interval,
    smallest: f64,
    largest: f64,
    fastest: f64,
}

impl Reversals {
    /// Sizes from 2 % of the interval to all of it, at any speed.
    pub fn new(interval: Interval) -> Self {
        let width = interval.width();
        Self { interval, smallest: SMALLEST_SHARE * width, largest: width, fastest: f64::INFINITY }
    }

    /// The same drive with other sizes.
    ///
    /// # Errors
    /// [`ExcitationError::DriveSetting`] unless `0 < smallest ≤ largest ≤` the interval's width.
    pub fn with_sizes(self, smallest: f64, largest: f64) -> Result<Self, ExcitationError> {
        if !(smallest > 0.0 && smallest <= self.interval.width()) {
            let remedy = "the smallest move is positive and fits into the interval";
            return Err(ExcitationError::DriveSetting { setting: "smallest", value: smallest, remedy });
        }
        if !(largest >= smallest && largest <= self.interval.width()) {
            let remedy = "the largest move is no smaller than the smallest and fits into the interval";
            return Err(ExcitationError::DriveSetting { setting: "largest", value: largest, remedy });
        }
        Ok(Self { smallest, largest, ..self })
    }

    /// The same drive, moving no faster than `fastest` input units a sample.
    ///
    /// # Errors
    /// [`ExcitationError::DriveSetting`] unless positive.
    pub fn with_fastest(self, fastest: f64) -> Result<Self, ExcitationError> {
        if fastest.is_nan() || fastest <= 0.0 {
            let remedy = "a speed limit is positive";
            return Err(ExcitationError::DriveSetting { setting: "fastest", value: fastest, remedy });
        }
        Ok(Self { fastest, ..self })
    }

    /// The input of a whole record: one sample at `h_m`, then `samples` samples of the drive.
    ///
    /// The same generator state gives the same input, and a longer record begins with the shorter one.
    pub fn record_input<R: Rng + ?Sized>(&self, samples: usize, rng: &mut R) -> Vec<f64> {
        let length = samples + 1;
        let mut v = vec![self.interval.low()];
        let mut rising = true;
        for end in [self.interval.high(), self.interval.low()] {
            self.go(end, length, &mut v, rng);
            rising = !rising;
        }
        while v.len() < length {
            let from = v[v.len() - 1];
            let to = if rng.random_bool(TRAVEL) {
                rng.random_range(self.interval.low()..=self.interval.high())
            } else {
                self.turn(from, rising, rng)
            };
            if to != from {
                self.go(to, length, &mut v, rng);
                rising = to < from;
            }
        }
        v.truncate(length);
        v
    }

    /// Where a turn ends that sets out from `from`, upwards if `rising`.
    fn turn<R: Rng + ?Sized>(&self, from: f64, rising: bool, rng: &mut R) -> f64 {
        let share: f64 = rng.random();
        let size = self.smallest * (self.largest / self.smallest).powf(share);
        let (low, high) = (self.interval.low(), self.interval.high());
        let up = if rising { high - from >= self.smallest } else { from - low < self.smallest };
        if up { (from + size).min(high) } else { (from - size).max(low) }
    }

    /// Moves to `to` in a straight line, and rests there now and then. A move that outlasts the record is not written out beyond it.
    fn go<R: Rng + ?Sized>(&self, to: f64, length: usize, v: &mut Vec<f64>, rng: &mut R) {
        let from = v[v.len() - 1];
        // A limit so low that no move ends saturates.
        let least = ((to - from).abs() / self.fastest).ceil().max(1.0) as u32;
        let steps = rng.random_range(1..=LONGEST_MOVE).max(least);
        let room = length.saturating_sub(v.len());
        let on_the_path = |k: u32| from + (to - from) * (f64::from(k) / f64::from(steps));
        v.extend((1..steps).take(room).map(on_the_path));
        v.push(to);
        if rng.random_bool(REST.0) {
            let rest = rng.random_range(1..=REST.1);
            v.extend(std::iter::repeat_n(to, rest as usize));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn interval() -> Interval {
        Interval::new(-2.0, 5.0).unwrap()
    }

    fn input(drive: Reversals, samples: usize, seed: u64) -> Vec<f64> {
        drive.record_input(samples, &mut ChaCha8Rng::seed_from_u64(seed))
    }

    /// Distances between neighbouring turning points.
    fn strokes(v: &[f64]) -> Vec<f64> {
        let mut turns = vec![v[0]];
        let mut last = 0.0;
        for w in v.windows(2) {
            let step = w[1] - w[0];
            if step != 0.0 {
                if step * last < 0.0 {
                    turns.push(w[0]);
                }
                last = step;
            }
        }
        turns.windows(2).map(|w| (w[1] - w[0]).abs()).collect()
    }

    #[test]
    fn the_input_stays_in_the_interval_and_turns_everywhere() {
        let v = input(Reversals::new(interval()), 20_000, 3);
        assert!(v.iter().all(|&now| interval().contains(now)));
        for cell in 0..20 {
            let from = -2.0 + 7.0 * f64::from(cell) / 20.0;
            let here = v
                .windows(3)
                .filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0 && (from..from + 0.35).contains(&w[1]));
            assert!(here.count() >= 10, "hardly a turn near {from}");
        }
    }

    #[test]
    fn every_size_occurs_about_as_often_on_a_logarithmic_scale() {
        let sizes = strokes(&input(Reversals::new(interval()), 40_000, 4));
        // From 2 % to 100 %: five bins of a factor 2.19 each; travels and the ends of the interval favour the large ones.
        let edge = |k: i32| 7.0 * 0.02 * 50f64.powf(f64::from(k) / 5.0);
        for k in 0..5 {
            let share = sizes.iter().filter(|s| (edge(k)..edge(k + 1)).contains(*s)).count() as f64
                / sizes.len() as f64;
            assert!((0.08..0.4).contains(&share), "bin {k}: {share}");
        }
    }

    #[test]
    fn a_speed_limit_is_kept() {
        let v = input(Reversals::new(interval()).with_fastest(0.05).unwrap(), 5000, 5);
        assert!(v.windows(2).all(|w| (w[1] - w[0]).abs() <= 0.05 + 1e-12));
        assert!(input(Reversals::new(interval()).with_fastest(1e-300).unwrap(), 50, 5).len() == 51);
    }

    #[test]
    fn both_borders_are_run_from_end_to_end_first() {
        for seed in 0..20 {
            let v = input(Reversals::new(interval()), 100, seed);
            let top = v.iter().position(|x| *x == 5.0).unwrap();
            assert!(v[..=top].windows(2).all(|w| w[1] > w[0]), "straight up");
            assert!(v[top..].contains(&-2.0), "and down");
        }
    }

    #[test]
    fn a_longer_record_begins_with_the_shorter_one() {
        let drive = Reversals::new(interval());
        assert_eq!(input(drive, 700, 6)[..=300], input(drive, 300, 6)[..]);
    }

    #[test]
    fn sizes_that_cannot_be_are_refused_by_name() {
        let message = |s, l| Reversals::new(interval()).with_sizes(s, l).unwrap_err().to_string();
        assert!(message(0.0, 1.0).starts_with("smallest = 0"));
        assert!(message(1.0, 0.5).starts_with("largest = 0.5"));
        assert!(message(1.0, 7.5).starts_with("largest = 7.5"));
        assert!(message(f64::NAN, 1.0).starts_with("smallest = NaN"));
    }
}
