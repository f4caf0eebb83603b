//! Features of the alternatives: every effect, nothing, and none of these.
//!
//! All are of the order of one, without unit, and the same whatever the effect's name. Candidates are compared one step `ahead`, as
//! simulators identified anew (`simulated`), and as simulators on top of a given model (`fixed`); what was not compared is 0. How much an
//! effect gains in deviance depends on how wrong the model is, which differs from rig to rig; where it stands among the others does not.
//!
//! ```text
//! first_…       1 where ΔBIC is above 10 and above that of every effect of another class, and it degrades no held-out record there
//! margin_…      (ΔBIC − Δ')/max(ΔBIC, Δ', 10), Δ' that of the best of another class, 0 at least; −1 where it harms
//! settling_…    −ln(1 − s), s the share of error saved on the fit records until the model has settled
//! closure_…     share of the gap that it closes on held-out records, from −1 to 1
//! certainty     z/4, z the largest of the shares s in standard errors, from −3 to 8
//! harm          share of the comparisons in which it makes a held-out record worse beyond its error
//! noise, clocked    1 for an effect that changes only what is random; that follows a clock or has a phase of its own in each record
//! predicts      of such noise: gain in held-out log score, nats a sample, from −1 to 3
//! parameters    ln(1 + k), k the parameters that it adds
//! by_rules      probability that rules give to it, where it is their likeliest candidate
//! ```
//!
//! A ΔBIC of 10 is what R. Kass and A. Raftery, "Bayes factors", JASA 90, 1995, call very strong. What moves no simulation settles nothing,
//! closes nothing and has no certainty.
//!
//! Nothing and none of these have a constant each, and the best of the effects that degrade no record there, in `deviance` one step ahead
//! (asinh(ΔBIC/50)/5), and as simulators in `deviance` (asinh(ΔBIC/20)/5), `settling` and `closure` (on top of a given model, where there is
//! one); `left`, the share of its gain in deviance that something else would still gain beside the best effect; `resolved`, whether the
//! held-out records show a gap; `given`, whether a model was; and whether rules say that nothing is missing but parameters (`none_by_rules`), or
//! that none of these is the cause (`unexplained_by_rules`).

use super::choice::Sign;
use crate::comparison::{Compared, Comparison, EffectEvidence};
use crate::effect::Effect;
use crate::horizon::{Horizon, HorizonGain};
use crate::verdict::answer::Status;

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
pub(crate) const OF_EFFECT: [Feature; 17] = [
    feature("first_ahead", "fits best one sample ahead", Sign::NotNegative),
    feature("first_simulated", "fits best in simulation", Sign::NotNegative),
    feature("first_held", "fits best on top of the given model", Sign::NotNegative),
    feature("margin_ahead", "leads one sample ahead", Sign::NotNegative),
    feature("margin_simulated", "leads in simulation", Sign::NotNegative),
    feature("margin_held", "leads on top of the given model", Sign::NotNegative),
    feature("settling_simulated", "saves error over a settling time", Sign::NotNegative),
    feature("settling_held", "the same, on top of the given model", Sign::NotNegative),
    feature("closure_simulated", "closes the gap on held-out records", Sign::NotNegative),
    feature("closure_held", "the same, on top of the given model", Sign::NotNegative),
    feature("certainty", "saves error beyond chance", Sign::NotNegative),
    feature("harm", "harms a held-out record", Sign::NotPositive),
    feature("noise", "changes only what is random", Sign::Any),
    feature("predicts", "of such: predicts held-out noise better", Sign::NotNegative),
    feature("clocked", "follows a clock or a phase of each record", Sign::Any),
    feature("parameters", "has many parameters", Sign::Any),
    feature("by_rules", "is the likeliest by the rules", Sign::NotNegative),
];

/// Features of nothing and of none of these: what all effects together look like.
pub(crate) const OF_ALL: [&str; 10] = [
    "constant",
    "deviance_ahead",
    "deviance_simulated",
    "settling",
    "closure",
    "left",
    "resolved",
    "given",
    "none_by_rules",
    "unexplained_by_rules",
];

/// Coefficients of the whole model: of effects, of nothing, of none of these.
pub(crate) const COEFFICIENTS: usize = OF_EFFECT.len() + 2 * OF_ALL.len();

/// The comparisons in the order of the features, each with the scale of its deviance.
const ANALYSES: [(Comparison, f64); 3] =
    [(Comparison::OneStep, 50.0), (Comparison::Simulation, 20.0), (Comparison::GivenModelFixed, 20.0)];

/// ΔBIC that chance does not give.
const VERY_STRONG: f64 = 10.0;

/// What rules that were tuned by hand say of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct RulesSay {
    /// That nothing is missing but, at the most, other parameters.
    pub nothing: bool,
    /// That the cause is none of the effects.
    pub unexplained: bool,
    /// The effect that they find the likeliest candidate of all, with its probability.
    pub likeliest: Option<(Effect, f64)>,
}

impl RulesSay {
    /// From the status of their verdict.
    pub(crate) fn of(status: Status, likeliest: Option<(Effect, f64)>) -> Self {
        let nothing = matches!(status, Status::None | Status::Refit);
        Self { nothing, unexplained: status == Status::Unexplained, likeliest }
    }
}

/// The alternatives of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Alternatives {
    pub(crate) effects: Vec<Effect>,
    of_effects: Vec<[f64; OF_EFFECT.len()]>,
    of_all: [f64; OF_ALL.len()],
}

impl Alternatives {
    /// Those of what was compared and of what rules say; `excluded` effects are none.
    pub(crate) fn of(evidence: &[Compared], rules: RulesSay, excluded: impl Fn(Effect) -> bool) -> Self {
        let mut analyses = ANALYSES.map(|(comparison, scale)| {
            let compared = evidence.iter().find(|compared| compared.comparison == comparison);
            let effects = compared.map_or_else(Vec::new, |compared| compared.effects.clone());
            Analysis { effects, scale }
        });
        analyses.iter_mut().for_each(|analysis| analysis.effects.retain(|says| !excluded(says.effect)));
        let fitted =
            Effect::ALL.into_iter().filter_map(|effect| Some((effect, of_effect(&analyses, rules, effect)?)));
        let (effects, of_effects): (Vec<Effect>, Vec<_>) = fitted.unzip();
        Self { effects, of_effects, of_all: of_all(evidence, rules, &analyses) }
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

/// What one comparison says of the effects that are candidates, and the scale of its deviance.
struct Analysis {
    effects: Vec<EffectEvidence>,
    scale: f64,
}

impl Analysis {
    fn of(&self, effect: Effect) -> Option<&EffectEvidence> {
        self.effects.iter().find(|says| says.effect == effect)
    }

    fn deviance(&self, delta_bic: f64) -> f64 {
        (delta_bic / self.scale).asinh() / 5.0
    }

    /// ΔBIC of the best effect of another class that degrades no held-out record; 0 at least.
    fn best_beside(&self, effect: Effect) -> f64 {
        let others = self
            .effects
            .iter()
            .filter(|o| o.effect != effect && !effect.confounded_effects().contains(&o.effect));
        others.filter(|o| !o.degrades_validation).map(|other| other.delta_bic).fold(0.0, f64::max)
    }

    /// 1 for the best of its class, where that is before all others.
    fn first(&self, says: &EffectEvidence) -> f64 {
        let least = self.best_beside(says.effect).max(VERY_STRONG);
        if says.delta_bic > least && !says.degrades_validation { 1.0 } else { 0.0 }
    }

    /// How far an effect is before, or behind, the best one of another class.
    fn margin(&self, says: &EffectEvidence) -> f64 {
        if says.degrades_validation {
            return -1.0;
        }
        let other = self.best_beside(says.effect);
        let scale = says.delta_bic.max(other).max(VERY_STRONG);
        ((says.delta_bic - other) / scale).clamp(-1.0, 1.0)
    }

    /// The best in a figure of the effects that harm no held-out record.
    fn best(&self, figure: impl Fn(&EffectEvidence) -> f64) -> f64 {
        self.effects.iter().filter(|says| !says.degrades_validation).map(figure).fold(0.0, f64::max)
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
fn of_effect(analyses: &[Analysis; 3], rules: RulesSay, effect: Effect) -> Option<[f64; OF_EFFECT.len()]> {
    let says = analyses.each_ref().map(|analysis| analysis.of(effect).map(|says| (analysis, says)));
    let all: Vec<&EffectEvidence> = says.iter().flatten().map(|(_, says)| *says).collect();
    let parameters = all.first()?.parameters;
    let of = |figure: fn(&Analysis, &EffectEvidence) -> f64| {
        says.map(|analysis| analysis.map_or(0.0, |(analysis, e)| figure(analysis, e)))
    };
    let [_, settles, settles_fixed] = of(|_, e| moving(e, saved(settling(e))));
    let [_, closes, closes_fixed] = of(|_, e| moving(e, closure(e)));
    let certain = all.iter().filter_map(|e| Some(moving(e, settling(e)?.certainty.clamp(-3.0, 8.0) / 4.0)));
    let is = |is: bool| if is { 1.0 } else { 0.0 };
    let is_noise = is(effect.is_noise());
    let rest = [
        settles,
        settles_fixed,
        closes,
        closes_fixed,
        largest(certain),
        all.iter().filter(|e| e.degrades_validation).count() as f64 / all.len() as f64,
        is_noise,
        is_noise * analyses[0].of(effect).map_or(0.0, |e| e.heldout_log_score.clamp(-1.0, 3.0)),
        is(effect.is_of_its_record()),
        parameters.max(0.0).ln_1p(),
        rules.likeliest.filter(|(likeliest, _)| *likeliest == effect).map_or(0.0, |(_, p)| p),
    ];
    let of_analyses = [of(Analysis::first), of(Analysis::margin)];
    let mut features = [0.0; OF_EFFECT.len()];
    features.iter_mut().zip(of_analyses.into_iter().flatten().chain(rest)).for_each(|(f, x)| *f = x);
    Some(features)
}

/// A figure of simulations, which is 0 of what moves none.
fn moving(says: &EffectEvidence, figure: f64) -> f64 {
    if says.effect.moves_no_simulation() { 0.0 } else { figure }
}

/// The largest of some figures; 0 of none.
fn largest(figures: impl Iterator<Item = f64>) -> f64 {
    figures.reduce(f64::max).unwrap_or_default()
}

/// The features of nothing and of none of these.
fn of_all(evidence: &[Compared], rules: RulesSay, analyses: &[Analysis; 3]) -> [f64; OF_ALL.len()] {
    let [ahead, simulated, fixed] = analyses;
    let is_given = !fixed.effects.is_empty();
    let simulator = if is_given { fixed } else { simulated };
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
        is(rules.nothing),
        is(rules.unexplained),
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

    fn of(evidence: &[Compared]) -> Alternatives {
        Alternatives::of(evidence, RulesSay::default(), |_| false)
    }

    #[test]
    fn features_are_what_their_formulas_say() {
        let ahead = EffectEvidence { closure: Some(0.3), ..says(Effect::Creep, 200.0, 0.4, 6.0) };
        let rival = says(Effect::SensorSaturation, 150.0, 0.4, 6.0);
        let simulated = EffectEvidence { degrades_validation: true, ..says(Effect::Creep, 5.0, 0.6, 2.0) };
        let fixed = EffectEvidence { closure: Some(0.8), ..says(Effect::Creep, 8.0, 0.2, 1.0) };
        let evidence = [
            compared(Comparison::OneStep, vec![ahead, rival]),
            compared(Comparison::Simulation, vec![simulated]),
            compared(Comparison::GivenModelFixed, vec![fixed]),
        ];
        let rules = RulesSay::of(Status::Unexplained, Some((Effect::Creep, 0.4)));
        let alternatives = Alternatives::of(&evidence, rules, |_| false);
        let is = |name: &str, expected: f64| {
            let found = feature(&alternatives, Effect::Creep, name);
            assert!((found - expected).abs() < 1e-12, "{name}: {found}, not {expected}");
        };
        is("first_ahead", 1.0);
        is("margin_ahead", 0.25);
        is("first_simulated", 0.0);
        is("margin_simulated", -1.0);
        // Nothing beside it, and still too little.
        is("first_held", 0.0);
        is("margin_held", 0.8);
        is("settling_simulated", -(0.4_f64).ln());
        is("settling_held", -(0.8_f64).ln());
        is("certainty", 1.5);
        is("closure_held", 0.8);
        is("closure_simulated", 0.0);
        is("harm", 1.0 / 3.0);
        is("noise", 0.0);
        is("parameters", 3_f64.ln());
        is("by_rules", 0.4);
        assert_eq!(feature(&alternatives, Effect::SensorSaturation, "margin_ahead"), -0.25);
        assert_eq!(feature(&alternatives, Effect::SensorSaturation, "by_rules"), 0.0);
        assert_eq!(alternatives.of_all()[8..], [0.0, 1.0]);
    }

    #[test]
    fn only_the_first_of_its_class_is_first_and_a_confounded_does_not_count() {
        let [of_play, of_transition] = [Effect::Backlash, Effect::GradualTransition];
        assert!(of_play.confounded_effects().contains(&of_transition));
        let says = vec![
            says(of_play, 300.0, 0.1, 1.0),
            says(of_transition, 250.0, 0.1, 1.0),
            says(Effect::Stribeck, 100.0, 0.1, 1.0),
        ];
        let alternatives = of(&[compared(Comparison::GivenModelFixed, says)]);
        let reported =
            |effect| ["first_held", "margin_held"].map(|name| feature(&alternatives, effect, name));
        assert_eq!(reported(of_play), [1.0, 2.0 / 3.0]);
        assert_eq!(reported(of_transition), [1.0, 0.6]);
        assert_eq!(reported(Effect::Stribeck), [0.0, -2.0 / 3.0]);
    }

    #[test]
    fn what_moves_no_simulation_says_nothing_of_it() {
        let noise = EffectEvidence {
            closure: Some(-0.5),
            heldout_log_score: 0.3,
            ..says(Effect::Outliers, 500.0, -0.9, -4.0)
        };
        let alternatives = of(&[compared(Comparison::OneStep, vec![noise])]);
        for (name, expected) in [("certainty", 0.0), ("noise", 1.0), ("predicts", 0.3), ("first_ahead", 1.0)]
        {
            assert_eq!(feature(&alternatives, Effect::Outliers, name), expected, "{name}");
        }
    }

    #[test]
    fn what_degrades_validation_is_not_among_the_best_and_what_is_left_out_is_no_alternative() {
        let good = says(Effect::Creep, 100.0, 0.2, 2.0);
        let harming =
            EffectEvidence { degrades_validation: true, ..says(Effect::Backlash, 9000.0, 0.9, 9.0) };
        let colour = says(Effect::ColouredNoise, 50_000.0, 0.0, 0.0);
        let evidence = [compared(Comparison::OneStep, vec![harming, good, colour])];
        let alternatives =
            Alternatives::of(&evidence, RulesSay::default(), |effect| effect == Effect::ColouredNoise);
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
        let alternatives = of(&[compared(Comparison::OneStep, vec![wild])]);
        let features = alternatives.features(Effect::Outliers).expect("a fit");
        assert!(features.iter().all(|x| x.is_finite() && x.abs() < 200.0), "{features:?}");
    }
}
