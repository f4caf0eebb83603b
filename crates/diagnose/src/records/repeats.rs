//! What of a simulation error repeats with the input: noise does not, a wrong model does.
//!
//! ```text
//! pₖ(φ) = mean of e over the k-th group of periods at phase φ, less its own mean
//! share = Σ_{k<l} ⟨pₖ, pₗ⟩ / pairs  over  the mean square of e about the groups' means
//! ```
//!
//! Errors of different groups share nothing but what repeats, so that the product is unbiased whatever the colour of the
//! noise, as long as it forgets within a group.

use crate::records::dataset::ScaledRecord;

/// Groups of periods at most.
const GROUPS: usize = 6;

/// Sums over the records that repeat their input.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Repeating {
    systematic: f64,
    total: f64,
}

impl Repeating {
    /// Adds the simulation error of one record; records with fewer than four whole periods say nothing.
    pub(crate) fn add(&mut self, scaled: &ScaledRecord, error: &[f64]) {
        let Some(period) = scaled.period else { return };
        let start = (scaled.from + period).min(error.len());
        let periods = (error.len() - start) / period;
        let groups = (periods / 2).min(GROUPS);
        if groups < 2 {
            return;
        }
        let each = periods / groups;
        let profiles: Vec<Vec<f64>> = error[start..]
            .chunks_exact(each * period)
            .take(groups)
            .map(|group| {
                let mean = group.iter().sum::<f64>() / group.len() as f64;
                self.total += group.iter().map(|e| (e - mean).powi(2)).sum::<f64>();
                (0..period)
                    .map(|phase| {
                        group[phase..].iter().step_by(period).map(|e| e - mean).sum::<f64>() / each as f64
                    })
                    .collect()
            })
            .collect();
        let pairs = (groups * (groups - 1) / 2) as f64;
        let mut product = 0.0;
        for (k, one) in profiles.iter().enumerate() {
            for other in &profiles[..k] {
                product += one.iter().zip(other).map(|(x, y)| x * y).sum::<f64>();
            }
        }
        self.systematic += product / pairs * (groups * each) as f64;
    }

    /// Share of the error's energy that repeats; absent where no record repeats its input.
    pub(crate) fn share(&self) -> Option<f64> {
        (self.total > 0.0).then(|| self.systematic / self.total)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use switchback_model::rig::{Role, Usage};

    use super::*;

    fn scaled(period: usize, length: usize) -> ScaledRecord {
        ScaledRecord {
            name: "drive".into(),
            role: Role::Free,
            usage: Usage::Fit,
            v: vec![0.0; length].into(),
            y: vec![0.0; length].into(),
            clock: 0,
            before: 0,
            travelled: 0.0,
            period: Some(period),
            from: 12,
            moves: Arc::default(),
            standing: false,
        }
    }

    #[test]
    fn coloured_noise_does_not_repeat_and_a_profile_does() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut e = 0.0;
        let noise: Vec<f64> = (0..8000)
            .map(|_| {
                e = 0.97 * e + rng.random::<f64>() - 0.5;
                e
            })
            .collect();
        let of = |error: &[f64]| {
            let mut sums = Repeating::default();
            sums.add(&scaled(40, error.len()), error);
            sums.share().unwrap()
        };
        assert!(of(&noise).abs() < 0.05, "{}", of(&noise));
        let with_profile: Vec<f64> =
            noise.iter().enumerate().map(|(t, e)| e + 2.0 * f64::from(u8::from(t % 40 < 20))).collect();
        let variance = noise.iter().map(|e| e * e).sum::<f64>() / noise.len() as f64;
        let expected = 1.0 / (1.0 + variance);
        assert!((of(&with_profile) - expected).abs() < 0.08, "{} {expected}", of(&with_profile));
    }

    #[test]
    fn a_record_that_does_not_repeat_says_nothing() {
        let mut sums = Repeating::default();
        sums.add(&scaled(40, 90), &[1.0; 90]);
        assert!(sums.share().is_none());
    }
}
