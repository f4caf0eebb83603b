//! How often a fault is found, by its size.

/// The share of faults of a size that are found: a logistic curve in the logarithm of the size,
///
/// ```text
/// ψ(s) = γ + (1 − γ)·(1 − λ) / (1 + (α/s)^β),   s > 0
/// ```
///
/// with threshold `α` > 0 (a size), slope `β` > 0, lapse rate `λ` in [0, 1] (how often even the largest is missed) and guess rate `γ` in
/// [0, 1) (how often one is found that is not there). `ψ` is the mean over laws and parameters of the fault and over draws of the noise; of
/// several laws with thresholds of their own it is a mixture of such curves, to which one that is less steep comes close.
///
/// Source: F. A. A. Kingdom and N. Prins, *Psychophysics: A Practical Introduction*, 2nd ed., Academic Press 2016, chapter 4; there `λ` is a share
/// of all faults, here of those that are not guessed, so that both rates are free in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Psychometric {
    /// `α`: the size at which half of what can be found is.
    pub threshold: f64,
    /// `β`.
    pub slope: f64,
    /// `λ`.
    pub lapse: f64,
    /// `γ`.
    pub guess: f64,
}

impl Psychometric {
    /// `ψ(s)`.
    pub(crate) fn found(&self, size: f64) -> f64 {
        let rises = 1.0 / (1.0 + (self.threshold / size).powf(self.slope));
        self.guess + (1.0 - self.guess) * (1.0 - self.lapse) * rises
    }

    /// The size at which a share is found, `ψ⁻¹`; none where no size is found as often, 0 where nothing is found that often already.
    pub(crate) fn size_for(&self, share: f64) -> Option<f64> {
        let rises = (share - self.guess) / ((1.0 - self.guess) * (1.0 - self.lapse));
        match rises {
            rises if rises <= 0.0 => Some(0.0),
            rises if rises < 1.0 => Some(self.threshold * (rises / (1.0 - rises)).powf(1.0 / self.slope)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_are_found_at_the_threshold() {
        let curve = Psychometric { threshold: 2.0, slope: 3.0, lapse: 0.0, guess: 0.0 };
        assert_eq!(curve.found(2.0), 0.5);
        // (s/2)³ = 9 where nine in ten are found.
        assert!((curve.size_for(0.9).unwrap() - 2.0 * 9.0_f64.cbrt()).abs() < 1e-12);
    }

    #[test]
    fn the_size_for_a_share_is_found_that_often() {
        let curve = Psychometric { threshold: 1.3, slope: 2.5, lapse: 0.04, guess: 0.02 };
        for share in [0.1, 0.5, 0.9] {
            assert!((curve.found(curve.size_for(share).unwrap()) - share).abs() < 1e-12);
        }
        assert_eq!(curve.size_for(0.97), None);
        assert_eq!(Psychometric { lapse: 1.0, ..curve }.size_for(0.5), None);
        assert_eq!(curve.size_for(0.01), Some(0.0));
    }

    #[test]
    fn the_ends_are_the_guess_and_the_lapse() {
        let curve = Psychometric { threshold: 1.0, slope: 4.0, lapse: 0.2, guess: 0.1 };
        assert!((curve.found(1e-9) - 0.1).abs() < 1e-12);
        assert!((curve.found(1e9) - (0.1 + 0.9 * 0.8)).abs() < 1e-12);
    }
}
