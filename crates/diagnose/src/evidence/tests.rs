use super::context::{Block, Signal};
use super::grams::Grams;
use super::score::{score, share};
use super::*;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// A machine of first order with a play before its borders, in units of the caller.
fn rig(play: f64, [v_scale, v_zero]: [f64; 2], [y_scale, y_zero]: [f64; 2]) -> Rig {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut record = |name: &str, usage, samples: usize, phase: f64| {
        let input = |t: f64| 0.55 * (0.17 * t + phase).sin() + 0.45 * (0.025 * t).cos();
        let v: Vec<f64> = (0..samples).map(|t| input(t as f64)).collect();
        let (mut p, mut u, mut y) = (v[0], 0.0, 0.0);
        let mut step = |v: f64| {
            y = 0.6 * y + 0.4 * u + 0.01 * rng.sample::<f64, _>(StandardNormal);
            let moved = p.clamp(v - 0.5 * play, v + 0.5 * play) - p;
            p += moved;
            u = if moved == 0.0 { u } else { p + 0.5 * moved.signum() };
            y_scale * y + y_zero
        };
        let y = v.iter().map(|v| step(*v)).collect();
        let v = v.iter().map(|v| v_scale * v + v_zero).collect();
        let record = Record::new(v, y).expect("finite values of equal number");
        RigRecord { name: name.into(), role: Role::Free, usage, record, predicted: None }
    };
    Rig {
        name: "bench".into(),
        sample_time: 0.01,
        order: Some(1),
        interval: None,
        input_label: "travel".into(),
        output_label: "force".into(),
        records: vec![record("monday", Usage::Fit, 2000, 0.0), record("tuesday", Usage::Holdout, 1000, 1.0)],
    }
}

fn judged(rig: &Rig) -> Judged {
    Judged::identified(rig).expect("a model").expect("a gain at rest")
}

fn column(evidence: &Evidence, name: &str) -> f64 {
    evidence.columns.iter().find(|(known, _)| known == name).unwrap_or_else(|| panic!("{name}")).1
}

#[test]
fn a_play_gains_most_and_has_its_size() {
    let rig_with_play = rig(0.2, [1.0, 0.0], [1.0, 0.0]);
    let Judged { evidence, .. } = judged(&rig_with_play);
    let best = evidence.fits.iter().max_by(|x, y| x.gain.total_cmp(&y.gain)).expect("fits");
    let term = best.system.terms.last().expect("a term");
    assert_eq!(term.law.effect(), "backlash");
    // In ranges of the input.
    let v = || rig_with_play.records[0].record.v().iter().copied();
    let range = v().fold(f64::MIN, f64::max) - v().fold(f64::MAX, f64::min);
    assert!((term.values[0] * range - 0.2).abs() < 0.01, "{:?}", term.values);
    assert_eq!(column(&evidence, "backlash.fit_rank"), 0.0);
    assert!(column(&evidence, "backlash.fit_held_out") > 0.3);
    // Without the play there is nothing to gain.
    let none = judged(&rig(0.0, [1.0, 0.0], [1.0, 0.0])).evidence;
    assert!(column(&none, "fit_first") < 0.02, "{}", column(&none, "fit_first"));
}

/// Zeros and units are matters of the sensors.
#[test]
fn units_and_zeros_change_no_column() {
    let one = judged(&rig(0.2, [1.0, 0.0], [1.0, 0.0])).evidence;
    for (v, y) in [([1e3, 0.0], [1.0, 0.0]), ([1.0, 0.0], [1e-3, 0.0]), ([25.4, 3.0], [4.4, -7.0])] {
        assert_eq!(one.columns, judged(&rig(0.2, v, y)).evidence.columns, "{v:?} {y:?}");
    }
}

/// Signals of two records as they are, and as columns.
fn drawn(count: usize, seed: u64) -> (Vec<Signal>, Vec<DVector<f64>>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let lengths = [70, 40];
    let one = |_| -> Signal {
        lengths.map(|n| (0..n).map(|_| rng.sample::<f64, _>(StandardNormal)).collect()).to_vec()
    };
    let signals: Vec<Signal> = (0..count).map(one).collect();
    let columns = signals.iter().map(|s| DVector::from_vec(s.concat())).collect();
    (signals, columns)
}

fn blocks() -> [Block; 4] {
    let block = |record, from, to| Block { record, from, to, is_fitted: record == 0 };
    [block(0, 0, 30), block(0, 30, 70), block(1, 0, 20), block(1, 20, 40)]
}

/// Least squares of `y` on columns.
fn solved(columns: &[DVector<f64>], y: &DVector<f64>) -> DVector<f64> {
    let x = DMatrix::from_columns(columns);
    x.clone().svd(true, true).solve(y, 1e-12).expect("both factors")
}

fn free(columns: &[DVector<f64>], y: &DVector<f64>) -> DVector<f64> {
    y - DMatrix::from_columns(columns) * solved(columns, y)
}

#[test]
fn shares_are_those_of_least_squares_on_projected_columns() {
    for seed in 0..8 {
        let (base, base_columns) = drawn(5, seed);
        let (signals, columns) = drawn(6, 100 + seed);
        let grams = Grams::new(&base, &signals, &blocks());
        let freed: Vec<DVector<f64>> = columns.iter().map(|c| free(&base_columns, c)).collect();
        assert!((grams.energy() - freed[0].norm_squared()).abs() < 1e-9);
        for k in 0..6 {
            assert!((grams.kept[k] - freed[k].norm() / columns[k].norm()).abs() < 1e-9);
        }
        for group in [vec![1], vec![2, 3], vec![1, 4, 5]] {
            let own: Vec<DVector<f64>> = group.iter().map(|k| freed[*k].clone()).collect();
            let left = free(&own, &freed[0]).norm_squared();
            let slow = 1.0 - left / freed[0].norm_squared();
            // The ridge keeps a ten-thousandth of a coefficient back.
            assert!((share(&grams, &group) - slow).abs() < 1e-6, "{} {slow}", share(&grams, &group));
        }
    }
}

#[test]
fn a_validated_share_is_of_blocks_that_were_left_out() {
    let (signals, columns) = drawn(3, 7);
    let grams = Grams::new(&[], &signals, &blocks());
    let found = score(&grams, &[1, 2]);
    let ranges = [0..30, 30..70, 70..90, 90..110];
    let rows = |c: &DVector<f64>, keep: &dyn Fn(usize) -> bool| {
        DVector::from_vec((0..110).filter(|t| keep(*t)).map(|t| c[t]).collect())
    };
    let energy = columns[0].norm_squared();
    let slow: f64 = ranges
        .iter()
        .map(|range| {
            let outside = |t: usize| !range.contains(&t);
            let inside = |t: usize| range.contains(&t);
            let learnt: Vec<DVector<f64>> = columns[1..].iter().map(|c| rows(c, &outside)).collect();
            let c = solved(&learnt, &rows(&columns[0], &outside));
            let judged: Vec<DVector<f64>> = columns[1..].iter().map(|c| rows(c, &inside)).collect();
            let y = rows(&columns[0], &inside);
            y.norm_squared() - (&y - DMatrix::from_columns(&judged) * c).norm_squared()
        })
        .sum();
    assert!((found.validated - slow / energy).abs() < 1e-5, "{} {}", found.validated, slow / energy);
}
