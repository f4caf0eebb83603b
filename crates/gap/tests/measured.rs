//! Measured rigs: what the diagnosis says of them, where they are beside the workspace.

use std::fs;
use std::path::Path;

use switchback_estimator::Record;
use switchback_estimator::rig::{Rig, RigRecord, Role, Usage};
use switchback_gap::{Diagnosis, Effect, Model, Settings, Status, diagnose};

/// Reads the columns `t,v,y` of a file; `None` where it is absent.
fn record(folder: &str, name: &str, usage: Usage) -> Option<RigRecord> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/rigs").join(folder).join(name);
    let text = fs::read_to_string(path.with_extension("csv")).ok()?;
    let column = |k: usize| -> Vec<f64> {
        text.lines()
            .skip(1)
            .map(|line| line.split(',').nth(k).and_then(|cell| cell.parse().ok()).expect("a number"))
            .collect()
    };
    let record = Record::new(column(1), column(2)).expect("a record");
    Some(RigRecord { name: name.into(), role: Role::Free, usage, record, predicted: None })
}

/// Diagnoses a measured rig; says so and gives nothing where it is absent.
fn diagnosed(folder: &str, sample_time: f64, fit: &[&str], held_out: &str) -> Option<Diagnosis> {
    let names = fit.iter().map(|name| (*name, Usage::Fit)).chain([(held_out, Usage::Holdout)]);
    let records: Option<Vec<RigRecord>> = names.map(|(name, usage)| record(folder, name, usage)).collect();
    let Some(records) = records else {
        println!("skipped: no measured rig {folder} in shared/rigs beside the workspace");
        return None;
    };
    let rig = Rig {
        name: folder.into(),
        sample_time,
        order: None,
        interval: None,
        input_label: "v".into(),
        output_label: "y".into(),
        records,
    };
    let diagnosis = diagnose(&rig, Model::Identify, &Settings::default()).expect("a diagnosis");
    println!("{folder}: {:?}\n{:?}", diagnosis.verdict, diagnosis.gap);
    Some(diagnosis)
}

fn closure(diagnosis: &Diagnosis) -> [f64; 2] {
    diagnosis.gap.closure.expect("a resolvable gap").ci90
}

#[test]
fn a_loop_that_closes_without_a_jump_points_at_the_reversals() {
    let fit = ["sine", "amplitude_sweep"];
    let Some(found) = diagnosed("piezo-stage", 0.005, &fit, "amplitude_sweep_again") else { return };
    let verdict = &found.verdict;
    let leading = verdict.effects.first().or(verdict.class.first()).expect("a cause");
    assert!([Effect::GradualTransition, Effect::Backlash].contains(leading), "{verdict:?}");
    assert!(closure(&found)[0] > 0.4, "{:?}", found.gap);
    assert!(found.gap.per_record[0].fit_after > 94.0, "{:?}", found.gap);
}

#[test]
fn the_damper_lacks_an_effect_of_speed() {
    let Some(found) = diagnosed("mr-damper", 0.004, &["sweep_up"], "sweep_down") else { return };
    let leading = found.verdict.effects.first().or(found.verdict.class.first());
    let speed = [Effect::RateDependence, Effect::Stribeck];
    assert!(leading.is_some_and(|e| speed.contains(e)), "{:?}", found.verdict);
    assert!(closure(&found)[0] > 0.5, "{:?}", found.gap);
    // The floor lies below what the best model misses: it is no more than noise.
    let force = 1_000.0;
    assert!(found.gap.noise_floor < 0.2 * force, "{:?}", found.gap);
}

#[test]
fn the_seal_is_nearly_what_the_model_says() {
    let Some(found) = diagnosed("pneumatic-seal", 0.01, &["first"], "second") else { return };
    assert!(found.gap.per_record[0].fit_before > 93.0, "{:?}", found.gap);
    assert!(found.gap.before.estimate < 0.005, "{:?}", found.gap);
    // A little is left, of no candidate's making; no closure is claimed that the held-out record does not show.
    assert_eq!(found.verdict.status, Status::Unexplained);
    assert!(found.gap.after.estimate <= found.gap.before.estimate);
}
