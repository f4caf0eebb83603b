//! The fit that leads among those of the likeliest effects joins their probabilities.

use crate::comparison::Compared;
use crate::differences::Row;
use crate::effect::Effect;

/// The effect that gains most of those that were fitted with the model, or of those by which a machine differs from a source.
///
/// ```text
/// x = s·(Δ₁ − Δ₂)/(Δ₁ + c)      s share of the gap on held-out records that it closes, from 0 to 1
///                               Δ₁, Δ₂ drops of the penalised deviance by it and by the next, not below 0
/// p′ ∝ p·exp(β·x)               of this effect; the others keep theirs up to the common factor
/// ```
///
/// A fit that leads and closes the gap confirms an effect that the evidence holds likely. It does not decide by itself: laws are flexible, and of several
/// that are wrong one leads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeadingFit {
    /// The effect.
    pub effect: Effect,
    /// `s`.
    pub closes: f64,
    /// `Δ₁` and `Δ₂`.
    pub gains: [f64; 2],
    /// `p`: its probability by evidence alone.
    pub by_evidence: f64,
    /// `β` and `c`: [`OF_FITS`](Self::OF_FITS) or [`OF_DIFFERENCES`](Self::OF_DIFFERENCES).
    pub coefficients: [f64; 2],
}

impl LeadingFit {
    /// `β` and `c` where the effects were fitted with a model of the machine's own: the likeliest on rigs of the training population, by the example
    /// `leading_fit`.
    pub const OF_FITS: [f64; 2] = [5.0, 10.0];
    /// The same where they are missing in a source; `β` of 2.5 to 6 is as likely.
    pub const OF_DIFFERENCES: [f64; 2] = [4.0, 200.0];

    /// That of a comparison; none where no fit of a possible cause gains. `by_evidence` has the probability of an effect.
    pub(crate) fn of(compared: &Compared, by_evidence: impl Fn(Effect) -> f64) -> Option<Self> {
        let mut fits: Vec<_> =
            compared.effects.iter().filter(|fit| !fit.unstable && by_evidence(fit.effect) > 0.0).collect();
        fits.sort_by(|x, y| y.delta_bic.total_cmp(&x.delta_bic));
        let first = fits.first().filter(|first| first.delta_bic > 0.0)?;
        Some(Self {
            effect: first.effect,
            closes: first.closure.map_or(0.0, |closure| closure.clamp(0.0, 1.0)),
            gains: [first.delta_bic, fits.get(1).map_or(0.0, |next| next.delta_bic.max(0.0))],
            by_evidence: by_evidence(first.effect),
            coefficients: Self::OF_FITS,
        })
    }

    /// That of the effects missing in a source; none where none is.
    pub(crate) fn missing(missing: &[(Effect, &Row)], by_evidence: impl Fn(Effect) -> f64) -> Option<Self> {
        let mut missing: Vec<_> = missing.iter().filter(|(effect, _)| by_evidence(*effect) > 0.0).collect();
        missing.sort_by(|(_, x), (_, y)| y.gain.total_cmp(&x.gain));
        let (effect, first) = missing.first().filter(|(_, first)| first.gain > 0.0)?;
        Some(Self {
            effect: *effect,
            closes: first.closure.clamp(0.0, 1.0),
            gains: [first.gain, missing.get(1).map_or(0.0, |(_, next)| next.gain.max(0.0))],
            by_evidence: by_evidence(*effect),
            coefficients: Self::OF_DIFFERENCES,
        })
    }

    /// The factor of its probability before all sum to one again.
    pub fn weight(&self) -> f64 {
        let [beta, large] = self.coefficients;
        libm::exp(beta * self.lead(large))
    }

    /// `x` by a coefficient `c`.
    pub fn lead(&self, large: f64) -> f64 {
        let [first, next] = self.gains;
        self.closes * (first - next) / (first + large)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::{Comparison, EffectEvidence};

    fn compared(fits: &[(Effect, f64, f64)]) -> Compared {
        let says = |(effect, delta_bic, closure): &(Effect, f64, f64)| EffectEvidence {
            effect: *effect,
            parameters: 2.0,
            delta_bic: *delta_bic,
            heldout_log_score: 0.0,
            gains: Vec::new(),
            closure: Some(*closure),
            degrades_validation: false,
            unstable: false,
        };
        Compared {
            comparison: Comparison::Simulation,
            samples: 1000,
            left_by_nominal: 0.0,
            left_by_best: 0.0,
            gap: [0.0; 2],
            held_out_error_ratio: None,
            effects: fits.iter().map(says).collect(),
        }
    }

    #[test]
    fn the_fit_that_gains_most_leads_whatever_it_closes() {
        let fits =
            [(Effect::Creep, 150.0, 0.9), (Effect::Backlash, 600.0, 1.3), (Effect::Stribeck, -5.0, 0.1)];
        let leading = LeadingFit::of(&compared(&fits), |_| 0.4).expect("it gains");
        let expected = LeadingFit {
            effect: Effect::Backlash,
            closes: 1.0,
            gains: [600.0, 150.0],
            by_evidence: 0.4,
            coefficients: LeadingFit::OF_FITS,
        };
        assert_eq!(leading, expected);
        let alone = LeadingFit::of(&compared(&[(Effect::Creep, 90.0, -1.0)]), |_| 0.4).expect("it gains");
        assert_eq!((alone.closes, alone.gains), (0.0, [90.0, 0.0]));
        assert!(LeadingFit::of(&compared(&[(Effect::Creep, -9.0, 0.9)]), |_| 0.4).is_none());
    }

    #[test]
    fn what_is_no_cause_leads_nothing() {
        let fits = [(Effect::ColouredNoise, 900.0, 0.9), (Effect::Backlash, 600.0, 0.8)];
        let possible = |effect| if effect == Effect::Backlash { 0.4 } else { 0.0 };
        let leading = LeadingFit::of(&compared(&fits), possible).expect("it gains");
        assert_eq!((leading.effect, leading.gains), (Effect::Backlash, [600.0, 0.0]));
    }

    #[test]
    fn a_weight_is_that_of_the_formula() {
        let fit = |closes, gains| LeadingFit {
            effect: Effect::Creep,
            closes,
            gains,
            by_evidence: 0.4,
            coefficients: [2.0, 50.0],
        };
        // x = 0.5 · 300/(450 + 50)
        assert!((fit(0.5, [450.0, 150.0]).weight() - (2.0_f64 * 0.3).exp()).abs() < 1e-12);
        // Neither a fit that closes nothing nor one that another equals says anything.
        let says = |closes, gains| fit(closes, gains).weight();
        assert_eq!([says(0.0, [2000.0, 0.0]), says(1.0, [2000.0, 2000.0])], [1.0, 1.0]);
    }
}
