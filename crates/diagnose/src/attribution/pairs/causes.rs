//! Which members of a pair are causes of their own.

use super::Pair;
use crate::effect::Effect;
use crate::effects::Follows;
use crate::model::augmented::AugmentedModel;

/// Share of what the best single effect gains, up to which a second one corrects the law of the first. Found on made rigs:
/// laws that miss a little leave a fifteenth, two causes of one size each take a tenth at least.
const CORRECTION: f64 = 0.085;
/// The same where the second gains little a sample as well, and follows whatever the law of the first misses.
const SMALL_CORRECTION: f64 = 0.3;
/// Deviance a sample up to which a second effect gains little, and up to which outliers correct a law whatever their share: where
/// it misses now and then, tails grow heavy.
const SMALL: f64 = 0.25;

/// The members of a pair by what they are.
#[derive(Debug, Clone)]
pub(crate) struct Causes {
    /// Those that are causes of their own.
    pub(crate) effects: Vec<Effect>,
    /// The one that takes no more than what an inexact law of the other leaves.
    pub(crate) correction: Option<Effect>,
    /// The confounded effect of the only cause that gains more alone: with what corrects the pair, the data cannot show which it is.
    pub(crate) rival: Option<Effect>,
}

impl Pair {
    /// Shows causes from corrections, `alone` being the gains of the single effects over the nominal model on as many `samples`.
    pub(crate) fn causes(&self, alone: &[(Effect, f64)], samples: usize) -> Causes {
        let augmented = &self.hypothesis.fit.augmented;
        let members = self.hypothesis.effects();
        let correction = if corrects_a_filter(augmented) {
            members.iter().copied().find(|e| e.card().colours_noise)
        } else if augmented.saturation.is_some() {
            // Ties at a limit are exact: there is nothing to correct.
            None
        } else {
            self.small_correction(alone, samples)
        };
        let effects: Vec<Effect> = members.into_iter().filter(|e| Some(*e) != correction).collect();
        let rival = confounded_ahead(&effects, alone);
        Causes { effects, correction, rival }
    }

    /// The member that gains less alone, where it takes no more than what an inexact law of the other leaves.
    fn small_correction(&self, alone: &[(Effect, f64)], samples: usize) -> Option<Effect> {
        let members = self.hypothesis.effects();
        let of = |effect: Effect| alone.iter().find(|g| g.0 == effect).map_or(f64::NEG_INFINITY, |g| g.1);
        let best = alone.iter().map(|g| g.1).fold(0.0, f64::max);
        let second = if of(members[1]) > of(members[0]) { members[0] } else { members[1] };
        let follows = match second.card().follows {
            Some(Follows::Anything) => true,
            Some(Follows::Steps) => self.is_hidden,
            None => false,
        };
        is_correction((second, follows), self.gain, best, samples).then_some(second)
    }
}

/// Whether a filter of the input has a moving average of the noise beside it. Where the filter's law `P` is a little off, `A` takes
/// what is missing, and the noise of the equation pays for it: `A y = B/(P·Q) u + ξ ⟺ Q·A y = B/P u + Q·ξ`.
fn corrects_a_filter(augmented: &AugmentedModel) -> bool {
    augmented.denominator.len() > 1 && !augmented.noise.ma.is_empty()
}

/// The confounded effect of an only cause, where it is the effect that gains most `alone`.
fn confounded_ahead(causes: &[Effect], alone: &[(Effect, f64)]) -> Option<Effect> {
    let [cause] = causes else { return None };
    let (first, _) = alone.iter().max_by(|x, y| x.1.total_cmp(&y.1))?;
    cause.confounded_effects().contains(first).then_some(*first)
}

/// Whether a second effect that gains `gain` beside a first one that gains `best` alone only corrects its law; `follows` shows
/// that it follows whatever that misses.
fn is_correction((second, follows): (Effect, bool), gain: f64, best: f64, samples: usize) -> bool {
    let is_small = follows && gain < SMALL * samples as f64;
    gain < CORRECTION * best || is_small && (gain < SMALL_CORRECTION * best || second.card().heavy_tails)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_little_beside_much_is_a_correction() {
        let beside = |second, gain| is_correction((second, true), gain, 30_000.0, 1000);
        assert!(beside(Effect::ColouredNoise, 2400.0));
        assert!(!beside(Effect::ColouredNoise, 2600.0));
    }

    #[test]
    fn a_moving_average_beside_a_lag_corrects_it() {
        let mut lag = AugmentedModel::default();
        lag.filter(&[0.1], &[1.0, -0.9]);
        let mut noise = AugmentedModel::default();
        noise.noise.ma = vec![-0.8];
        assert!(!corrects_a_filter(&lag) && !corrects_a_filter(&noise));
        noise.filter(&[0.1], &[1.0, -0.9]);
        assert!(corrects_a_filter(&noise));
    }

    #[test]
    fn a_confounded_that_gains_more_alone_is_a_rival_of_an_only_cause() {
        let alone = [(Effect::ExtraPole, 9000.0), (Effect::InputDelay, 9500.0), (Effect::Creep, 100.0)];
        assert_eq!(confounded_ahead(&[Effect::ExtraPole], &alone), Some(Effect::InputDelay));
        // It is the first itself, it is no confounded effect of the first, there are two.
        assert_eq!(confounded_ahead(&[Effect::InputDelay], &alone), None);
        assert_eq!(confounded_ahead(&[Effect::Creep], &alone), None);
        assert_eq!(confounded_ahead(&[Effect::ExtraPole, Effect::Outliers], &alone), None);
    }

    #[test]
    fn what_is_small_in_itself_and_follows_anything_corrects_a_larger_share() {
        let beside = |gain, best| is_correction((Effect::ColouredNoise, true), gain, best, 10_000);
        assert!(beside(2400.0, 10_000.0));
        assert!(!beside(2400.0, 6000.0));
        assert!(!beside(2600.0, 10_000.0));
        assert!(!is_correction((Effect::OutputNoise, false), 2400.0, 10_000.0, 10_000));
    }

    #[test]
    fn heavy_tails_must_be_many_to_be_a_cause() {
        let beside = |second, gain| is_correction((second, true), gain, 6000.0, 10_000);
        assert!(beside(Effect::Outliers, 2000.0));
        assert!(!beside(Effect::Outliers, 5000.0));
        assert!(!beside(Effect::ColouredNoise, 2000.0));
    }
}
