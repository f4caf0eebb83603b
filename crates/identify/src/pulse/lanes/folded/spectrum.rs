//! The folds' spectra, and the weights of their lines.

use super::super::statistics::LaneStatistics;
use super::LaneFolds;
use super::work::FoldWork;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

impl LaneFolds {
    /// The weights of the lines by Levinson's recursion; the variance of the autoregression's source.
    #[inline(always)]
    pub(super) fn weigh(
        &self,
        parts: &[&LaneStatistics],
        work: &mut FoldWork,
        sound: &mut [bool; LANES],
    ) -> Lane {
        let FoldWork { colour, mirrored, weights, .. } = work;
        let period = self.period as f64;
        let freedom: f64 = parts.iter().map(|part| part.samples - period).sum();
        let lags = parts[0].left.len();
        for l in 0..LANES {
            sound[l] &= parts[0].samples >= 2.0 * period && lags > 0;
        }
        let gamma = |k: usize| {
            let mut sum = Lane::ZERO;
            for part in parts {
                sum += part.left[k];
            }
            sum * (1.0 / freedom)
        };
        colour.clear();
        let mut variance = if lags > 0 { gamma(0) } else { Lane::ZERO };
        for k in 1..lags {
            let mut ahead = gamma(k);
            for (i, d) in colour.iter().enumerate() {
                keep_apart();
                ahead += *d * gamma(k - 1 - i);
            }
            let reflection = Lane::ZERO - ahead / variance;
            for l in 0..LANES {
                sound[l] &= reflection.0[l].abs() < 1.0;
            }
            mirrored.clear();
            mirrored.extend(colour.iter().rev());
            for (d, m) in colour.iter_mut().zip(&*mirrored) {
                keep_apart();
                *d += reflection * *m;
            }
            colour.push(reflection);
            variance = variance * (Lane::splat(1.0) - reflection * reflection);
        }
        // |D|² = r₀ + 2 Σ r_j cos jω, r the autoproducts of (1, d₁, …).
        let coefficient = |i: usize| if i == 0 { Lane::splat(1.0) } else { colour[i - 1] };
        let length = colour.len() + 1;
        mirrored.clear();
        for j in 0..length {
            let mut sum = Lane::ZERO;
            for i in 0..length - j {
                keep_apart();
                sum += coefficient(i) * coefficient(i + j);
            }
            mirrored.push(if j == 0 { sum } else { sum + sum });
        }
        let scale = parts[0].samples / (period * period);
        weights.clear();
        for k in 0..self.lines() {
            let turns = &self.turns[k * self.period..(k + 1) * self.period];
            let mut power = Lane::ZERO;
            for (j, r) in mirrored.iter().enumerate() {
                keep_apart();
                power += *r * turns[j % self.period][0];
            }
            let alone = k == 0 || 2 * k == self.period;
            weights.push(power * if alone { scale } else { 2.0 * scale });
        }
        variance
    }

    /// The lines of the means.
    #[inline(always)]
    pub(super) fn transform(&self, parts: &[&LaneStatistics], work: &mut FoldWork) {
        work.outputs.clear();
        for part in parts {
            for turns in self.turns.chunks_exact(self.period) {
                let mut line = [Lane::ZERO; 2];
                for (mean, &[cos, sin]) in part.folds.iter().zip(turns) {
                    keep_apart();
                    line[0] += *mean * cos;
                    line[1] -= *mean * sin;
                }
                work.outputs.push(line);
            }
        }
    }
}
