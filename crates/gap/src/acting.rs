//! Noise on the input that acts: what it adds to the equation error, and how that is coloured.
//!
//! ```text
//! e(t) = ξ(t) + Σⱼ b̃ⱼ·g(t−j)·n(t−j),   g = √r·du/dv;   n new at every move, and while v rests zero, or kept
//! cov(t, k) = Σⱼ Σₗ b̃ⱼ b̃ₗ·C(t−j, t−k−l),   C(s, s′) = g(s)·g(s′) within one rest, else 0
//! ```
//!
//! in units of the variance of `ξ`. What switches the operator while `v` rests is white and adds to `C(s, s)`.

use crate::assembly::InputNoise;
use crate::design::DesignTrack;
use crate::linear::Linear;
use crate::spectrum::{autocorrelation, levinson};

/// Lags over which the colour is foretold, and the longest response for which it is.
const LAGS: usize = 6;
const LONGEST: usize = 12;
/// The colour is a mean: one block in so many tells it, a block longer than a period of designed experiments.
const EVERY: usize = 5;
const BLOCK: usize = 256;

/// The noise of one track in units of `u`.
struct Acting {
    /// Standard deviation of what depends on the slope.
    gain: Vec<f64>,
    /// Number of the rest (or move) that a sample belongs to.
    rest: Vec<u32>,
    /// Variance of what is white.
    flips: Vec<f64>,
}

impl Acting {
    fn new(track: &DesignTrack, law: InputNoise, p: &Linear) -> Option<Self> {
        let [slope, gap] = track.sensitivity.as_deref()?;
        let samples = track.x.len();
        let mut out = Self {
            gain: Vec::with_capacity(samples),
            rest: Vec::with_capacity(samples),
            flips: (0..samples).map(|t| law.by_gap * gap.dot(t, &p.f).powi(2)).collect(),
        };
        let root = law.by_slope.sqrt();
        let (mut gain, mut rest) = (0.0, 0);
        for (t, m) in track.moves.iter().enumerate() {
            if m.step != 0.0 || !law.kept {
                gain = root * slope.dot(t, &p.f);
                rest += 1;
            }
            out.gain.push(gain);
            out.rest.push(rest);
        }
        Some(out)
    }

    /// What reaches the equation at `t` through the response `h`, by rest, latest first: `Σⱼ hⱼ·g(t−j)` over the samples of each.
    fn reaching(&self, h: &[f64], t: usize) -> Reaching {
        let mut out = Reaching { parts: [(0, 0.0); LONGEST], count: 0 };
        for (b, s) in h.iter().zip((0..t).rev()) {
            let part = b * self.gain[s];
            match out.count.checked_sub(1).map(|last| &mut out.parts[last]) {
                Some((rest, sum)) if *rest == self.rest[s] => *sum += part,
                _ => {
                    out.parts[out.count] = (self.rest[s], part);
                    out.count += 1;
                }
            }
        }
        out
    }

    /// Covariance of what the noise adds at `t` and `lag` samples before, through the response `h`, given what reaches both.
    fn covariance(&self, h: &[f64], (t, lag): (usize, usize), [now, earlier]: [&Reaching; 2]) -> f64 {
        let flips = h.iter().zip(h.iter().skip(lag)).zip((0..t.saturating_sub(lag)).rev());
        let flips: f64 = flips.map(|((b, c), s)| b * c * self.flips[s]).sum();
        flips + now.product(earlier)
    }

    /// Variance of what the noise adds at `t`.
    fn power(&self, h: &[f64], t: usize) -> f64 {
        let now = self.reaching(h, t);
        self.covariance(h, (t, 0), [&now, &now])
    }

    /// Covariances of what the noise adds at lags 1, 2, … up to as many as `sums`, each error times its `scale`, summed over
    /// some of the samples from `from` on.
    fn add_colour(&self, h: &[f64], scale: &[f64], from: usize, sums: &mut [f64]) {
        let scale = |t: usize| scale[t - from];
        let end = self.gain.len();
        let mut of_track = vec![0.0; sums.len()];
        for block in (from / BLOCK..end.div_ceil(BLOCK)).filter(|block| block.is_multiple_of(EVERY)) {
            let samples = (block * BLOCK).max(from)..((block + 1) * BLOCK).min(end);
            let first = samples.start.saturating_sub(sums.len());
            let reaching: Vec<Reaching> = (first..samples.end).map(|t| self.reaching(h, t)).collect();
            for (sum, lag) in of_track.iter_mut().zip(1..) {
                for t in samples.clone().skip((from + lag).saturating_sub(samples.start)) {
                    let both = [&reaching[t - first], &reaching[t - lag - first]];
                    *sum += self.covariance(h, (t, lag), both) * scale(t) * scale(t - lag);
                }
            }
        }
        sums.iter_mut().zip(of_track).for_each(|(sum, x)| *sum += x);
    }

    /// Its variance alone, where the response is long: what is kept counts as if it were new.
    fn variance(&self, squares: &[f64], t: usize) -> f64 {
        let past = self.gain[..t].iter().zip(&self.flips).rev();
        squares.iter().zip(past).map(|(h, (g, f))| h * (g * g + f)).sum()
    }
}

/// What reaches one sample.
struct Reaching {
    parts: [(u32, f64); LONGEST],
    count: usize,
}

impl Reaching {
    /// `Σ` over the rests that reach both.
    fn product(&self, earlier: &Self) -> f64 {
        let (mut i, mut k, mut sum) = (0, 0, 0.0);
        while i < self.count && k < earlier.count {
            let ((rest, part), (other, piece)) = (self.parts[i], earlier.parts[k]);
            if rest == other {
                sum += part * piece;
            }
            i += usize::from(rest >= other);
            k += usize::from(other >= rest);
        }
        sum
    }
}

/// What the noise makes of the innovations.
#[derive(Debug, Clone, Default)]
pub(crate) struct Acted {
    /// One over the standard deviation of each innovation, tracks apart.
    pub(crate) scale: Vec<Vec<f64>>,
    /// Autocorrelations of the scaled innovations at lags 1, 2, …; none where the response is long.
    pub(crate) colour: Vec<f64>,
}

/// The noise through the response `h` of `B̃/den`.
pub(crate) fn acted(tracks: &[DesignTrack], law: InputNoise, p: &Linear, h: &[f64]) -> Acted {
    let short = h.len() <= LONGEST;
    let squares: Vec<f64> = h.iter().map(|h| h * h).collect();
    // What is not kept goes no further than the response does.
    let lags = if law.kept { LAGS } else { LAGS.min(h.len().saturating_sub(1)) };
    let mut colour = vec![0.0; if short { lags } else { 0 }];
    let mut count = 0;
    let mut scale = Vec::with_capacity(tracks.len());
    for track in tracks {
        let counted = track.from..track.x.len();
        let Some(acting) = Acting::new(track, law, p) else {
            scale.push(vec![1.0; counted.len()]);
            continue;
        };
        let variance = |t: usize| if short { acting.power(h, t) } else { acting.variance(&squares, t) };
        let own: Vec<f64> = counted.clone().map(|t| 1.0 / (1.0 + variance(t)).sqrt()).collect();
        if short {
            acting.add_colour(h, &own, track.from, &mut colour);
        }
        count += counted.filter(|t| (t / BLOCK).is_multiple_of(EVERY)).count();
        scale.push(own);
    }
    colour.iter_mut().for_each(|sum| *sum /= count.max(1) as f64);
    Acted { scale, colour }
}

/// Deviance gained by a colour that is foretold: `−N ln v`, `v` the variance that the filter which whitens the foretold
/// autocorrelations leaves of the found ones.
pub(crate) fn colour_gain(scaled: &[Vec<f64>], foretold: &[f64]) -> f64 {
    if foretold.is_empty() {
        return 0.0;
    }
    let found = autocorrelation(scaled, foretold.len());
    let expected: Vec<f64> = std::iter::once(1.0).chain(foretold.iter().copied()).collect();
    let filter: Vec<f64> = std::iter::once(1.0).chain(levinson(&expected).0).collect();
    let row = |i: usize| filter.iter().enumerate().map(|(j, a)| a * found[i.abs_diff(j)]).sum::<f64>();
    let left: f64 = filter.iter().enumerate().map(|(i, a)| a * row(i)).sum();
    let count: usize = scaled.iter().map(Vec::len).sum();
    -(count as f64) * left.max(1e-9).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_adds_up_over_a_rest_and_what_is_new_does_not() {
        let acting = |rest: [u32; 6]| Acting { gain: vec![2.0; 6], rest: rest.to_vec(), flips: vec![0.5; 6] };
        let h = [0.5, 0.25];
        let covariance = |acting: &Acting, t: usize, lag: usize| {
            acting.covariance(&h, (t, lag), [&acting.reaching(&h, t), &acting.reaching(&h, t - lag)])
        };
        let new = acting([0, 1, 2, 3, 4, 5]);
        assert!((covariance(&new, 4, 0) - 4.5 * (0.25 + 0.0625)).abs() < 1e-12);
        assert!((covariance(&new, 4, 1) - 4.5 * 0.5 * 0.25).abs() < 1e-12);
        assert_eq!(covariance(&new, 4, 2), 0.0);
        assert_eq!(new.power(&h, 4), covariance(&new, 4, 0));
        assert!((new.variance(&[0.25, 0.0625], 4) - covariance(&new, 4, 0)).abs() < 1e-12);
        let kept = acting([0; 6]);
        assert!((covariance(&kept, 4, 0) - (4.0 * 0.5625 + 0.5 * 0.3125)).abs() < 1e-12);
        assert!((covariance(&kept, 5, 2) - 4.0 * 0.5625).abs() < 1e-12);
    }

    /// The oracle: every pair of the blocks on its own.
    #[test]
    fn the_colour_is_the_sum_over_pairs_in_every_fifth_block() {
        let count = 3000;
        let acting = Acting {
            gain: (0..count).map(|t| f64::from(t * 7 % 11)).collect(),
            rest: (0..count as u32).map(|t| t / 3).collect(),
            flips: (0..count).map(|t| f64::from(t % 5)).collect(),
        };
        let h = [0.5, 0.25, 0.125];
        for from in [6, 300, 1290] {
            let scale: Vec<f64> = (from..count as usize).map(|t| 1.0 / (1.0 + (t % 3) as f64)).collect();
            let mut found = [0.0; 4];
            acting.add_colour(&h, &scale, from, &mut found);
            for (lag, found) in (1..).zip(found) {
                let pairs =
                    (from + lag..count as usize).filter(|t| (t / BLOCK).is_multiple_of(EVERY)).map(|t| {
                        let both = [&acting.reaching(&h, t), &acting.reaching(&h, t - lag)];
                        acting.covariance(&h, (t, lag), both) * scale[t - from] * scale[t - lag - from]
                    });
                assert_eq!(found, pairs.sum::<f64>(), "{from} {lag}");
            }
        }
    }

    #[test]
    fn a_colour_foretold_exactly_gains_what_an_autoregression_does() {
        let mut y = 0.0;
        let z: Vec<f64> = (0..5000)
            .map(|t| {
                y = 0.6 * y + (f64::from(t * t % 1013) * 0.77).sin();
                y
            })
            .collect();
        let r = autocorrelation(std::slice::from_ref(&z), 3);
        let gain = colour_gain(std::slice::from_ref(&z), &r[1..]);
        assert!((gain + 5000.0 * levinson(&r).1.ln()).abs() < 1e-6);
        // Another colour gains less, and none gains nothing.
        assert!(colour_gain(std::slice::from_ref(&z), &[0.3, 0.1, 0.0]) < gain);
        assert_eq!(colour_gain(&[z], &[0.0, 0.0]), 0.0);
    }
}
