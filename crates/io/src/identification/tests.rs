//! Every reservation of the runner: a rig made so that it must be reported, and one where it must not.

use super::examine::refuse_useless;
use super::{Baseline, Examination, Flag, FreeRun, Identification, IdentificationError, Method, Request};
use super::{examined, identify, json, residuals, table};
use switchback_identify::Estimate;
use switchback_model::Record;
use switchback_model::linear::filter;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// White noise of unit variance that needs no generator.
fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
}

fn record(name: &str, role: Role, usage: Usage, v: Vec<f64>, y: Vec<f64>) -> RigRecord {
    let record = Record::new(v, y).expect("finite");
    RigRecord { name: name.to_owned(), role, usage, record, predicted: None }
}

fn rig(records: Vec<RigRecord>) -> Rig {
    Rig {
        name: "bench".to_owned(),
        sample_time: 0.01,
        order: Some(1),
        interval: None,
        input_label: "stroke [mm]".to_owned(),
        output_label: "force [N]".to_owned(),
        records,
    }
}

const SAMPLES: usize = 1200;

/// A rig of one held-out record, or of one to fit, that measured a slow wave.
fn wave(usage: Usage) -> Rig {
    let v: Vec<f64> = (0..SAMPLES).map(|t| (0.05 * t as f64).sin()).collect();
    let y = v.iter().map(|v| 3.0 * v).collect();
    rig(vec![record("wave", Role::Free, usage, v, y)])
}

/// An identification whose free run misses the only record by `errors`; its `a₁` is −0.9.
fn missing_by(rig: &Rig, method: Method, errors: &[f64]) -> Identification {
    let y = rig.records[0].record.y();
    let simulated = y.iter().zip(errors).map(|(y, e)| y - e).collect();
    let estimate = Estimate {
        a: vec![-0.9],
        a_se: vec![0.01],
        b: vec![1.0],
        b_se: vec![0.01],
        delay: 0,
        noise_sd: 1.0,
        gain: 10.0,
        y_high: 3.0,
        y_low: -3.0,
        descending: Vec::new(),
        ascending: Vec::new(),
        excitation: 1.0,
        samples: SAMPLES,
    };
    let runs = vec![Some(FreeRun::new(y, simulated, 1))];
    let (flags, obstacles, examination) = (Vec::new(), Vec::new(), Examination::default());
    Identification {
        method,
        estimate,
        model: None,
        level_errors: None,
        runs,
        distance: None,
        input_noise: None,
        obstacles,
        flags,
        examination,
    }
}

fn scaled(x: &[f64], by: f64) -> Vec<f64> {
    x.iter().map(|x| by * x).collect()
}

#[test]
fn a_simpler_model_is_preferred_where_it_simulates_better_and_only_there() {
    let rig = wave(Usage::Holdout);
    let flag = |own: &[f64], other: &[f64]| {
        let own = missing_by(&rig, Method::Free, own);
        let other = missing_by(&rig, Method::Memoryless, other);
        Baseline::of(&rig, &own, &other).expect("a held-out record").flag(Method::Free)
    };
    let (small, large) = (scaled(&noise(1, SAMPLES), 0.2), scaled(&noise(2, SAMPLES), 0.3));
    let reported = flag(&large, &small).expect("worse");
    assert_eq!(reported.kind, "worse_than_yardstick");
    assert!(
        reported.text.contains("prefer `--method memoryless`") && reported.figure.expect("points") < -3.0,
        "{}",
        reported.text
    );
    assert_eq!(flag(&small, &large), None);
    // The same size of error: one of the two is a little ahead, by chance.
    let as_large = scaled(&noise(3, SAMPLES), 0.2);
    let reported =
        [flag(&small, &as_large), flag(&as_large, &small)].into_iter().flatten().collect::<Vec<Flag>>();
    assert_eq!(reported.len(), 1);
    assert_eq!(reported[0].kind, "no_better_than_yardstick");
}

#[test]
fn innovations_are_coloured_only_if_neither_kind_of_noise_explains_them() {
    let rig = wave(Usage::Fit);
    let reported = |errors: &[f64]| {
        let found = missing_by(&rig, Method::Free, errors);
        residuals::innovations(&rig, &found).as_ref().and_then(residuals::colour)
    };
    let white = noise(4, SAMPLES);
    assert_eq!(reported(&white), None);
    let through_a = filter(&[-0.9], &[], &vec![0.0; SAMPLES], &white, 0.0, 0.0);
    assert_eq!(reported(&through_a), None);
    let slow: Vec<f64> = (0..SAMPLES).map(|t| 5.0 * (0.2 * t as f64).sin() + white[t]).collect();
    let flag = reported(&slow).expect("a wave is predicted");
    assert_eq!(flag.kind, "coloured_innovations");
    assert!(flag.figure.expect("a share") > 0.26 && flag.text.contains("switchback gap"), "{flag:?}");
}

#[test]
fn a_free_run_further_off_than_the_mean_is_useless_and_a_result_of_such_runs_is_refused() {
    let rig = wave(Usage::Holdout);
    let reported = |errors: &[f64]| {
        let found = missing_by(&rig, Method::Free, errors);
        let useless = residuals::worse_than_the_mean(&rig, &found);
        (refuse_useless(&rig, &found, &useless), useless)
    };
    let (outcome, flags) = reported(&scaled(rig.records[0].record.y(), 2.0));
    assert_eq!(flags[0].kind, "free_run_useless");
    assert!((flags[0].figure.expect("a fit") + 100.0).abs() < 1.0);
    assert!(matches!(outcome, Err(IdentificationError::Useless { .. })));
    let (outcome, flags) = reported(&scaled(&noise(5, SAMPLES), 0.5));
    assert!(outcome.is_ok() && flags.is_empty());
}

#[test]
fn a_record_that_only_holds_noise_is_not_held_against_the_model() {
    let y = noise(6, SAMPLES);
    let v = (0..SAMPLES).map(|t| f64::from(u8::from(t > 0))).collect();
    let rig = rig(vec![record("step", Role::StepHigh, Usage::Fit, v, y.clone())]);
    let off_by_a_little: Vec<f64> = y.iter().map(|y| y - 0.03).collect();
    assert_eq!(
        residuals::worse_than_the_mean(&rig, &missing_by(&rig, Method::Efficient, &off_by_a_little)),
        []
    );
}

/// A first-order machine on borders `0.3v ∓ play`, from `v`.
fn machine(v: &[f64], pole: f64, play: f64, seed: u64) -> Vec<f64> {
    let (mut u, mut y, w) = (0.0, vec![0.0; v.len()], noise(seed, v.len()));
    for t in 1..v.len() {
        y[t] = pole * y[t - 1] + u + 0.01 * w[t];
        u = match v[t].total_cmp(&v[t - 1]) {
            std::cmp::Ordering::Greater => 0.3 * v[t] + play,
            std::cmp::Ordering::Less => 0.3 * v[t] - play,
            std::cmp::Ordering::Equal => u,
        };
    }
    y
}

/// The pulse experiment of a satellite at ±1.
fn pulses(satellite: f64, periods: usize) -> Vec<f64> {
    let phase = |k: usize| match k % 14 {
        4 => -satellite,
        8 => -0.5 * satellite,
        10 => 0.0,
        12 => 0.5 * satellite,
        _ => satellite,
    };
    std::iter::once(-satellite).chain((0..14 * periods).map(phase)).collect()
}

/// Both pulse experiments on a machine.
fn designed(pole: f64, play: f64, periods: usize) -> Rig {
    let one = |name, role, satellite: f64, seed| {
        let v = pulses(satellite, periods);
        let y = machine(&v, pole, play, seed);
        record(name, role, Usage::Fit, v, y)
    };
    rig(vec![one("down", Role::Descendant, 1.0, 11), one("up", Role::Ascendant, -1.0, 12)])
}

fn kinds(found: &Identification) -> Vec<&str> {
    found.flags.iter().map(|flag| flag.kind).collect()
}

#[test]
fn a_designed_experiment_shows_a_loop_from_one_curve() {
    let found = |play| identify(&designed(0.5, play, 60), Method::Efficient).expect("identified");
    assert_eq!(kinds(&found(0.0)), ["loop_vanished"]);
    assert_eq!(kinds(&found(0.2)), [""; 0]);
}

#[test]
fn an_unstable_estimate_is_refused_since_every_free_run_diverges() {
    let refused = identify(&designed(1.02, 0.2, 20), Method::Efficient).expect_err("refused").to_string();
    assert!(refused.contains("unstable") && refused.contains("every free run diverges"), "{refused}");
    assert!(identify(&designed(0.98, 0.2, 20), Method::Efficient).is_ok());
}

/// A free rig of which the output answers one sample before the input shows, or does not.
fn free(ahead: usize) -> Rig {
    let wave = |t: f64| 0.6 * (0.11 * t).sin() + 0.3 * (0.0931 * t + 1.0).sin();
    let one = |name, usage, from: f64, seed| {
        let v: Vec<f64> = (0..700).map(|t| wave(from + f64::from(t))).collect();
        let y = machine(&v, 0.4, 0.2, seed);
        record(name, Role::Free, usage, v[..700 - ahead].to_vec(), y[ahead..].to_vec())
    };
    rig(vec![one("first", Usage::Fit, 0.0, 21), one("second", Usage::Holdout, 900.0, 22)])
}

#[test]
fn a_model_that_looks_ahead_is_reported_with_the_price_of_real_time() {
    let request = |causal| Request { method: Method::Free, causal };
    let best = examined(&free(2), request(false)).expect("identified");
    let price = best.flags.iter().find(|flag| flag.kind == "not_causal").expect("a flag");
    assert!(price.figure.expect("points") > 1.0 && price.text.contains("a price of"), "{}", price.text);
    let causal = examined(&free(2), request(true)).expect("identified");
    assert!(causal.obstacles.is_empty() && !kinds(&causal).contains(&"not_causal"));
    // The alternative is what `--causal` gives.
    let reported = best.examination.causal.as_ref().expect("an alternative");
    assert_eq!(reported.identification.estimate, causal.estimate);
    let at_samples = examined(&free(0), request(false)).expect("identified");
    assert!(!kinds(&at_samples).contains(&"not_causal"), "{:?}", at_samples.obstacles);
}

#[test]
fn reservations_come_first_on_the_page_and_as_a_list_for_programs() {
    let rig = free(2);
    let found = examined(&rig, Request { method: Method::Free, causal: false }).expect("identified");
    assert!(table(&rig, &found).starts_with("warning: "));
    let page: serde_json::Value = serde_json::from_str(&json(&rig, &found)).expect("JSON");
    let (flags, warnings) =
        (page["flags"].as_array().expect("a list"), page["warnings"].as_array().expect("a list"));
    assert_eq!(flags.len(), warnings.len());
    assert!(
        flags
            .iter()
            .zip(warnings)
            .all(|(flag, warning)| flag["kind"].is_string() && flag["text"] == *warning)
    );
    assert_eq!(page["causal"], false);
    assert!(page["loop"]["told_apart"].as_f64().expect("a share") > 0.9);
    assert_eq!(page["yardsticks"].as_array().map(Vec::len), Some(2));
}

#[test]
fn without_a_hold_out_the_fit_is_said_to_prove_nothing() {
    let mut rig = free(0);
    rig.records.pop();
    let found = examined(&rig, Method::Free.into()).expect("identified");
    assert_eq!(kinds(&found)[0], "no_holdout");
    assert!(found.examination.baselines.is_empty());
}
