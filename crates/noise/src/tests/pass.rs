use proptest::prelude::*;

use crate::{
    Checkpoint, NoisePass, NoisePlan, NoisePlanError, NoiseRecord, StreamId, Width, record_by_definition,
    samples,
};

/// Coefficients of a stable A of any order up to six, from reflection coefficients (step-up recursion).
fn stable() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-0.9..0.9, 0..=6).prop_map(|reflections: Vec<f64>| {
        let mut a: Vec<f64> = Vec::new();
        for k in reflections {
            let p = a.len();
            a = (0..p).map(|i| a[i] + k * a[p - 1 - i]).collect();
            a.push(k);
        }
        a
    })
}

fn plan() -> impl Strategy<Value = NoisePlan> {
    let ma = prop::collection::vec(-2.0..2.0, 0..=3);
    let periods = prop::collection::vec(1usize..40, 0..=4);
    let checkpoints = prop::collection::btree_set(1usize..400, 1..=4);
    (stable(), ma, 0usize..=6, periods, checkpoints, 0usize..150).prop_map(
        |(ar, ma, lags, periods, checkpoints, burn_in)| NoisePlan {
            ar,
            ma,
            lags,
            periods,
            checkpoints: checkpoints.into_iter().collect(),
            burn_in,
        },
    )
}

fn records(plan: &NoisePlan, width: Width, count: u32) -> Vec<NoiseRecord> {
    let mut records = Vec::new();
    let mut pass = NoisePass::new(plan.clone(), width).unwrap();
    pass.run(3, 1, 5..5 + count, |replicate, record| {
        assert_eq!(replicate, 5 + records.len() as u32);
        records.push(record.clone());
    });
    records
}

fn close(fast: &NoiseRecord, slow: &NoiseRecord) -> bool {
    let scale = slow.checkpoints.iter().map(|c| c.lag_products[(0, 0)]).fold(1.0, f64::max);
    let near = |a: &f64, b: &f64| (a - b).abs() <= 1e-12 * scale;
    let all = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b));
    all(&fast.head, &slow.head)
        && fast.checkpoints.iter().zip(&slow.checkpoints).all(|(f, s)| {
            f.samples == s.samples
                && all(&f.tail, &s.tail)
                && all(f.lag_products.as_slice(), s.lag_products.as_slice())
                && f.folds.iter().zip(&s.folds).all(|(f, s)| all(f, s))
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any filter, lags, periods, checkpoints and burn-in.
    #[test]
    fn the_pass_records_what_the_definitions_say(plan in plan()) {
        for (replicate, fast) in (5..).zip(records(&plan, Width::detect(), 3)) {
            let slow = record_by_definition(&plan, StreamId { seed: 3, experiment: 1, replicate }).unwrap();
            prop_assert!(close(&fast, &slow), "{fast:?}\n{slow:?}");
        }
    }

    #[test]
    fn widths_agree_to_the_bit(plan in plan()) {
        let single = records(&plan, Width::SINGLE, 19);
        for width in Width::available() {
            prop_assert_eq!(&records(&plan, width, 19), &single, "{:?}", width);
        }
    }

    /// A record does not know what else is recorded.
    #[test]
    fn checkpoints_do_not_disturb_each_other(plan in plan()) {
        let all = records(&plan, Width::detect(), 2);
        for (index, &samples) in plan.checkpoints.iter().enumerate() {
            let alone = records(&NoisePlan { checkpoints: vec![samples], ..plan.clone() }, Width::detect(), 2);
            for (all, alone) in all.iter().zip(&alone) {
                prop_assert_eq!(&all.checkpoints[index], &alone.checkpoints[0]);
            }
        }
    }

    /// Recursion and products give the same bits in one loop (as many lags as coefficients) and in two (any
    /// other number).
    #[test]
    fn lags_do_not_disturb_each_other(mut plan in plan()) {
        plan.lags = plan.ar.len();
        let few = records(&plan, Width::detect(), 2);
        let more = records(&NoisePlan { lags: plan.lags + 1, ..plan.clone() }, Width::detect(), 2);
        for (few, more) in few.iter().zip(&more) {
            for (few, more) in few.checkpoints.iter().zip(&more.checkpoints) {
                let n = few.lag_products.nrows();
                prop_assert_eq!(&few.lag_products, &more.lag_products.view((0, 0), (n, n)).into_owned());
                prop_assert_eq!(&few.folds, &more.folds);
            }
        }
    }
}

fn valid() -> NoisePlan {
    NoisePlan {
        ar: vec![-1.5, 0.7],
        ma: vec![],
        lags: 2,
        periods: vec![22],
        checkpoints: vec![220],
        burn_in: 200,
    }
}

/// A million samples: the sums against sums with their rounding errors carried along (Neumaier).
#[test]
fn long_sums_keep_their_digits() {
    let plan = NoisePlan { checkpoints: vec![1_000_000], ..valid() };
    let stream = StreamId { seed: 3, experiment: 1, replicate: 5 };
    let noise = samples(&plan, stream, 1_000_000).unwrap();
    let e = &noise.e[noise.burn_in..];
    let fast = &records(&plan, Width::detect(), 1)[0].checkpoints[0];
    let close = |fast: f64, terms: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut lost, mut moduli) = (0.0_f64, 0.0, 0.0);
        for x in terms {
            let next = sum + x;
            lost += if sum.abs() >= x.abs() { (sum - next) + x } else { (x - next) + sum };
            sum = next;
            moduli += x.abs();
        }
        assert!((fast - (sum + lost)).abs() < 1e-13 * moduli, "{fast} against {}", sum + lost);
    };
    close(fast.lag_products[(0, 0)], &mut e.iter().map(|x| x * x));
    for p in 0..22 {
        close(fast.folds[0][p], &mut e.iter().skip(p).step_by(22).copied());
    }
}

#[test]
fn a_second_run_starts_afresh() {
    let mut pass = NoisePass::new(valid(), Width::detect()).unwrap();
    let mut run = || {
        let mut records = Vec::new();
        pass.run(1, 0, 0..3, |_, record| records.push(record.clone()));
        records
    };
    assert_eq!(run(), run());
}

#[test]
fn a_plan_that_cannot_be_run_is_refused() {
    let refused = |plan: NoisePlan| NoisePass::new(plan, Width::PORTABLE).map(|_| ()).unwrap_err();
    assert_eq!(refused(NoisePlan { ar: vec![-2.0, 1.0], ..valid() }), NoisePlanError::Unstable);
    assert_eq!(refused(NoisePlan { checkpoints: vec![], ..valid() }), NoisePlanError::NoCheckpoint);
    let order = NoisePlanError::CheckpointOrder { previous: 20, value: 10 };
    assert_eq!(refused(NoisePlan { checkpoints: vec![20, 10], ..valid() }), order);
    assert_eq!(
        refused(NoisePlan { periods: vec![22, 0], ..valid() }),
        NoisePlanError::ZeroPeriod { index: 1 }
    );
    assert!(matches!(refused(NoisePlan { ma: vec![f64::NAN], ..valid() }), NoisePlanError::NotFinite { .. }));
}

/// The start is stationary: the mean square of the head is the variance of the process.
#[test]
fn the_burn_in_makes_the_start_stationary() {
    let mut plan = valid();
    plan.burn_in = switchback_model::linear::settling_samples(&plan.ar, 1e-12);
    assert!((100..300).contains(&plan.burn_in), "{}", plan.burn_in);
    // Variance of the second-order autoregression, from the Yule–Walker equations.
    let [a1, a2] = [-1.5, 0.7];
    let variance = (1.0 + a2) / ((1.0 - a2) * ((1.0 + a2) * (1.0 + a2) - a1 * a1));
    plan.checkpoints = vec![1];
    let mut pass = NoisePass::new(plan, Width::detect()).unwrap();
    let (mut sum, count) = (0.0, 40_000);
    pass.run(1, 0, 0..count, |_, record| sum += record.head[1] * record.head[1]);
    let mean = sum / f64::from(count);
    let error = variance * (2.0 / f64::from(count)).sqrt();
    assert!((mean - variance).abs() < 4.0 * error, "{mean} against {variance} ± {error}");
}

#[test]
fn value_stability() {
    let record = &records(&valid(), Width::detect(), 1)[0];
    let Checkpoint { lag_products, folds, tail, .. } = &record.checkpoints[0];
    assert_eq!(
        [lag_products[(0, 0)], lag_products[(1, 2)], folds[0][21]],
        [2282.6098910597275, 2089.037229296324, 12.306832789242948]
    );
    assert_eq!([record.head[0], tail[1]], [4.966440648567698, -0.05523819090723414]);
}
