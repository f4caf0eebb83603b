//! Models that leave run as they did inside.

use std::sync::Arc;

use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};
use switchback_model::step::Machine;

use super::{Exporter, LooksAhead, PortableModel};
use crate::attribution::explain::Hypothesis;
use crate::likelihood::engine::{Fit, FitContext, fit};
use crate::model::augmented::*;
use crate::model::borders::Grid;
use crate::model::sensor::{Bumps, Knee, SensorCurve};
use crate::model::sensor_polynomial::SensorPolynomial;
use crate::records::dataset::{Criterion, Dataset};
use crate::records::motion::{Begins, Play};
use crate::simulation::simulate::free_run;
use crate::testing::{small_model, white};

const SAMPLES: usize = 400;

fn input(samples: usize, phase: f64) -> Vec<f64> {
    let at = |t: usize| {
        let t = if t % 40 > 33 { t - t % 40 + 33 } else { t } as f64;
        3.0 + 2.0 * (0.21 * t + phase).sin() + 1.5 * (0.057 * t).sin()
    };
    (0..samples).map(at).collect()
}

/// The output of the small model on straight borders, noise in its equation.
fn output(v: &[f64], noise: &mut impl FnMut() -> f64) -> Vec<f64> {
    let (mut y, mut u, mut old) = (vec![0.0; v.len()], vec![0.0; v.len()], 0.0);
    for t in 0..v.len() {
        let step = if t > 0 { v[t] - v[t - 1] } else { 0.0 };
        old = if step == 0.0 && t > 0 { old } else { 0.5 * v[t] + if step < 0.0 { -0.6 } else { 0.6 } };
        u[t] = old;
        let past = |x: &[f64], lag: usize| if t >= lag { x[t - lag] } else { 0.0 };
        y[t] = 0.6 * past(&y, 1) - 0.2 * past(&y, 2) + 0.8 * past(&u, 1) + 0.3 * past(&u, 2) + 0.1 * noise();
    }
    y
}

fn rig(noise: &mut impl FnMut() -> f64) -> Rig {
    let mut record = |name: &str, usage, phase| {
        let v = input(SAMPLES, phase);
        let y = output(&v, noise);
        let record = Record::new(v, y).expect("finite and equally long");
        RigRecord { name: name.into(), role: Role::Free, usage, record, predicted: None }
    };
    let records = vec![
        record("first", Usage::Fit, 0.0),
        record("second", Usage::Fit, 0.7),
        record("last", Usage::Holdout, 1.9),
    ];
    Rig {
        name: "small".into(),
        sample_time: 0.5,
        order: Some(2),
        interval: None,
        input_label: "v [mm]".into(),
        output_label: "y [N]".into(),
        records,
    }
}

fn grid() -> Grid {
    Grid { knots: [vec![0.0, 0.4, 1.0], vec![0.0, 0.5, 0.5, 1.0]] }
}

fn fitted(dataset: &Dataset, grid: &Grid, augmented: &AugmentedModel) -> Fit {
    let start = small_model(grid).padded(grid.len(), augmented);
    let context = FitContext { dataset, grid, known: None };
    fit(context, &|_| augmented.clone(), &[], &start, 4).expect("a fit")
}

fn column(column: BorderColumn) -> AugmentedModel {
    AugmentedModel { border_columns: vec![column], ..AugmentedModel::default() }
}

fn disturbed(columns: Vec<EquationColumn>) -> AugmentedModel {
    AugmentedModel { equation_columns: columns, ..AugmentedModel::default() }
}

/// A slow change as effects make it: a path between samples by the clock in samples, polynomials and waves by the others, which end at one.
fn slow(clock: Clock) -> Slow {
    let path = |scale: f64| vec![(0.2 * scale, 0.0), (0.6 * scale, 0.1)];
    match clock {
        Clock::Samples => Slow { bends: path(3.0 * SAMPLES as f64), ..Slow::on(clock) },
        _ => Slow {
            coefficients: vec![0.05, -0.02],
            wave: Some((3.0, 0.02, 0.01)),
            bends: path(1.0),
            ..Slow::on(clock)
        },
    }
}

/// One augmented model for every part that an effect may add.
fn augmented_models() -> Vec<AugmentedModel> {
    let none = AugmentedModel::default;
    let laws = [TransitionLaw::Offset, TransitionLaw::Held, TransitionLaw::Crossing];
    let mut filtered = none();
    filtered.filter(&[0.3, 0.1], &[1.0, -0.6]);
    let curve = |curve: SensorCurve| AugmentedModel { curve, ..AugmentedModel::default() };
    let noisy = |noise: NoiseLaw| AugmentedModel { noise, ..AugmentedModel::default() };
    let decay = |scaled| EquationColumn::Decay { scaled, radius: 0.7, frequency: 0.0, sine: false };
    let line = |scaled, sine| EquationColumn::Line { frequency: 0.3, scaled, sine };
    let mut all = vec![
        none(),
        filtered,
        AugmentedModel { delay: 1.4, extra_b: 1, ..none() },
        AugmentedModel { jitter: 0.01, ..none() },
        AugmentedModel { late: 0.3, ..none() },
        AugmentedModel { play: Play { width: 0.08, taper: 0.3 }, ..none() },
        AugmentedModel {
            widening: Some(Widening { share: 0.2, power: 0.5, scale: 0.05, speeds: Speeds::Low }),
            ..none()
        },
        AugmentedModel { relaxation: Some(Relaxation { share: 0.5, tau: 2.0 }), ..none() },
        column(BorderColumn::Speed { power: 1.0, scale: 0.05, while_resting: Resting::Held }),
        column(BorderColumn::LowSpeed { power: 1.0, scale: 0.05, while_resting: Resting::Zero }),
        column(BorderColumn::Bristle { power: 1.0, scale: 0.05, length: 0.03 }),
        column(BorderColumn::RestingLog { scale: 2.0 }),
        column(BorderColumn::RestingRise { scale: 2.0 }),
        column(BorderColumn::ReversalLog { scale: 2.0 }),
        AugmentedModel {
            transition: Some(Transition { length: 0.05, shape: 1.0, law: TransitionLaw::Offset }),
            ..column(BorderColumn::Start { scaled: 0 })
        },
        disturbed(vec![line(None, false), line(None, true)]),
        disturbed(vec![line(Some(0), false), line(Some(0), true), line(Some(1), true)]),
        disturbed(vec![decay(0), decay(1)]),
        disturbed((0..3).map(|piece| EquationColumn::Local { scaled: 1, piece, pieces: 2 }).collect()),
        disturbed(vec![EquationColumn::Offset { scaled: 1, against: Some(0) }]),
        AugmentedModel { gain: Some(slow(Clock::Dataset)), ..disturbed(vec![EquationColumn::Gain]) },
        curve(SensorCurve { powers: vec![0.03, 0.01], ..SensorCurve::default() }),
        curve(SensorCurve {
            sensor_polynomial: Some(SensorPolynomial::new(0.04, -0.01)),
            ..SensorCurve::default()
        }),
        curve(SensorCurve {
            bumps: Some(Bumps { first: -1.5, spacing: 1.0, heights: vec![0.02, -0.03] }),
            knees: vec![Knee { level: 1.0, width: 0.5, sign: 1.0 }],
            ..SensorCurve::default()
        }),
        AugmentedModel {
            saturation: Some(Saturation { low: f64::NEG_INFINITY, high: 1.2, order: 2 }),
            ..none()
        },
        noisy(NoiseLaw { ar: vec![-0.3], ..NoiseLaw::default() }),
        noisy(NoiseLaw { output_ratio: 0.5, quantisation: Some(0.01), ..NoiseLaw::default() }),
        noisy(NoiseLaw { mixture: Some((0.05, 5.0)), ..NoiseLaw::default() }),
    ];
    all.extend(laws.map(|law| AugmentedModel {
        transition: Some(Transition { length: 0.05, shape: 1.0, law }),
        ..none()
    }));
    for clock in [Clock::Dataset, Clock::Samples, Clock::Record, Clock::Travel] {
        all.push(AugmentedModel { wear: Some(slow(clock)), ..none() });
        all.push(AugmentedModel { gain: Some(slow(clock)), ..none() });
    }
    for clock in [Clock::Dataset, Clock::Record, Clock::Travel] {
        all.push(column(BorderColumn::BranchSlow { clock }));
        all.push(column(BorderColumn::SideSlow { clock, branch: 1.0 }));
    }
    for clock in [Clock::Dataset, Clock::Record, Clock::Pauses] {
        all.push(disturbed(vec![EquationColumn::Trend { clock, degree: 2 }]));
    }
    all
}

/// Written as JSON and read again.
fn reread(model: &PortableModel) -> PortableModel {
    let text = serde_json::to_string(model).expect("plain data");
    serde_json::from_str(&text).expect("what was written")
}

#[test]
fn what_leaves_runs_as_the_diagnosis_does_to_the_last_bit() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let exporter = Exporter::new(&rig);
    for led in [dataset.clone(), dataset.led_by(2)] {
        for augmented in augmented_models() {
            let fit = fitted(&led, &grid(), &augmented);
            let model = exporter.given(&led, &fit);
            assert_eq!(reread(&model), model, "{augmented:?}");
            let model = reread(&model);
            for (number, record) in rig.records.iter().enumerate() {
                let inside = free_run(&led, &fit, number, &led.scaled_records[number]);
                let inside: Vec<f64> = inside.iter().map(|y| led.y_mean + led.y_scale * y).collect();
                let outside = model.outputs(number, record.record.v(), record.record.y());
                assert_eq!(outside, inside, "{}: {augmented:?}", record.name);
                // It is known by its samples, and keeps its place.
                let known = model.simulate(record.record.v(), Some(record.record.y()));
                assert_eq!(known.record.as_deref(), Some(record.name.as_str()));
                assert_eq!(known.y, inside);
                assert!(known.notes.is_empty());
            }
        }
    }
}

/// The largest difference of a run sample by sample from the free run from rest, in standard deviations of the output.
fn largest_difference(model: &PortableModel, v: &[f64], scale: f64) -> f64 {
    let program = model.causal().expect("a causal model").program();
    let mut machine = Machine::new(Arc::new(program)).expect("a whole program");
    machine.start(v[0], 0.0);
    let run = model.simulate(v, None).y;
    let differences = v.iter().zip(&run).map(|(v, y)| (machine.step(*v) - y).abs() / scale);
    differences.fold(0.0, f64::max)
}

#[test]
fn sample_by_sample_it_runs_as_from_rest() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let exporter = Exporter::new(&rig);
    let simulated = dataset.judged_by(Criterion::Simulation { share: 0.2 });
    for augmented in augmented_models() {
        let fit = fitted(&dataset, &grid(), &augmented);
        // Fitted to inputs of the wrong time a model of these records is unstable, and rounding grows with its output.
        let led = [0, 1, -2].map(|lead| exporter.given(&dataset.led_by(lead), &fit));
        let simulated = exporter.given(&simulated, &fitted(&simulated, &grid(), &augmented));
        for model in led.iter().chain([&simulated]) {
            for v in [input(150, 0.4), input(150, 3.6), [vec![4.0; 9], input(80, 1.1)].concat()] {
                let largest = model.simulate(&v, None).y.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
                assert!(largest < 20.0 * dataset.y_scale, "{largest}: {augmented:?}");
                let difference = largest_difference(model, &v, dataset.y_scale);
                assert!(difference < 1e-12, "{difference}: {augmented:?}");
            }
        }
    }
}

#[test]
fn what_looks_ahead_is_refused_sample_by_sample() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let exporter = Exporter::new(&rig);
    let causal = |dataset: &Dataset, augmented: &AugmentedModel| {
        exporter.given(dataset, &fitted(dataset, &grid(), augmented)).causal()
    };
    let none = AugmentedModel::default();
    assert_eq!(causal(&dataset.led_by(3), &none), Err(LooksAhead::Input(2)));
    // A delay makes up for it.
    assert!(causal(&dataset.led_by(3), &AugmentedModel { delay: 2.5, ..none.clone() }).is_ok());
    let mut thresholded = dataset.with_branches_from(Begins::AtExtreme);
    assert!(causal(&thresholded, &none).is_ok());
    thresholded.rule.threshold = 0.05;
    let reported = causal(&thresholded, &none).expect_err("dated back");
    assert_eq!(reported, LooksAhead::Reversals(0.05 * dataset.v_width));
}

#[test]
fn at_rest_everything_stays() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    for augmented in augmented_models().into_iter().filter(|a| a.relaxation.is_none()) {
        // What acts on time at rest does not stay.
        let ages =
            |c: &BorderColumn| !matches!(c, BorderColumn::Speed { .. } | BorderColumn::LowSpeed { .. });
        if augmented.border_columns.iter().any(ages)
            || augmented.equation_columns.iter().any(|c| matches!(c, EquationColumn::Decay { .. }))
        {
            continue;
        }
        let model = Exporter::new(&rig).given(&dataset, &fitted(&dataset, &grid(), &augmented));
        let run = model.simulate(&[4.0; 60], None);
        assert_eq!(run.start, 0);
        for y in &run.y {
            assert!((y - run.y[0]).abs() < 1e-6 * dataset.y_scale, "{augmented:?}: {y} {}", run.y[0]);
        }
        assert!(run.low[5] < run.y[5] && run.high[5] > run.y[5] || augmented.saturation.is_some());
    }
}

/// The oracle: the plain recursion in physical units, from the borders and coefficients that the model shows.
#[test]
fn a_plain_model_from_rest_is_what_its_system_says() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let model = Exporter::new(&rig).given(&dataset, &fitted(&dataset, &grid(), &AugmentedModel::default()));
    assert!(model.is_plain());
    let system = model.system();
    let border = |points: &[(f64, f64)], v: f64| {
        let right = points.partition_point(|p| p.0 < v).clamp(1, points.len() - 1);
        let ((l, f), (r, g)) = (points[right - 1], points[right]);
        if r > l { f + (g - f) * ((v - l) / (r - l)).clamp(0.0, 1.0) } else { f }
    };
    let v: Vec<f64> = input(120, 0.4);
    // It begins on the border that the first input is nearer to the end of.
    let middle = 0.5 * (system.ascending[0].0 + system.ascending[system.ascending.len() - 1].0);
    let first = if v[0] >= middle { &system.ascending } else { &system.descending };
    let mut u = vec![border(first, v[0])];
    for t in 1..v.len() {
        u.push(match v[t].total_cmp(&v[t - 1]) {
            std::cmp::Ordering::Greater => border(&system.ascending, v[t]),
            std::cmp::Ordering::Less => border(&system.descending, v[t]),
            std::cmp::Ordering::Equal => u[t - 1],
        });
    }
    let gain = system.b.iter().sum::<f64>() / (1.0 + system.a.iter().sum::<f64>());
    let mut y: Vec<f64> = Vec::new();
    let past = |x: &[f64], t: usize, lag: usize, rest: f64| if t >= lag { x[t - lag] } else { rest };
    for t in 0..v.len() {
        let driven: f64 = system.b.iter().enumerate().map(|(j, b)| b * past(&u, t, j + 1, u[0])).sum();
        let free: f64 = system.a.iter().enumerate().map(|(i, a)| a * past(&y, t, i + 1, gain * u[0])).sum();
        y.push(driven - free);
    }
    for (found, y) in model.simulate(&v, None).y.iter().zip(&y) {
        assert!((found - y).abs() < 1e-7, "{found} {y}");
    }
}

#[test]
fn elsewhere_slow_changes_stand_at_their_end_and_it_is_said() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let trend = disturbed(vec![EquationColumn::Trend { clock: Clock::Samples, degree: 1 }]);
    let mut fit = fitted(&dataset, &grid(), &trend);
    fit.linear.d = vec![1e-3];
    let model = Exporter::new(&rig).given(&dataset, &fit);
    let run = |v: &[f64]| model.simulate(v, None);
    let there = run(&[4.0; 10]);
    assert!(there.notes[0].contains("at the end of the dataset"), "{:?}", there.notes);
    // The oracle: the model without the trend, and the trend's last value through the gain at rest.
    let mut still = fit.clone();
    still.linear.d = vec![0.0];
    let plain = Exporter::new(&rig).given(&dataset, &still).simulate(&[4.0; 10], None);
    let at_rest = 1.0 + fit.linear.a.iter().sum::<f64>();
    let expected = 1e-3 * (2.0 * dataset.total as f64 - 1.0) / at_rest * dataset.y_scale;
    assert!((there.y[7] - plain.y[7] - expected).abs() < 1e-9, "{} {expected}", there.y[7] - plain.y[7]);
}

#[test]
fn a_wave_elsewhere_is_in_the_band_and_not_in_the_output() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let line = |sine| EquationColumn::Line { frequency: 0.3, scaled: None, sine };
    let mut fit = fitted(&dataset, &grid(), &disturbed(vec![line(false), line(true)]));
    let width = |fit: &Fit| {
        let run = Exporter::new(&rig).given(&dataset, fit).simulate(&[4.0; 50], None);
        assert!(run.y.iter().all(|y| (y - run.y[0]).abs() < 1e-9 * dataset.y_scale));
        ((run.high[30] - run.low[30]) / (2.0 * 1.959_963_984_540_054 * dataset.y_scale)).powi(2)
    };
    fit.linear.d = vec![0.0, 0.0];
    let without = width(&fit);
    fit.linear.d = vec![0.3, 0.4];
    // The oracle: the mean square of the wave behind 1/A, from a long run of the recursion.
    let (mut x, mut sum) = (vec![0.0; 2], 0.0);
    for t in 2..40_000 {
        let now = 0.3 * (0.3 * t as f64).cos() + 0.4 * (0.3 * t as f64).sin()
            - fit.linear.a[0] * x[t - 1]
            - fit.linear.a[1] * x[t - 2];
        x.push(now);
        sum += now * now;
    }
    let power = sum / 40_000.0;
    assert!((width(&fit) - without - power).abs() < 2e-3 * power, "{} {power}", width(&fit) - without);
}

/// Coverage of the 95 % band on fresh records of known truth, over fits to short records, so that the parameters' errors matter.
#[test]
fn the_band_holds_what_it_says() {
    let mut noise = white();
    let (mut inside, mut count, mut narrow) = (0, 0, 0);
    for _ in 0..30 {
        let rig = rig(&mut noise);
        let dataset = Dataset::new(&rig).expect("a usable rig");
        let grid = Grid { knots: [vec![0.0, 0.5, 1.0], vec![0.0, 0.5, 1.0]] };
        let fit = fitted(&dataset, &grid, &AugmentedModel::default());
        let floor = Exporter::new(&rig).given(&dataset, &fit);
        let model = Exporter::new(&rig).fitted(&dataset, &Hypothesis::nominal(fit));
        assert!(model.has_covariance());
        let v = input(SAMPLES, 2.5);
        let y = output(&v, &mut noise);
        let run = reread(&model).simulate(&v, Some(&y));
        let bare = floor.simulate(&v, Some(&y));
        for t in run.start..v.len() {
            inside += usize::from((run.low[t]..=run.high[t]).contains(&y[t]));
            narrow += usize::from((bare.low[t]..=bare.high[t]).contains(&y[t]));
            count += 1;
        }
    }
    let [covered, without] = [inside, narrow].map(|k| k as f64 / count as f64);
    // 11,600 samples of which about one in three is independent (1 + 2Σρ² of this A is below 3): a standard error of 0.0035; the errors of
    // the thirty fits, each common to its record, add about as much. Three of both.
    assert!((covered - 0.95).abs() < 0.015, "{covered}");
    assert!(without < covered, "{without} {covered}");
}

#[test]
fn what_contradicts_itself_is_refused() {
    let rig = rig(&mut white());
    let dataset = Dataset::new(&rig).expect("a usable rig");
    let model = Exporter::new(&rig).given(&dataset, &fitted(&dataset, &grid(), &AugmentedModel::default()));
    let good = serde_json::to_value(&model).expect("plain data");
    let refused = |change: &dyn Fn(&mut serde_json::Value), word: &str| {
        let mut bad = good.clone();
        change(&mut bad);
        let reported = serde_json::from_value::<PortableModel>(bad).expect_err("no model").to_string();
        assert!(reported.contains(word), "{reported}");
    };
    refused(&|m| m["linear"]["f"] = serde_json::json!([1.0]), "`f` has 1 entries");
    refused(&|m| m["linear"]["b"] = serde_json::json!([]), "`b` has 0 entries");
    refused(&|m| m["linear"]["a"] = serde_json::json!([]), "`a` is 0");
    refused(&|m| m["grid"]["knots"][0] = serde_json::json!([0.0, 1.0, 0.5]), "knots");
    refused(&|m| m["scales"]["v_width"] = serde_json::json!(0.0), "v_width");
    refused(&|m| m["assembly"]["delay"] = serde_json::json!(-1.0), "delay");
    refused(&|m| m["covariance"] = serde_json::json!([[1.0]]), "covariance");
    refused(&|m| m["assembly"]["plays"] = serde_json::json!(1), "plays");
}
