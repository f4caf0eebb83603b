//! Where the Gauss–Newton steps begin.

use super::super::factor::Factor;
use super::super::statistics::LaneStatistics;
use super::LaneFolds;
use super::work::FoldWork;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

impl LaneFolds {
    /// The parameters `(a, b, o)` and the levels by `joint`'s regression on one period of the means.
    #[inline(always)]
    pub(super) fn start<const N: usize, const D: usize>(
        &self,
        parts: &[&LaneStatistics],
        work: &mut FoldWork,
        sound: &mut [bool; LANES],
    ) -> [Lane; D] {
        let (mut normal, mut right) = ([[Lane::ZERO; D]; D], [Lane::ZERO; D]);
        for (part, &[rest, first]) in parts.iter().zip(&self.ends) {
            for &(p, lag) in &self.known {
                keep_apart();
                let mut row = [Lane::splat(1.0); D];
                for i in 0..N {
                    row[i] = Lane::ZERO - part.folds[self.before(p, i + 1)];
                    row[N + i] = Lane::splat(if lag == Some(i + 1) { first } else { rest });
                }
                for i in 0..D {
                    right[i] += row[i] * part.folds[p];
                    for l in 0..D {
                        if l <= i {
                            normal[i][l] += row[i] * row[l];
                        }
                    }
                }
            }
        }
        let (factor, solved) = Factor::new(&normal);
        let mut theta = factor.solve(&right);
        let (mut a_at_one, mut norm) = (Lane::splat(1.0), Lane::ZERO);
        for i in 0..N {
            a_at_one += theta[i];
            norm += theta[N + i] * theta[N + i];
        }
        let constant = theta[2 * N];
        let inverse = Lane::splat(1.0) / norm;
        work.levels.clear();
        for (part, &[rest, first]) in parts.iter().zip(&self.ends) {
            work.levels.push(Lane::splat(first));
            for &phase in &self.phases[1..] {
                let mut inner = Lane::ZERO;
                for lag in 1..=N {
                    keep_apart();
                    // The mean with the level at this lag, less all of it but the level's own pulse.
                    let at = (phase + lag) % self.period;
                    let mut pulse = part.folds[at] - constant;
                    for i in 1..=N {
                        pulse += theta[i - 1] * part.folds[self.before(at, i)] - theta[N + i - 1] * rest;
                    }
                    inner += theta[N + lag - 1] * pulse;
                }
                work.levels.push(inner * inverse + Lane::splat(rest));
            }
        }
        theta[2 * N] = constant / a_at_one;
        for l in 0..LANES {
            sound[l] &= solved[l];
        }
        theta
    }
}
