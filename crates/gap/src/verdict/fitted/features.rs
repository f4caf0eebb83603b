//! Features of the alternatives: every effect, nothing, and none of these.
//!
//! All are of the order of one, without unit, and the same whatever the effect's name. Explanations are compared one step `ahead`, as
//! simulators identified anew (`simulated`), and as simulators on top of a given model (`held`); what was not compared is 0.
//!
//! ```text
//! deviance_…    asinh(ΔBIC/50)/5 one step ahead, asinh(ΔBIC/20)/5 of simulators
//! lead_…        the same of ΔBIC less that of the best effect of another class, where that is positive
//! settling_…    −ln(1 − s), s the share of error saved on the fit records until the model has settled
//! closure_…     share of the gap that it closes on held-out records, from −1 to 1
//! certainty     z/4, z the largest of the shares s in standard errors, from −3 to 8
//! step          −ln(1 − s) one step ahead, beside the colour of the errors
//! harm          share of the ways in which it makes a held-out record worse beyond its error
//! noise, clocked    1 for an effect that changes only what is random; that follows a clock or has a phase of its own in each record
//! predicts      of such noise: gain in held-out log score, nats a sample, from −1 to 3
//! parameters    ln(1 + k), k the parameters that it adds
//! ```
//!
//! Nothing and none of these have a constant each, and the best of the effects that harm no record in that way in `deviance` one step ahead, and
//! as simulators in `deviance`, `settling` and `closure` (on top of a given model, where there is one); `left`, the share of its gain in
//! deviance that something else would still gain beside the best effect; `resolved`, whether the held-out records show a gap; and `given`,
//! whether a model was.

use super::choice::Sign;
use crate::diagnosis::{Horizon, HorizonGain};
use crate::effect::Effect;
use crate::evidence::{Compared, Comparison, EffectEvidence};

/// A feature of an effect.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Feature {
    pub(crate) name: &'static str,
    pub(crate) words: &'static str,
    /// What its coefficient may be.
    pub(crate) sign: Sign,
}

const fn feature(name: &'static str, words: &'static str, sign: Sign) -> Feature {
    Feature { name, words, sign }
}

/// Features of an effect.
pub(crate) const OF_EFFECT: [Feature; 19] = [
    feature("deviance_ahead", "fits better one sample ahead", Sign::NotNegative),
    feature("deviance_simulated", "fits better in simulation", Sign::NotNegative),
    feature("deviance_held", "fits better on top of the given model", Sign::NotNegative),
    feature("lead_ahead", "leads one sample ahead", Sign::NotNegative),
    feature("lead_simulated", "leads in simulation", Sign::NotNegative),
    feature("lead_held", "leads on top of the given model", Sign::NotNegative),
    feature("settling_ahead", "saves error over a settling time", Sign::NotNegative),
    feature("settling_simulated", "the same, fitted as a simulator", Sign::NotNegative),
    feature("settling_held", "the same, on top of the given model", Sign::NotNegative),
    feature("closure_ahead", "closes the gap on held-out records", Sign::NotNegative),
    feature("closure_simulated", "the same, fitted as a simulator", Sign::NotNegative),
    feature("closure_held", "the same, on top of the given model", Sign::NotNegative),
    feature("certainty", "saves error beyond chance", Sign::NotNegative),
    feature("step", "saves error one sample ahead", Sign::NotNegative),
    feature("harm", "harms a held-out record", Sign::NotPositive),
    feature("noise", "changes only what is random", Sign::Any),
    feature("predicts", "of such: predicts held-out noise better", Sign::NotNegative),
    feature("clocked", "follows a clock or a phase of each record", Sign::Any),
    feature("parameters", "has many parameters", Sign::Any),
];

/// Features of nothing and of none of these: what all effects together look like.
pub(crate) const OF_ALL: [&str; 8] =
    ["constant", "deviance_ahead", "deviance_simulated", "settling", "closure", "left", "resolved", "given"];

/// Coefficients of the whole model: of effects, of nothing, of none of these.
pub(crate) const COEFFICIENTS: usize = OF_EFFECT.len() + 2 * OF_ALL.len();

/// The ways of comparing in the order of the features, each with the scale of its deviance.
const WAYS: [(Comparison, f64); 3] =
    [(Comparison::OneStep, 50.0), (Comparison::Simulation, 20.0), (Comparison::GivenModelHeld, 20.0)];

/// The alternatives of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Alternatives {
    pub(crate) effects: Vec<Effect>,
    of_effects: Vec<[f64; OF_EFFECT.len()]>,
    of_all: [f64; OF_ALL.len()],
}

impl Alternatives {
    /// Those of what was compared; `excluded` effects are none.
    pub(crate) fn of(evidence: &[Compared], excluded: impl Fn(Effect) -> bool) -> Self {
        let mut ways = WAYS.map(|(comparison, scale)| {
            let compared = evidence.iter().find(|compared| compared.comparison == comparison);
            let effects = compared.map_or_else(Vec::new, |compared| compared.effects.clone());
            Way { effects, scale }
        });
        ways.iter_mut().for_each(|way| way.effects.retain(|says| !excluded(says.effect)));
        let fitted = Effect::ALL.into_iter().filter_map(|effect| Some((effect, of_effect(&ways, effect)?)));
        let (effects, of_effects): (Vec<Effect>, Vec<_>) = fitted.unzip();
        Self { effects, of_effects, of_all: of_all(evidence, &ways) }
    }

    /// Features of the effects, of nothing and of none of these, in the coordinates of the coefficients.
    pub(crate) fn rows(&self) -> Vec<Vec<f64>> {
        let row = |at: usize, features: &[f64]| {
            let mut row = vec![0.0; COEFFICIENTS];
            row[at..at + features.len()].copy_from_slice(features);
            row
        };
        let (effects, all) = (OF_EFFECT.len(), OF_ALL.len());
        let whole = [effects, effects + all].map(|at| row(at, &self.of_all));
        self.of_effects.iter().map(|features| row(0, features)).chain(whole).collect()
    }

    pub(crate) fn of_effects(&self) -> &[[f64; OF_EFFECT.len()]] {
        &self.of_effects
    }

    pub(crate) fn of_all(&self) -> &[f64; OF_ALL.len()] {
        &self.of_all
    }

    /// The features of one of the effects, in the order of [`OF_EFFECT`].
    pub(crate) fn features(&self, effect: Effect) -> Option<&[f64; OF_EFFECT.len()]> {
        self.effects.iter().position(|known| *known == effect).map(|k| &self.of_effects[k])
    }
}

/// What one way of comparing says of the effects that are candidates, and the scale of its deviance.
struct Way {
    effects: Vec<EffectEvidence>,
    scale: f64,
}

impl Way {
    fn of(&self, effect: Effect) -> Option<&EffectEvidence> {
        self.effects.iter().find(|says| says.effect == effect)
    }

    fn deviance(&self, delta_bic: f64) -> f64 {
        (delta_bic / self.scale).asinh() / 5.0
    }

    /// How far an effect is before the best one of another class.
    fn lead(&self, says: &EffectEvidence) -> f64 {
        let twins = says.effect.twins();
        let others = self.effects.iter().filter(|o| o.effect != says.effect && !twins.contains(&o.effect));
        let best = others.map(|other| other.delta_bic).fold(0.0, f64::max);
        self.deviance((says.delta_bic - best).max(0.0))
    }

    /// The best in a figure of the effects that harm no held-out record.
    fn best(&self, figure: impl Fn(&EffectEvidence) -> f64) -> f64 {
        self.effects.iter().filter(|says| !says.harms).map(figure).fold(0.0, f64::max)
    }
}

/// `−ln(1 − s)` of a share saved.
fn saved(gain: Option<HorizonGain>) -> f64 {
    gain.map_or(0.0, |gain| -(1.0 - gain.share.clamp(-1.0, 0.99)).ln())
}

fn at(says: &EffectEvidence, is_it: impl Fn(Horizon) -> bool) -> Option<HorizonGain> {
    says.gains.iter().copied().rfind(|gain| is_it(gain.horizon))
}

/// What an effect gains until the model has settled, or over whole records, where these are shorter.
fn settling(says: &EffectEvidence) -> Option<HorizonGain> {
    at(says, |h| matches!(h, Horizon::Samples(_))).or_else(|| at(says, |h| h == Horizon::FreeRun))
}

fn closure(says: &EffectEvidence) -> f64 {
    says.closure.unwrap_or_default().clamp(-1.0, 1.0)
}

/// The features of an effect; none without a fit.
fn of_effect(ways: &[Way; 3], effect: Effect) -> Option<[f64; OF_EFFECT.len()]> {
    let says = ways.each_ref().map(|way| way.of(effect).map(|says| (way, says)));
    let all: Vec<&EffectEvidence> = says.iter().flatten().map(|(_, says)| *says).collect();
    let first = all.first()?;
    let ahead = ways[0].of(effect);
    let of =
        |figure: fn(&Way, &EffectEvidence) -> f64| says.map(|way| way.map_or(0.0, |(way, e)| figure(way, e)));
    let certain = all.iter().filter_map(|e| settling(e)).map(|gain| gain.certainty.clamp(-3.0, 8.0) / 4.0);
    let steps = all.iter().map(|e| saved(at(e, |h| h == Horizon::Step)));
    let is_noise = if effect.is_noise() { 1.0 } else { 0.0 };
    let of_ways = [
        of(|way, e| way.deviance(e.delta_bic)),
        of(Way::lead),
        of(|_, e| saved(settling(e))),
        of(|_, e| closure(e)),
    ];
    let rest = [
        largest(certain),
        largest(steps),
        all.iter().filter(|e| e.harms).count() as f64 / all.len() as f64,
        is_noise,
        is_noise * ahead.map_or(0.0, |e| e.heldout_log_score.clamp(-1.0, 3.0)),
        if effect.is_of_its_record() { 1.0 } else { 0.0 },
        first.parameters.max(0.0).ln_1p(),
    ];
    let mut features = [0.0; OF_EFFECT.len()];
    features.iter_mut().zip(of_ways.into_iter().flatten().chain(rest)).for_each(|(f, x)| *f = x);
    Some(features)
}

/// The largest of some figures; 0 of none.
fn largest(figures: impl Iterator<Item = f64>) -> f64 {
    figures.reduce(f64::max).unwrap_or_default()
}

/// The features of nothing and of none of these.
fn of_all(evidence: &[Compared], ways: &[Way; 3]) -> [f64; OF_ALL.len()] {
    let [ahead, simulated, held] = ways;
    let is_given = !held.effects.is_empty();
    let simulator = if is_given { held } else { simulated };
    let both = |figure: fn(&EffectEvidence) -> f64| ahead.best(figure).max(simulator.best(figure));
    let first =
        evidence.iter().find(|compared| compared.comparison == Comparison::OneStep).or(evidence.first());
    let left = first.map_or(0.0, |compared| {
        let gained = compared.effects.iter().map(|e| e.delta_bic).fold(1.0, f64::max);
        compared.left_by_best / (compared.left_by_best + gained)
    });
    let is = |is: bool| if is { 1.0 } else { 0.0 };
    [
        1.0,
        ahead.best(|e| ahead.deviance(e.delta_bic)),
        simulator.best(|e| simulator.deviance(e.delta_bic)),
        both(|e| saved(settling(e))),
        both(closure),
        left.clamp(0.0, 1.0),
        is(evidence.iter().any(|compared| compared.gap[0] > 0.0)),
        is(is_given),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::examples::{compared, says};
    use super::*;

    fn feature(alternatives: &Alternatives, effect: Effect, name: &str) -> f64 {
        let place = OF_EFFECT.iter().position(|feature| feature.name == name).expect("a feature");
        alternatives.features(effect).expect("a fit")[place]
    }

    #[test]
    fn features_are_what_their_formulas_say() {
        let ahead = EffectEvidence { closure: Some(0.3), ..says(Effect::Creep, 200.0, 0.4, 6.0) };
        let simulated = EffectEvidence { harms: true, ..says(Effect::Creep, 5.0, 0.6, 2.0) };
        let evidence =
            [compared(Comparison::OneStep, vec![ahead]), compared(Comparison::Simulation, vec![simulated])];
        let alternatives = Alternatives::of(&evidence, |_| false);
        let is = |name: &str, expected: f64| {
            let found = feature(&alternatives, Effect::Creep, name);
            assert!((found - expected).abs() < 1e-12, "{name}: {found}, not {expected}");
        };
        is("deviance_ahead", 4_f64.asinh() / 5.0);
        is("deviance_simulated", 0.25_f64.asinh() / 5.0);
        is("lead_ahead", 4_f64.asinh() / 5.0);
        is("settling_ahead", -(0.6_f64).ln());
        is("settling_simulated", -(0.4_f64).ln());
        is("settling_held", 0.0);
        is("certainty", 1.5);
        is("closure_ahead", 0.3);
        is("closure_simulated", 0.0);
        is("harm", 0.5);
        is("noise", 0.0);
        is("parameters", 3_f64.ln());
    }

    #[test]
    fn only_the_first_of_its_class_leads_and_a_twin_does_not_count() {
        let [of_play, of_transition] = [Effect::Backlash, Effect::GradualTransition];
        assert!(of_play.twins().contains(&of_transition));
        let says = vec![
            says(of_play, 300.0, 0.1, 1.0),
            says(of_transition, 250.0, 0.1, 1.0),
            says(Effect::Stribeck, 100.0, 0.1, 1.0),
        ];
        let alternatives = Alternatives::of(&[compared(Comparison::GivenModelHeld, says)], |_| false);
        let lead = |effect| feature(&alternatives, effect, "lead_held");
        assert!((lead(of_play) - 10_f64.asinh() / 5.0).abs() < 1e-12);
        assert!((lead(of_transition) - 7.5_f64.asinh() / 5.0).abs() < 1e-12);
        assert_eq!(lead(Effect::Stribeck), 0.0);
    }

    #[test]
    fn what_harms_is_not_among_the_best_and_what_is_left_out_is_no_alternative() {
        let good = says(Effect::Creep, 100.0, 0.2, 2.0);
        let harming = EffectEvidence { harms: true, ..says(Effect::Backlash, 9000.0, 0.9, 9.0) };
        let colour = says(Effect::ColouredNoise, 50_000.0, 0.0, 0.0);
        let evidence = [compared(Comparison::OneStep, vec![harming, good, colour])];
        let alternatives = Alternatives::of(&evidence, |effect| effect == Effect::ColouredNoise);
        assert_eq!(alternatives.effects.len(), 2);
        let best = alternatives.of_all()[1];
        assert!((best - 2_f64.asinh() / 5.0).abs() < 1e-12);
        // Coordinates: effects first, then what speaks for nothing, then for none of these.
        let rows = alternatives.rows();
        assert_eq!((rows.len(), rows[0].len()), (4, COEFFICIENTS));
        assert!(rows[0][OF_EFFECT.len()..].iter().all(|x| *x == 0.0));
        assert_eq!(rows[2][OF_EFFECT.len()], 1.0);
        assert_eq!(rows[3][OF_EFFECT.len() + OF_ALL.len()], 1.0);
    }

    #[test]
    fn figures_without_bound_are_bounded() {
        let wild = EffectEvidence {
            closure: Some(-1e9),
            heldout_log_score: f64::from(f32::MIN),
            ..says(Effect::Outliers, 1e300, f64::NEG_INFINITY, f64::from(f32::MIN))
        };
        let alternatives = Alternatives::of(&[compared(Comparison::OneStep, vec![wild])], |_| false);
        let features = alternatives.features(Effect::Outliers).expect("a fit");
        assert!(features.iter().all(|x| x.is_finite() && x.abs() < 200.0), "{features:?}");
    }
}
