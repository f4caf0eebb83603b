//! Calibrated probabilities: of each candidate, of `none` (nothing is missing), and of `unexplained` (the cause is no candidate).

use crate::attribution::SIGNIFICANT;
use crate::attribution::pairs::{Causes, Pair};
use crate::effect::Effect;

/// Probability of "none of these" from which no candidate is offered.
pub(crate) const UNEXPLAINED: f64 = 0.5 * calibration::ALL_FAIL;

/// Deviance left in general that is still no gap worth a verdict: on ten thousand samples, a tenth of the noise's
/// standard deviation.
pub(crate) const IMMATERIAL: f64 = 100.0;

/// Probabilities of the candidates, that nothing is missing, and that the cause is no candidate.
#[derive(Debug, Clone)]
pub(crate) struct Odds {
    /// One per candidate, in the order given.
    pub(crate) effects: Vec<f64>,
    pub(crate) none: f64,
    pub(crate) unexplained: f64,
}

impl Odds {
    /// Those where nothing is found.
    pub(crate) fn of_nothing() -> Self {
        Self { effects: Vec::new(), none: calibration::SILENCE, unexplained: 1.0 - calibration::SILENCE }
    }

    /// The same where the colour of noise belongs to the model: where nothing but that is found nothing is missing. `effects` are those
    /// that the probabilities are of.
    pub(crate) fn with_colour_in_the_model(mut self, effects: impl Iterator<Item = Effect>) -> Self {
        for (p, _) in self.effects.iter_mut().zip(effects).filter(|(_, effect)| effect.card().colours_noise) {
            self.none += std::mem::take(p);
        }
        self
    }

    /// Probability that something is missing and one of the candidates is it.
    pub(crate) fn reported(&self) -> f64 {
        1.0 - self.none - self.unexplained
    }
}

/// Calibration constants, found on made rigs with known causes, law mismatch included, whose seeds no report uses.
mod calibration {
    /// Share of what the best candidate leaves that counts against the distance to its rivals: laws are never exact, so
    /// a rival is ruled out only by a distance large against what the best itself leaves unexplained.
    pub(super) const TEMPER: f64 = 0.12;
    /// Fraction of the gap left unexplained at which "none of these" is as likely as the best candidate, and its scale; and the
    /// same where the best is barely better than its rivals, as stand-ins are.
    pub(super) const LEFT: (f64, f64) = (0.35, 0.05);
    pub(super) const LEFT_BY_MANY: (f64, f64) = (0.03, 0.01);
    /// Share of the held-out gap that the best must close for being barely better than its rivals not to matter: stand-ins
    /// follow the records they were fitted to.
    pub(super) const CLOSES: f64 = 0.85;
    /// Fraction of the gap left, one step ahead and on the held-out records, from which the best, with a rival of another class
    /// behind it, stands in for something else.
    pub(super) const STANDS_IN: f64 = 0.05;
    /// The same whatever is behind it, of an effect that leaves the held-out gap, too; of others their cards show.
    pub(super) const MOST_LEFT_WITH_THE_GAP: f64 = 0.1;
    /// Margin over rivals of other classes, as a share of the gain, up to which the best counts as one of many.
    pub(super) const MANY: f64 = 0.2;
    /// Probability that the cause is foreign even where a candidate leaves nothing.
    pub(super) const FOREIGN: f64 = 0.02;
    /// How often the ranking holds where the best leaves nothing, whatever its margin: a law that is not the cause leaves
    /// something.
    pub(super) const WHOLE: f64 = 0.93;
    /// The same where it leaves much.
    pub(super) const PARTLY: f64 = 0.55;
    /// How often the cause is an effect without any claim by its gain, where the best leaves much: their laws may all be poor.
    pub(super) const NO_CLAIM: f64 = 0.18;
    /// Fraction left up to which the best counts as leaving nothing, and its scale.
    pub(super) const NOTHING: (f64, f64) = (0.05, 0.01);
    /// The same where the best is flexible enough to imitate others almost exactly.
    pub(super) const NOTHING_BY_FLEXIBLE: (f64, f64) = (0.004, 0.0008);
    /// Deviance a sample that a second effect must gain.
    pub(super) const SECOND: f64 = 0.06;
    /// Share of what the second gains that both may leave.
    pub(super) const AFTER: f64 = 0.03;
    /// How often a pair that passes every test is the pair that was put in.
    pub(super) const TOGETHER: f64 = 0.89;
    /// How often the cause is the confounded effect of the pair's only cause, where the confounded effect gains more alone. Of seven such made rigs it was in five.
    pub(super) const CONFOUNDED: f64 = 0.6;
    /// How often nothing is missing where nothing is found: an effect may be too small to be seen.
    pub(super) const SILENCE: f64 = 0.89;
    /// How often the cause is none of the candidates where all of them fail: the best may still be a poor law of the cause.
    pub(super) const ALL_FAIL: f64 = 0.42;
    /// The same where the best should close the gap on held-out records and does not.
    pub(super) const REFUTED: f64 = 0.62;
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// How far the best counts as leaving nothing of the gap, from a fraction of which it leaves: 1 throughout.
fn explained_weight(best: Effect, fraction: f64) -> f64 {
    let (nothing, scale) =
        if best.is_flexible() { calibration::NOTHING_BY_FLEXIBLE } else { calibration::NOTHING };
    logistic((nothing - fraction) / scale)
}

/// Fraction of the gap that an effect leaves at most where it is the cause, whatever rivals are behind it; `misses` shows that it
/// does not close the gap on the held-out records.
fn most_left_by_a_cause(effect: Effect, misses: bool) -> f64 {
    let moves_simulation = !effect.is_noise() && !effect.is_of_its_record();
    let most = effect.card().most_left;
    if moves_simulation && misses { most.min(calibration::MOST_LEFT_WITH_THE_GAP) } else { most }
}

/// What the best candidate leaves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Residuals {
    /// Deviance that causes in general would still gain.
    pub(crate) deviance: f64,
    /// Share of the gap on the held-out records, where there is one.
    pub(crate) gap: Option<f64>,
    /// Whether it should close that gap and does not.
    pub(crate) refuted: bool,
}

/// Weighs single-effect candidates against each other, against none and against none of these.
///
/// ```text
/// P(effect) ∝ (1 − ε)·[trust·exp(−Δ/(2·T)) + (1 − trust)·exp(−Δ/(2·0.1·gain))] + ε/count
/// T = 1 + TEMPER·left,   Δ distance to the best in penalised deviance, gain that of the best over the nominal model
/// ```
///
/// Each of the two exponentials is normalised on its own; `trust` falls and `ε` rises with the fraction that the best leaves.
pub(crate) fn odds(nominal_bic: f64, effects: &[(Effect, f64)], best_leaves: Residuals) -> Odds {
    let weighing = Weighing::new(nominal_bic, effects, best_leaves);
    let none = calibration::SILENCE * weighing.none();
    let unexplained = (1.0 - none) * weighing.unexplained();
    let rest = (1.0 - none - unexplained).max(0.0);
    let effects = weighing.claims().into_iter().map(|claim| rest * claim).collect();
    Odds { effects, none, unexplained }
}

/// Single-effect candidates with their penalised deviance, and what the best of them leaves.
struct Weighing<'a> {
    nominal_bic: f64,
    effects: &'a [(Effect, f64)],
    leaves: Residuals,
    /// The best, its penalised deviance and what it gains over the nominal model.
    first: Option<Effect>,
    best: f64,
    gain: f64,
}

impl<'a> Weighing<'a> {
    fn new(nominal_bic: f64, effects: &'a [(Effect, f64)], leaves: Residuals) -> Self {
        let best = effects.iter().map(|e| e.1).fold(f64::INFINITY, f64::min);
        let first = effects.iter().min_by(|x, y| x.1.total_cmp(&y.1)).map(|e| e.0);
        Self { nominal_bic, effects, leaves, first, best, gain: nominal_bic - best }
    }

    /// Fraction of the gap that the best leaves, one step ahead.
    fn fraction(&self) -> f64 {
        self.leaves.deviance / (self.leaves.deviance + self.gain.max(1.0))
    }

    /// Whether the best closes the held-out gap.
    fn closes(&self) -> bool {
        self.leaves.gap.is_some_and(|gap| 1.0 - gap > calibration::CLOSES)
    }

    /// Whether an effect is the best or a confounded effect of it.
    fn is_alike(&self, effect: Effect) -> bool {
        self.first.is_some_and(|first| effect == first || first.confounded_effects().contains(&effect))
    }

    /// Probability that nothing is missing: the gain is what the search finds in noise.
    fn none(&self) -> f64 {
        let none = 1.0 / (1.0 + ((self.gain - SIGNIFICANT) / 6.0).clamp(-60.0, 60.0).exp());
        match self.gain < SIGNIFICANT {
            true => none * (-((self.leaves.deviance - IMMATERIAL) / 40.0).max(0.0)).exp(),
            false => none,
        }
    }

    /// Whether the best follows something else to a good part.
    fn is_stand_in(&self) -> bool {
        let (left, fraction) = (self.leaves.deviance, self.fraction());
        let others = self.effects.iter().filter(|e| Some(e.0) != self.first);
        let second = others.min_by(|x, y| x.1.total_cmp(&y.1));
        // A long autoregression follows any spectrum: what it leaves has none.
        let follows_all = self.first.is_some_and(|e| e.card().colours_noise) && left > IMMATERIAL;
        let all_but_closes = self.leaves.gap.is_some_and(|gap| gap < calibration::STANDS_IN);
        let leaves_much = fraction > calibration::STANDS_IN && !all_but_closes;
        let misses = self.leaves.gap.is_none_or(|gap| gap.abs() > 1.0 - calibration::CLOSES);
        follows_all && second.is_some()
            || leaves_much && second.is_some_and(|e| !self.is_alike(e.0))
            || self.first.is_some_and(|e| left > IMMATERIAL && fraction > most_left_by_a_cause(e, misses))
    }

    /// Whether the best is barely better than rivals of other classes, as stand-ins are.
    fn is_one_of_many(&self) -> bool {
        let rivals = self.effects.iter().filter(|e| !self.is_alike(e.0));
        let runner_up = rivals.map(|e| e.1).fold(self.nominal_bic, f64::min);
        let margin = (runner_up - self.best) / self.gain.max(1.0);
        margin < calibration::MANY && !self.closes() && self.first.is_some_and(|e| !e.is_flexible())
    }

    /// How far what the best leaves shows that the cause is none of the candidates: 1 where it cannot be one.
    fn unlisted(&self) -> f64 {
        let (middle, scale) =
            if self.is_one_of_many() { calibration::LEFT_BY_MANY } else { calibration::LEFT };
        match (self.is_stand_in(), self.closes()) {
            (true, _) => 1.0,
            (false, true) => calibration::FOREIGN,
            (false, false) => logistic((self.fraction() - middle) / scale).max(calibration::FOREIGN),
        }
    }

    /// Probability, given that something is missing, that it is none of the candidates.
    fn unexplained(&self) -> f64 {
        match self.leaves.refuted {
            true => calibration::REFUTED,
            false => calibration::ALL_FAIL * self.unlisted(),
        }
    }

    /// Probability of each effect, given that it is one of them.
    fn claims(&self) -> Vec<f64> {
        let sharp = self.weights(1.0 + calibration::TEMPER * self.leaves.deviance.max(0.0));
        let blunt = self.weights((0.1 * self.gain).max(1.0));
        let whole = self.first.map_or(1.0, |effect| explained_weight(effect, self.fraction()));
        let trust = calibration::PARTLY + (calibration::WHOLE - calibration::PARTLY) * whole;
        let no_claim = calibration::NO_CLAIM * (1.0 - whole);
        let claim = |(sharp, blunt): (&f64, &f64)| {
            let claim = trust * sharp + (1.0 - trust) * blunt;
            (1.0 - no_claim) * claim + no_claim / self.effects.len() as f64
        };
        sharp.iter().zip(&blunt).map(claim).collect()
    }

    /// `exp(−Δ/2T)`, normalised.
    fn weights(&self, temperature: f64) -> Vec<f64> {
        // Noise moves no simulation error: it is no rival of what takes most of it away.
        let moves = self.closes() && self.first.is_some_and(|e| !e.is_noise());
        let weight = |(e, bic): &(Effect, f64)| match moves && e.is_noise() {
            true => 0.0,
            false => (-(bic - self.best) / (2.0 * temperature)).exp(),
        };
        let weights: Vec<f64> = self.effects.iter().map(weight).collect();
        let sum = weights.iter().sum::<f64>().max(1e-300);
        weights.into_iter().map(|w| w / sum).collect()
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

/// Weighs what a pair names, `causes`; the singles are no rivals of a pair that holds one of them, but for a confounded effect.
pub(crate) fn odds_together(
    nominal_bic: f64,
    pair: &Pair,
    causes: &Causes,
    singles: &[(Effect, f64)],
) -> Odds {
    let members = pair.hypothesis.effects();
    let leaves = Residuals { deviance: pair.left, gap: None, refuted: false };
    let mut together = odds(nominal_bic, &[(members[0], pair.hypothesis.bic())], leaves);
    let p = calibration::TOGETHER * together.effects[0];
    together.unexplained += together.effects[0] - p;
    let by_confounded = if causes.rival.is_some() { calibration::CONFOUNDED } else { 0.0 };
    let claim = |effect: Effect| match () {
        () if causes.effects.contains(&effect) => (1.0 - by_confounded) * p,
        () if causes.rival == Some(effect) => by_confounded * p,
        () => 0.0,
    };
    together.effects = singles.iter().map(|(e, _)| claim(*e)).collect();
    together
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    const NOMINAL: f64 = 0.0;

    fn weighed(rivals: [(Effect, f64); 2], deviance: f64, gap: f64) -> Odds {
        let odds = odds(NOMINAL, &rivals, Residuals { deviance, gap: Some(gap), refuted: false });
        let sum = odds.effects.iter().sum::<f64>() + odds.none + odds.unexplained;
        assert!((sum - 1.0).abs() < 1e-9, "probabilities sum to {sum}");
        odds
    }

    #[test]
    fn where_the_model_has_the_colour_of_noise_nothing_is_missing() {
        let odds = Odds { effects: vec![0.7, 0.1], none: 0.05, unexplained: 0.15 };
        let moved = odds.with_colour_in_the_model([Effect::ColouredNoise, Effect::Backlash].into_iter());
        assert!((moved.none - 0.75).abs() < 1e-12 && moved.effects == [0.0, 0.1], "{moved:?}");
        assert!((moved.effects.iter().sum::<f64>() + moved.none + moved.unexplained - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_leaves_nothing_is_named_at_any_margin() {
        let odds = weighed([(Effect::Backlash, -5000.0), (Effect::Creep, -4980.0)], 0.0, 0.05);
        assert!(odds.effects[0] > Settings::default().name_at, "{odds:?}");
    }

    #[test]
    fn one_of_many_that_leave_much_is_no_cause_unless_it_closes_the_gap() {
        let rivals = [(Effect::Backlash, -5000.0), (Effect::Creep, -4500.0)];
        for left in [200.0, 900.0] {
            assert!(weighed(rivals, left, 0.6).unexplained > UNEXPLAINED);
            assert!(weighed(rivals, left, 0.04).unexplained < UNEXPLAINED);
        }
        // A rival of its own class is no other cause.
        let confounded_effects = [(Effect::Backlash, -5000.0), (Effect::GradualTransition, -4500.0)];
        assert!(weighed(confounded_effects, 400.0, 0.6).unexplained < UNEXPLAINED);
    }

    #[test]
    fn what_should_close_the_gap_and_does_not_is_no_cause() {
        let rivals = [(Effect::Backlash, -5000.0), (Effect::Creep, -1000.0)];
        let leaves = Residuals { deviance: 0.0, gap: Some(0.9), refuted: true };
        let odds = odds(NOMINAL, &rivals, leaves);
        assert!((odds.unexplained - calibration::REFUTED).abs() < 1e-9, "{odds:?}");
    }

    #[test]
    fn what_leaves_much_with_a_rival_of_another_class_behind_it_stands_in_for_something_else() {
        let closing = 0.1;
        let rivals =
            |second: Effect| weighed([(Effect::Backlash, -9000.0), (second, -2000.0)], 900.0, closing);
        assert!(rivals(Effect::Creep).unexplained > UNEXPLAINED);
        assert!(rivals(Effect::GradualTransition).unexplained < UNEXPLAINED);
    }

    #[test]
    fn coloured_noise_leaves_nothing_where_it_is_the_cause() {
        let rivals = [(Effect::ColouredNoise, -9000.0), (Effect::ExtraPole, -7000.0)];
        assert!(weighed(rivals, 3.0 * IMMATERIAL, 1.0).unexplained > UNEXPLAINED);
        assert!(weighed(rivals, 0.5 * IMMATERIAL, 1.0).unexplained < UNEXPLAINED);
    }

    #[test]
    fn what_leaves_more_than_a_cause_does_stands_in_for_something_else() {
        let leaving = |effect: Effect, deviance: f64, gap: f64| {
            let confounded = effect.confounded_effects()[0];
            weighed([(effect, -9000.0), (confounded, -2000.0)], deviance, gap).unexplained > UNEXPLAINED
        };
        // A fifth, with and without the held-out gap.
        assert!(leaving(Effect::Backlash, 2250.0, 0.4));
        assert!(!leaving(Effect::Backlash, 2250.0, 0.1));
        // Half, and what a resonance leaves.
        assert!(leaving(Effect::Backlash, 9000.0, 0.1));
        assert!(leaving(Effect::Resonance, 2700.0, 0.1));
        assert!(!leaving(Effect::Resonance, 2250.0, 0.1));
        // A thirtieth and a hundredth.
        assert!(leaving(Effect::Outliers, 300.0, 1.0));
        assert!(!leaving(Effect::Outliers, 90.0, 1.0));
        // A thirtieth and a sixtieth.
        assert!(leaving(Effect::ExtraPole, 300.0, 0.01));
        assert!(!leaving(Effect::ExtraPole, 150.0, 0.01));
    }

    #[test]
    fn noise_is_no_rival_of_what_closes_the_gap() {
        let rivals = [(Effect::Backlash, -5000.0), (Effect::ColouredNoise, -4990.0)];
        let noise = |gap: f64| weighed(rivals, 900.0, gap).effects[1];
        assert!(noise(0.05) < 0.5 * noise(0.6), "{} {}", noise(0.05), noise(0.6));
    }

    #[test]
    fn a_gain_that_a_search_finds_in_noise_is_nothing() {
        let odds = weighed([(Effect::Backlash, -3.0), (Effect::Creep, 2.0)], 0.0, 1.0);
        assert!(odds.none > 0.5, "{odds:?}");
    }
}
