//! Probabilities of the candidates, and of two effects together.

use crate::attribution::pairs::{Causes, Pair};
use crate::effect::Effect;
use crate::verdict::answer::{Status, Verdict, naming_nothing};

/// Deviance left in general that is still no gap worth a verdict: on ten thousand samples, a tenth of the noise's
/// standard deviation.
pub(crate) const IMMATERIAL: f64 = 100.0;

/// Probabilities of the candidates, that nothing is missing, and that the cause is no candidate.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Odds {
    /// One per candidate, in the order given.
    pub(crate) effects: Vec<f64>,
    pub(crate) none: f64,
    pub(crate) unexplained: f64,
}

/// Frequencies, found on made rigs with known causes, law mismatch included, whose seeds no report uses.
mod calibration {
    /// Deviance a sample that a second effect must gain.
    pub(super) const SECOND: f64 = 0.06;
    /// Share of what the second gains that both may leave.
    pub(super) const AFTER: f64 = 0.03;
    /// How often a pair that passes every test is the pair that was put in.
    pub(super) const TOGETHER: f64 = 0.88;
    /// How often the cause is the confounded effect of the pair's only cause, where the confounded effect gains more alone. Of seven such made rigs it was in five.
    pub(super) const CONFOUNDED: f64 = 0.6;
    /// How often nothing is missing where the model is exact: an effect may be too small to be seen.
    pub(super) const SILENCE: f64 = 0.89;
}

impl Odds {
    /// Those where nothing is left to explain.
    pub(crate) fn of_nothing() -> Self {
        Self { effects: Vec::new(), none: calibration::SILENCE, unexplained: 1.0 - calibration::SILENCE }
    }
}

/// Whether two effects hold together beside the best single one, which leaves `left` of its own.
///
/// Laws are never exact, so a little is always left that some other effect can take: the second must gain much, and hardly
/// anything may be left after it.
pub(crate) fn holds_together(pair: &Pair, samples: usize) -> bool {
    let total = pair.gain + pair.left;
    pair.gain > calibration::SECOND * samples as f64 && pair.left < calibration::AFTER * total
}

/// The verdict on a pair that holds, and the probabilities of single effects as members of it; one that is confounded with its only cause may stand for that.
pub(crate) fn of_pair(causes: &Causes, singles: impl Iterator<Item = Effect>) -> (Verdict, Odds) {
    let p = calibration::TOGETHER;
    let by_confounded = if causes.rival.is_some() { calibration::CONFOUNDED } else { 0.0 };
    let claim = |effect: Effect| match () {
        () if causes.effects.contains(&effect) => (1.0 - by_confounded) * p,
        () if causes.rival == Some(effect) => by_confounded * p,
        () => 0.0,
    };
    let odds = Odds { effects: singles.map(claim).collect(), none: 0.0, unexplained: 1.0 - p };
    let stage = causes.effects.first().map(|effect| effect.stage());
    let verdict = match (causes.rival, &causes.effects[..]) {
        (Some(rival), [cause]) => Verdict {
            effects: vec![rival],
            class: vec![rival, *cause],
            ..naming_nothing(Status::Class, Some(rival.stage()), p)
        },
        (_, effects) => Verdict { effects: effects.to_vec(), ..naming_nothing(Status::Named, stage, p) },
    };
    (Verdict { corrected_by: causes.correction, ..verdict }, odds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_names_both_and_a_confounded_effect_shares_with_its_only_cause() {
        let singles = [Effect::ExtraPole, Effect::InputDelay, Effect::Creep];
        let both = Causes { effects: vec![Effect::ExtraPole, Effect::Creep], correction: None, rival: None };
        let (verdict, odds) = of_pair(&both, singles.into_iter());
        assert_eq!((verdict.status, &verdict.effects), (Status::Named, &both.effects));
        assert_eq!(odds.effects, [verdict.probability, 0.0, verdict.probability]);
        let correction = Some(Effect::ColouredNoise);
        let rival = Some(Effect::InputDelay);
        let one = Causes { effects: vec![Effect::ExtraPole], correction, rival };
        let (verdict, odds) = of_pair(&one, singles.into_iter());
        assert_eq!((verdict.status, verdict.corrected_by), (Status::Class, correction));
        assert_eq!(verdict.class, [Effect::InputDelay, Effect::ExtraPole]);
        let sum = odds.effects.iter().sum::<f64>() + odds.none + odds.unexplained;
        assert!((sum - 1.0).abs() < 1e-12 && odds.effects[1] > odds.effects[0]);
    }
}
