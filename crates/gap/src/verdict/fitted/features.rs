//! Features of the alternatives: every effect, nothing, and none of these.
//!
//! All are of the order of one, without unit, and the same whatever the effect's name. Where explanations were compared in several ways an
//! effect has the best of what these say of it, and harms as far as they agree.
//!
//! ```text
//! deviance_ahead        asinh(ΔBIC/50)/5, compared one step ahead; 0 where that was not done
//! deviance_simulated    asinh(ΔBIC/20)/5, compared as simulators
//! settling, free_run    −ln(1 − s), s the share of error saved on the fit records until the model has settled, and over whole records
//! certainty             z/4, z the first of these in standard errors
//! ahead                 −ln(1 − s) one step ahead, beside the colour of the errors
//! closure               share of the gap that it closes on held-out records, from −1 to 1
//! harm                  share of the ways in which it makes a held-out record worse beyond its error
//! noise, clocked        1 for an effect that changes only what is random, that follows a clock or has a phase of its own in each record
//! predicts              of such noise: gain in held-out log score, nats a sample, from −1 to 3
//! parameters            ln(1 + k), k the parameters that it adds
//! ```
//!
//! Nothing and none of these have a constant each, and the best of the effects in `deviance_ahead`, `deviance_simulated`, `settling` and
//! `closure` that harms no record beyond its error; `left`, the share of its gain in deviance that something else would still gain beside
//! the best effect, and `resolved`, whether the held-out records show a gap.

use super::choice::Sign;
use crate::diagnosis::{Horizon, HorizonGain};
use crate::effect::Effect;
use crate::evidence::{Compared, Comparison, EffectEvidence};

/// Features of an effect, with the sign that a coefficient may have.
pub(crate) const OF_EFFECT: [(&str, Sign); 12] = [
    ("deviance_ahead", Sign::NotNegative),
    ("deviance_simulated", Sign::NotNegative),
    ("settling", Sign::NotNegative),
    ("certainty", Sign::NotNegative),
    ("free_run", Sign::NotNegative),
    ("closure", Sign::NotNegative),
    ("harm", Sign::NotPositive),
    ("noise", Sign::Any),
    ("predicts", Sign::NotNegative),
    ("clocked", Sign::Any),
    ("parameters", Sign::Any),
    ("ahead", Sign::NotNegative),
];

/// Features of nothing and of none of these: what all effects together look like.
pub(crate) const OF_ALL: [&str; 7] =
    ["constant", "deviance_ahead", "deviance_simulated", "settling", "closure", "left", "resolved"];

/// Coefficients of the whole model: of effects, of nothing, of none of these.
pub(crate) const COEFFICIENTS: usize = OF_EFFECT.len() + 2 * OF_ALL.len();

/// Share of the ways of comparing that an effect may harm in and still count among the best.
const HARMLESS: f64 = 0.5;

/// Where a feature of an effect is.
fn place(name: &str) -> usize {
    OF_EFFECT.iter().position(|(known, _)| *known == name).unwrap_or_default()
}

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
        let every = Effect::ALL.into_iter().filter(|effect| !excluded(*effect));
        let (effects, of_effects) = every.filter_map(|effect| Some((effect, of_effect(evidence, effect)?))).unzip();
        let of_all = of_all(evidence, &of_effects);
        Self { effects, of_effects, of_all }
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

    /// The features of one of the effects, in the order of [`OF_EFFECT`].
    pub(crate) fn features(&self, effect: Effect) -> Option<&[f64; OF_EFFECT.len()]> {
        self.effects.iter().position(|known| *known == effect).map(|k| &self.of_effects[k])
    }
}

fn asinh(x: f64, scale: f64) -> f64 {
    (x / scale).asinh() / 5.0
}

/// `−ln(1 − s)` of a share saved.
fn saved(share: f64) -> f64 {
    -(1.0 - share.clamp(-1.0, 0.99)).ln()
}

/// The largest of some figures; 0 of none.
fn most(figures: impl Iterator<Item = f64>) -> f64 {
    figures.fold(None, |most: Option<f64>, x| Some(most.map_or(x, |m| m.max(x)))).unwrap_or_default()
}

/// What an effect gains over whole records, or until the model has settled, where that is sooner.
fn at(gains: &[HorizonGain], is_it: impl Fn(Horizon) -> bool) -> Option<&HorizonGain> {
    gains.iter().rfind(|gain| is_it(gain.horizon))
}

/// The features of an effect; none without a fit.
fn of_effect(evidence: &[Compared], effect: Effect) -> Option<[f64; OF_EFFECT.len()]> {
    let said = |compared: &&Compared| compared.effects.iter().find(|says| says.effect == effect).cloned();
    let says: Vec<(Comparison, EffectEvidence)> =
        evidence.iter().filter_map(|compared| Some((compared.comparison, said(&compared)?))).collect();
    let ahead = says.iter().find(|(comparison, _)| *comparison == Comparison::OneStep).map(|(_, e)| e);
    // On top of a given model, where there is one.
    let held = says.iter().find(|(comparison, _)| *comparison == Comparison::GivenModelHeld);
    let simulated = held.or_else(|| says.iter().find(|(comparison, _)| *comparison == Comparison::Simulation));
    let simulated = simulated.map(|(_, e)| e);
    let both: Vec<&EffectEvidence> = ahead.into_iter().chain(simulated).collect();
    let first = both.first()?;
    let free = |e: &EffectEvidence| at(&e.gains, |h| h == Horizon::FreeRun).copied();
    let settling = |e: &EffectEvidence| {
        at(&e.gains, |h| matches!(h, Horizon::Samples(_))).copied().or_else(|| free(e))
    };
    let step = |e: &EffectEvidence| at(&e.gains, |h| h == Horizon::Step).copied();
    let share = |of: &dyn Fn(&EffectEvidence) -> Option<HorizonGain>| {
        most(both.iter().map(|e| of(e).map_or(0.0, |gain| saved(gain.share))))
    };
    let certain = |e: &EffectEvidence| settling(e).map_or(0.0, |gain| gain.certainty.clamp(-3.0, 8.0) / 4.0);
    let is_noise = f64::from(u8::from(effect.is_noise()));
    let mut features = [0.0; OF_EFFECT.len()];
    let mut set = |name: &str, value: f64| features[place(name)] = value;
    set("deviance_ahead", ahead.map_or(0.0, |e| asinh(e.delta_bic, 50.0)));
    set("deviance_simulated", simulated.map_or(0.0, |e| asinh(e.delta_bic, 20.0)));
    set("settling", share(&settling));
    set("certainty", most(both.iter().map(|e| certain(e))));
    set("free_run", share(&free));
    set("closure", most(both.iter().map(|e| e.closure.unwrap_or_default().clamp(-1.0, 1.0))));
    set("harm", both.iter().filter(|e| e.harms).count() as f64 / both.len() as f64);
    set("noise", is_noise);
    set("predicts", is_noise * ahead.map_or(0.0, |e| e.heldout_log_score.clamp(-1.0, 3.0)));
    set("clocked", f64::from(u8::from(effect.is_of_its_record())));
    set("parameters", first.parameters.max(0.0).ln_1p());
    set("ahead", share(&step));
    Some(features)
}

/// The features of nothing and of none of these.
fn of_all(evidence: &[Compared], of_effects: &[[f64; OF_EFFECT.len()]]) -> [f64; OF_ALL.len()] {
    let harmless = || of_effects.iter().filter(|features| features[place("harm")] <= HARMLESS);
    let best = |name: &str| most(harmless().map(|features| features[place(name)]).chain([0.0]));
    let first = evidence
        .iter()
        .find(|compared| compared.comparison == Comparison::OneStep)
        .or_else(|| evidence.first());
    let left = first.map_or(0.0, |compared| {
        let gained = most(compared.effects.iter().map(|e| e.delta_bic));
        compared.left_by_best / (compared.left_by_best + gained.max(1.0))
    });
    let resolved = evidence.iter().any(|compared| compared.gap[0] > 0.0);
    [
        1.0,
        best("deviance_ahead"),
        best("deviance_simulated"),
        best("settling"),
        best("closure"),
        left.clamp(0.0, 1.0),
        f64::from(u8::from(resolved)),
    ]
}
