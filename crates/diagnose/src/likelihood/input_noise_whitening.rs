//! Noise on the input that acts: what it adds to the equation error, and how errors that carry it are whitened.
//!
//! ```text
//! e(t) = ξ(t) + Σⱼ hⱼ·m(t−j),   m(t) = g(t)·n(t),   g = √r·du/dv;   n new at every move, and while v rests new too, or kept
//! ```
//!
//! in units of the standard deviation of `ξ`. What switches the operator while `v` rests, and what is added to `u` itself, add to the
//! variance of a new `m(t)`.
//! Given the past, `e(t)` is normal: a Kalman filter whose state is the last `m` turns errors into independent ones of unit
//! variance, and the likelihood is exact (Harvey, Forecasting, structural time series models and the Kalman filter, 1989, 3.4).

use crate::likelihood::design::DesignScaled;
use crate::likelihood::rows::Rows;
use crate::model::augmented::InputNoise;
use crate::model::linear::Linear;

/// The longest response whose colour is followed; behind a longer one the noise counts as white.
const LONGEST: usize = 12;

/// The noise of one record in units of `u`.
struct EnteringNoise {
    /// Variance of a new `m(t)`; `None` where the last one is kept.
    fresh: Vec<Option<f64>>,
}

impl EnteringNoise {
    fn new(scaled: &DesignScaled, law: InputNoise, p: &Linear) -> Option<Self> {
        let [slope, gap] = scaled.sensitivity.as_deref()?;
        let moved = |t: usize| t == 0 || scaled.moves[t].step != 0.0 || !law.kept;
        let squared = |ratio: f64, by: &Rows, t: usize| match ratio {
            0.0 => 0.0,
            _ => ratio * by.dot(t, &p.f).powi(2),
        };
        let variance = |t: usize| law.direct + squared(law.by_slope, slope, t) + squared(law.by_gap, gap, t);
        Some(Self { fresh: (0..scaled.x.len()).map(|t| moved(t).then(|| variance(t))).collect() })
    }

    /// Variance of each `m(t)`.
    fn variances(&self) -> impl Iterator<Item = f64> {
        let mut last = 0.0;
        self.fresh.iter().map(move |fresh| {
            last = fresh.unwrap_or(last);
            last
        })
    }
}

/// Whitens one record.
#[derive(Debug, Clone)]
pub(crate) struct Predictor {
    /// `h` at lags 1, 2, …; nothing where the noise counts as white.
    response: Vec<f64>,
    /// What a counted sample's surprise reports the last `m`, one entry a lag.
    gains: Vec<f64>,
    /// Whether the last `m` lives on after a counted sample.
    kept: Vec<bool>,
    /// One over the standard deviation of each surprise; zero where the sample is left out.
    pub(crate) scale: Vec<f64>,
}

impl Predictor {
    /// For errors without noise on the input.
    fn none(samples: usize) -> Self {
        Self {
            response: Vec::new(),
            gains: Vec::new(),
            kept: vec![false; samples],
            scale: vec![1.0; samples],
        }
    }

    fn new(scaled: &DesignScaled, noise: &EnteringNoise, h: &[f64], left_out: Option<&[bool]>) -> Self {
        let samples = scaled.x.len() - scaled.from;
        let used = |k: usize| left_out.is_none_or(|left_out| !left_out[k]);
        if h.len() > LONGEST {
            let squares: Vec<f64> = h.iter().map(|h| h * h).collect();
            let variances: Vec<f64> = noise.variances().collect();
            let variance =
                |t: usize| -> f64 { variances[..t].iter().rev().zip(&squares).map(|(m, h)| m * h).sum() };
            let scale = |k: usize| if used(k) { 1.0 / (1.0 + variance(scaled.from + k)).sqrt() } else { 0.0 };
            return Self { scale: (0..samples).map(scale).collect(), ..Self::none(samples) };
        }
        let mut state = Covariance::new(h);
        let mut out = Self {
            response: h.to_vec(),
            gains: Vec::with_capacity(samples * h.len()),
            kept: Vec::with_capacity(samples),
            scale: Vec::with_capacity(samples),
        };
        for (t, fresh) in noise.fresh.iter().enumerate() {
            if t >= scaled.from {
                let scale = state.observe(used(t - scaled.from), &mut out.gains);
                out.scale.push(scale);
                out.kept.push(fresh.is_none());
            }
            state.advance(*fresh);
        }
        out
    }

    /// Replaces errors by their surprises, scaled; several signals at once, a row a sample.
    pub(crate) fn follow<'a>(&'a self, width: usize) -> Follower<'a> {
        Follower { predictor: self, width, at: 0, state: vec![0.0; self.response.len() * width] }
    }

    /// One signal whitened.
    pub(crate) fn applied(&self, signal: &[f64]) -> Vec<f64> {
        let mut out = signal.to_vec();
        let mut follower = self.follow(1);
        out.chunks_exact_mut(1).for_each(|row| follower.next(row));
        out
    }
}

/// Whitens rows one after the other.
pub(crate) struct Follower<'a> {
    predictor: &'a Predictor,
    width: usize,
    at: usize,
    /// The last `m` expected, latest first, a row each.
    state: Vec<f64>,
}

impl Follower<'_> {
    /// The next row.
    pub(crate) fn next(&mut self, row: &mut [f64]) {
        let (p, width) = (self.predictor, self.width);
        let lags = p.response.len();
        for (h, m) in p.response.iter().zip(self.state.chunks_exact(width)) {
            row.iter_mut().zip(m).for_each(|(x, m)| *x -= h * m);
        }
        for (gain, m) in p.gains[self.at * lags..].iter().zip(self.state.chunks_exact_mut(width)) {
            row.iter().zip(m).for_each(|(x, m)| *m += gain * x);
        }
        if lags > 0 {
            self.state.copy_within(..(lags - 1) * width, width);
            if !p.kept[self.at] {
                self.state[..width].fill(0.0);
            }
        }
        row.iter_mut().for_each(|x| *x *= p.scale[self.at]);
        self.at += 1;
    }
}

/// How well the last `m` are known.
struct Covariance<'a> {
    h: &'a [f64],
    /// Row-major, latest first.
    p: Vec<f64>,
}

impl<'a> Covariance<'a> {
    fn new(h: &'a [f64]) -> Self {
        Self { h, p: vec![0.0; h.len() * h.len()] }
    }

    /// One over the standard deviation of the next error, which is then known; appends its gains.
    fn observe(&mut self, used: bool, gains: &mut Vec<f64>) -> f64 {
        let lags = self.h.len();
        if !used {
            gains.extend(std::iter::repeat_n(0.0, lags));
            return 0.0;
        }
        let mut shared = [0.0; LONGEST];
        for (shared, row) in shared.iter_mut().zip(self.p.chunks_exact(lags.max(1))) {
            *shared = row.iter().zip(self.h).map(|(p, h)| p * h).sum();
        }
        let shared = &shared[..lags];
        let variance = 1.0 + shared.iter().zip(self.h).map(|(s, h)| s * h).sum::<f64>();
        for (row, s) in self.p.chunks_exact_mut(lags.max(1)).zip(shared) {
            row.iter_mut().zip(shared).for_each(|(p, r)| *p -= s * r / variance);
        }
        gains.extend(shared.iter().map(|s| s / variance));
        1.0 / variance.sqrt()
    }

    /// One sample on: a fresh `m` of a variance, or the last one again.
    fn advance(&mut self, fresh: Option<f64>) {
        let lags = self.h.len();
        for i in (0..lags).rev() {
            for k in (0..lags).rev() {
                let (earlier, later) = (i.saturating_sub(1), k.saturating_sub(1));
                self.p[i * lags + k] = match (fresh, i.min(k)) {
                    (Some(variance), 0) if i == k => variance,
                    (Some(_), 0) => 0.0,
                    _ => self.p[earlier * lags + later],
                };
            }
        }
    }
}

/// The whitening of every record, for noise through the response `h` of `B̃/den`.
pub(crate) fn predictors(
    scaled_records: &[DesignScaled],
    law: InputNoise,
    p: &Linear,
    h: &[f64],
) -> Vec<Predictor> {
    let of_scaled = |scaled: &DesignScaled| match EnteringNoise::new(scaled, law, p) {
        Some(noise) => Predictor::new(scaled, &noise, h, scaled.mask.out.as_deref()),
        None => Predictor::none(scaled.x.len() - scaled.from),
    };
    scaled_records.iter().map(of_scaled).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::likelihood::design::Design;
    use crate::model::augmented::AugmentedModel;
    use crate::records::dataset::ScaledRecord;
    use crate::testing::{small_dataset, small_model};

    /// The oracle: the covariance of all errors of a record, written down and factored.
    fn covariance(noise: &EnteringNoise, h: &[f64], from: usize) -> Vec<Vec<f64>> {
        let samples = noise.fresh.len();
        let variances: Vec<f64> = noise.variances().collect();
        let of_rest: Vec<usize> = noise
            .fresh
            .iter()
            .scan(0, |rest, fresh| {
                *rest += usize::from(fresh.is_some());
                Some(*rest)
            })
            .collect();
        let shared = |s: usize, t: usize| if of_rest[s] == of_rest[t] { variances[s] } else { 0.0 };
        let entry = |t: usize, k: usize| {
            let mut sum = f64::from(u8::from(t == k));
            for (i, b) in h.iter().enumerate().take(t) {
                for (j, c) in h.iter().enumerate().take(k) {
                    sum += b * c * shared(t - i - 1, k - j - 1);
                }
            }
            sum
        };
        (from..samples).map(|t| (from..samples).map(|k| entry(t, k)).collect()).collect()
    }

    /// `L⁻¹x` and the diagonal of `L`, `L·Lᵀ` the covariance.
    fn whitened(covariance: &[Vec<f64>], x: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = x.len();
        let mut l = vec![vec![0.0; n]; n];
        let mut out = vec![0.0; n];
        for i in 0..n {
            for j in 0..=i {
                let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
                let rest = covariance[i][j] - sum;
                l[i][j] = if i == j { rest.sqrt() } else { rest / l[j][j] };
            }
            let sum: f64 = (0..i).map(|k| l[i][k] * out[k]).sum();
            out[i] = (x[i] - sum) / l[i][i];
        }
        (out, (0..n).map(|i| l[i][i]).collect())
    }

    fn scaled_with(samples: usize, from: usize) -> DesignScaled {
        let (dataset, grid) = small_dataset();
        let design = Design::new(&dataset, &grid, &AugmentedModel::default(), ScaledRecord::is_fit);
        let mut scaled = design.scaled_records[0].clone();
        scaled.x = vec![0.0; samples].into();
        scaled.from = from;
        scaled
    }

    proptest! {
        #[test]
        fn surprises_are_those_of_the_whole_covariance(
            fresh in prop::collection::vec(prop::option::of(0.0..4.0_f64), 30),
            h in prop::collection::vec(-1.5..1.5_f64, 1..4),
            from in 0_usize..6,
        ) {
            let mut noise = EnteringNoise { fresh };
            noise.fresh[0] = Some(1.0);
            let scaled = scaled_with(30, from);
            let x: Vec<f64> = (from..30).map(|t| (t as f64 * 1.7).sin() * 2.0).collect();
            let predictor = Predictor::new(&scaled, &noise, &h, None);
            let (expected, sd) = whitened(&covariance(&noise, &h, from), &x);
            for (k, found) in predictor.applied(&x).into_iter().enumerate() {
                prop_assert!((found - expected[k]).abs() < 1e-9, "{k}: {found} {}", expected[k]);
                prop_assert!((predictor.scale[k] * sd[k] - 1.0).abs() < 1e-9);
            }
        }

        #[test]
        fn rows_are_whitened_as_signals_are(
            fresh in prop::collection::vec(prop::option::of(0.0..4.0_f64), 20),
            h in prop::collection::vec(-1.5..1.5_f64, 1..4),
        ) {
            let left_out: Vec<bool> = (0..17).map(|k| k % 5 == 2).collect();
            let predictor = Predictor::new(&scaled_with(20, 3), &EnteringNoise { fresh }, &h, Some(&left_out));
            let signals = [1.1, 0.3].map(|f: f64| (0..17).map(|k| (k as f64 * f).cos()).collect::<Vec<f64>>());
            let mut follower = predictor.follow(2);
            let [one, other] = signals.each_ref().map(|s| predictor.applied(s));
            for k in 0..17 {
                let mut row = [signals[0][k], signals[1][k]];
                follower.next(&mut row);
                prop_assert!((row[0] - one[k]).abs() + (row[1] - other[k]).abs() < 1e-12);
                prop_assert!(!left_out[k] || row == [0.0, 0.0]);
            }
        }
    }

    #[test]
    fn behind_a_long_response_the_noise_counts_as_white() {
        let h: Vec<f64> = (0..LONGEST + 3).map(|k| 0.8_f64.powi(k as i32)).collect();
        let noise = EnteringNoise { fresh: vec![Some(0.5); 40] };
        let predictor = Predictor::new(&scaled_with(40, 5), &noise, &h, None);
        let short = covariance(&noise, &h, 5);
        for (k, scale) in predictor.scale.iter().enumerate() {
            assert!((scale - 1.0 / short[k][k].sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn noise_acts_by_the_slope_and_is_kept_at_rest() {
        let (dataset, grid) = small_dataset();
        let mut augmented = AugmentedModel::default();
        let law = InputNoise { by_slope: 2.0, kept: true, ..InputNoise::default() };
        augmented.noise.input = Some(law);
        let p = small_model(&grid);
        let design = Design::new(&dataset, &grid, &augmented, ScaledRecord::is_fit);
        for scaled in &design.scaled_records {
            let noise = EnteringNoise::new(scaled, law, &p).expect("a sensitivity");
            let slope = &scaled.sensitivity.as_deref().expect("a sensitivity")[0];
            for (t, fresh) in noise.fresh.iter().enumerate().skip(1) {
                let moves = scaled.moves[t].step != 0.0;
                assert_eq!(*fresh, moves.then(|| 2.0 * slope.dot(t, &p.f).powi(2)), "{t}");
            }
        }
    }
}
