//! Zero and unit of input and output are matters of the sensors: no verdict depends on them.

use crate::bench::{input, played, record, response, rig, white};
use proptest::prelude::*;
use switchback_diagnose::{Diagnosis, Effect, Figure, Model, NominalModel, Settings, diagnose};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Usage};

/// `signal′ = origin + scale·signal`.
#[derive(Debug, Clone, Copy)]
struct Units {
    origin: f64,
    scale: f64,
}

impl Units {
    fn level(self, x: f64) -> f64 {
        self.origin + self.scale * x
    }

    fn of(self, signal: &[f64]) -> Vec<f64> {
        signal.iter().map(|x| self.level(*x)).collect()
    }
}

/// The same records, and what another simulator predicts of them, by other sensors.
fn seen(rig: &Rig, (of_v, of_y): (Units, Units)) -> Rig {
    let other = |r: &RigRecord| RigRecord {
        record: Record::new(of_v.of(r.record.v()), of_y.of(r.record.y())).expect("finite and equally long"),
        predicted: r.predicted.as_deref().map(|y| of_y.of(y)),
        ..r.clone()
    };
    Rig { records: rig.records.iter().map(other).collect(), ..rig.clone() }
}

/// The same model with another zero and unit on both sides.
fn given(model: &NominalModel, (of_v, of_y): (Units, Units)) -> NominalModel {
    let level = |f: f64| {
        let gain = model.b.iter().sum::<f64>() / (1.0 + model.a.iter().sum::<f64>());
        of_y.scale * f + of_y.origin / gain
    };
    let border = |points: &[(f64, f64)]| points.iter().map(|&(v, f)| (of_v.level(v), level(f))).collect();
    NominalModel {
        descending: border(&model.descending),
        ascending: border(&model.ascending),
        ..model.clone()
    }
}

/// A rig whose input has got a play that its model does not know.
fn worn(order: Option<usize>) -> Rig {
    let worn = |name, usage, samples, phase| {
        let (v, mut white) = (input(samples, phase), white(7));
        let y = response(&played(&v, 0.2), &[-0.6], &mut || 0.01 * white());
        record(name, usage, v, y)
    };
    rig(order, vec![worn("sweep", Usage::Fit, 900, 0.0), worn("drive", Usage::Holdout, 600, 1.0)])
}

fn settings() -> Settings {
    // Some of each stage: all would take minutes.
    let effects = [
        Effect::Backlash,
        Effect::GradualTransition,
        Effect::RateDependence,
        Effect::ExtraPole,
        Effect::ColouredNoise,
        Effect::SensorDrift,
        Effect::SensorNonlinearity,
    ];
    let others: Vec<Effect> = Effect::ALL.into_iter().filter(|e| !effects.contains(e)).collect();
    Settings::default().without(&others)
}

/// To rounding: 1e-9 of the size of what is compared.
#[track_caller]
fn agree(what: &str, found: f64, expected: f64) {
    let both_none = found.is_nan() && expected.is_nan();
    let off = (found - expected).abs();
    assert!(both_none || off <= 1e-9 * expected.abs().max(1e-3), "{what}: {found:e} for {expected:e}");
}

/// Mean squares of errors, as shares of the output's variance: of errors that are known to half of 1e-9 of the output a mean square `m` is known to 1e-9·√m.
#[track_caller]
fn figures(what: &str, found: &Figure, expected: &Figure) {
    let square = |found: f64, expected: f64| {
        let known = 1e-9 * expected.abs().max(1e-3).sqrt();
        assert!((found - expected).abs() <= known, "{what}: {found:e} for {expected:e}");
    };
    square(found.estimate, expected.estimate);
    (0..2).for_each(|k| square(found.ci90[k], expected.ci90[k]));
}

#[track_caller]
fn same(found: &Diagnosis, expected: &Diagnosis, of_y: Units) {
    let (one, other) = (&found.verdict, &expected.verdict);
    assert_eq!((one.status, &one.effects, &one.class), (other.status, &other.effects, &other.class));
    agree("probability", one.probability, other.probability);
    figures("gap", &found.gap.before, &expected.gap.before);
    figures("gap after", &found.gap.after, &expected.gap.after);
    assert_eq!(found.gap.closure.is_some(), expected.gap.closure.is_some());
    if let (Some(one), Some(other)) = (&found.gap.closure, &expected.gap.closure) {
        figures("closure", one, other);
    }
    agree("noise floor", found.gap.noise_floor / of_y.scale, expected.gap.noise_floor);
    assert_eq!(found.candidates.len(), expected.candidates.len());
    for (one, other) in found.candidates.iter().zip(&expected.candidates) {
        assert_eq!(one.effect, other.effect);
        agree("probability of a candidate", one.probability, other.probability);
        agree(
            "its criterion",
            one.delta_bic / expected.samples as f64,
            other.delta_bic / expected.samples as f64,
        );
        agree("its closure", one.closure.unwrap_or(f64::NAN), other.closure.unwrap_or(f64::NAN));
    }
}

fn units(most: f64) -> impl Strategy<Value = Units> {
    let size = (-6.0..6.0f64).prop_map(|x| 10f64.powf(x));
    (size, -most..most).prop_map(|(scale, origin)| Units { origin: origin * scale, scale })
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 0, ..ProptestConfig::with_cases(2) })]

    #[test]
    fn what_an_identified_model_lacks_does_not_depend_on_zero_or_unit(v in units(10.0), y in units(10.0)) {
        for order in [Some(1), None] {
            let rig = worn(order);
            let here = diagnose(&rig, Model::Identify, &settings()).expect("a diagnosis");
            let there = diagnose(&seen(&rig, (v, y)), Model::Identify, &settings()).expect("a diagnosis");
            same(&there, &here, y);
        }
    }

    #[test]
    fn what_a_given_model_lacks_does_not_depend_on_zero_or_unit(v in units(10.0), y in units(10.0)) {
        let rig = worn(Some(1));
        let model = NominalModel {
            a: vec![-0.6],
            b: vec![0.4],
            descending: vec![(-1.0, -1.5), (1.0, 0.5)],
            ascending: vec![(-1.0, -0.5), (1.0, 1.5)],
        };
        let here = diagnose(&rig, Model::Given(model.clone()), &settings()).expect("a diagnosis");
        let other = Model::Given(given(&model, (v, y)));
        let there = diagnose(&seen(&rig, (v, y)), other, &settings()).expect("a diagnosis");
        same(&there, &here, y);
    }
}
