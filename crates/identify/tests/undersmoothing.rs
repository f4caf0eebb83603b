//! Intervals of borders that no grid of knots holds.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use switchback_identify::Estimate;
use switchback_identify::excitation::RandomLevels;
use switchback_identify::free::{
    Basis, Grid, InputMap, Moments, NestedRegressions, Regression, Settings, Structure, identify, one_shot,
};
use switchback_model::Record;
use switchback_model::hysteresis::{
    BorderPair, Branch, Discontinuous, Interval, LeafSpring, NonMonotone, Piece, SwitchedHysteresis, Wave,
};
use switchback_model::linear::filter;
use switchback_model::reversal::ReversalRule;

const A: [f64; 2] = [-1.2, 0.45];
const B: [f64; 2] = [0.15, 0.10];

/// A system on a drive, and its output without noise.
struct Rig {
    v: Vec<f64>,
    u: Vec<f64>,
    hysteresis: SwitchedHysteresis,
}

impl Rig {
    fn new(borders: Box<dyn BorderPair>, samples: usize) -> Self {
        let interval = Interval::new(-1.0, 1.0).expect("an interval");
        let mut rng = ChaCha8Rng::seed_from_u64(1984);
        let v = RandomLevels::new(interval).record_input(samples, &mut rng);
        let hysteresis = SwitchedHysteresis::new(interval, borders).expect("Assumption 1");
        let u = hysteresis.output(&v, hysteresis.u_low());
        Self { v, u, hysteresis }
    }

    /// The output with white equation errors, uniform with this standard deviation.
    fn output(&self, sd: f64, seed: u64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let half = sd * 3f64.sqrt();
        let w: Vec<f64> = self.v.iter().map(|_| rng.random_range(-half..half)).collect();
        let low = self.hysteresis.u_low();
        filter(&A, &B, &self.u, &w, low, low)
    }

    fn grid(&self, points: usize) -> Grid {
        let knots: Vec<f64> = (0..points).map(|j| -1.0 + 2.0 * j as f64 / (points - 1) as f64).collect();
        Grid {
            structure: Structure { order: 2, delay: 0 },
            basis: Basis::borders(knots.clone(), knots),
            rule: ReversalRule::EXACT,
        }
    }

    /// Standardised errors of all points.
    fn errors(&self, estimate: &Estimate) -> Vec<f64> {
        let borders = [(Branch::Descending, &estimate.descending), (Branch::Ascending, &estimate.ascending)];
        let error = |(branch, v): (Branch, f64)| self.hysteresis.border(branch, v) / self.hysteresis.span();
        let of = |(branch, points): (Branch, &Vec<_>)| {
            let point = |p: &switchback_identify::BorderPoint| (p.f - error((branch, p.v))) / p.se;
            points.iter().map(point).collect::<Vec<_>>()
        };
        borders.map(of).concat()
    }
}

fn waves() -> Box<dyn BorderPair> {
    let wave = |offset, amplitude| Wave { offset, slope: 0.4, amplitude, wavelength: 1.0, phase: 0.4 };
    Box::new(NonMonotone::new(wave(0.4, 0.35), wave(-0.3, 0.3)).expect("borders"))
}

fn moments(regression: &Regression, y: &[f64]) -> Moments {
    let (lags, input) = (regression.lag_products(y, y), regression.input_products(y));
    regression.moments(0, &lags[0], &input[0])
}

fn refined(nested: &NestedRegressions, y: &[f64]) -> Estimate {
    nested.estimate(|number| moments(&nested.regressions()[number], y)).expect("an estimate")
}

fn share_covered(errors: &[f64]) -> f64 {
    errors.iter().filter(|z| z.abs() <= 1.96).count() as f64 / errors.len() as f64
}

#[test]
fn every_grid_contains_the_one_before_and_none_is_finer_than_the_input() {
    let rig = Rig::new(waves(), 1002);
    let nested = NestedRegressions::new(&rig.v, rig.grid(5), &[900]).expect("regressions");
    let grids: Vec<&Basis> = nested.on_grids().map(|(_, regression)| &regression.grid().basis).collect();
    assert!(grids.len() > 2);
    for pair in grids.windows(2) {
        assert!(pair[0].descending().iter().all(|knot| pair[1].descending().contains(knot)));
        assert!(pair[0].ascending().iter().all(|knot| pair[1].ascending().contains(knot)));
        for knots in [pair[1].descending(), pair[1].ascending()] {
            for cell in knots.windows(2) {
                assert!(rig.v.iter().any(|v| (cell[0]..=cell[1]).contains(v)), "nothing in {cell:?}");
            }
        }
    }
}

#[test]
fn intervals_hold_borders_that_bend_where_those_of_a_fixed_grid_do_not() {
    let rig = Rig::new(waves(), 3002);
    let nested = NestedRegressions::new(&rig.v, rig.grid(9), &[2900]).expect("regressions");
    let (mut fixed, mut finer) = (Vec::new(), Vec::new());
    for seed in 0..40 {
        let y = rig.output(0.03, seed);
        let first = &nested.regressions()[0];
        fixed.extend(rig.errors(&first.estimate(&moments(first, &y)).expect("an estimate")));
        let estimate = refined(&nested, &y);
        assert_eq!((estimate.descending.len(), estimate.ascending.len()), (9, 9));
        finer.extend(rig.errors(&estimate));
    }
    assert!(share_covered(&fixed) < 0.6, "{}", share_covered(&fixed));
    // 720 points of 40 records: a standard error of 1 to 2 %.
    assert!((0.9..=0.99).contains(&share_covered(&finer)), "{}", share_covered(&finer));
}

#[test]
fn a_grid_fine_enough_is_kept_and_its_bias_alone_taken_off() {
    let rig = Rig::new(Box::new(LeafSpring::hardening(0.5, 0.3, 0.25).expect("a spring")), 1002);
    let nested = NestedRegressions::new(&rig.v, rig.grid(9), &[900]).expect("regressions");
    let y = rig.output(0.3, 1);
    let first = &nested.regressions()[0];
    let plain = first.estimate(&moments(first, &y)).expect("an estimate");
    let estimate = refined(&nested, &y);
    for (x, z) in plain.descending.iter().zip(&estimate.descending) {
        assert_eq!(x.v, z.v);
        assert!((x.f - z.f).abs() < x.se, "{x:?} and {z:?}");
        assert!(z.se > 0.8 * x.se && z.se < 1.5 * x.se, "{x:?} and {z:?}");
    }
}

#[test]
fn an_interval_beside_a_jump_spans_both_sides() {
    let pieces = |list: [(f64, f64); 2]| list.map(|(from, value)| Piece { from, value, slope: 0.3 }).to_vec();
    let borders =
        Discontinuous::new(pieces([(-1.0, -0.6), (0.03, 0.4)]), pieces([(-1.0, -0.9), (-0.6, -0.5)]));
    let rig = Rig::new(Box::new(borders.expect("borders")), 3002);
    let nested = NestedRegressions::new(&rig.v, rig.grid(9), &[2900]).expect("regressions");
    let estimate = refined(&nested, &rig.output(0.02, 5));
    let point = estimate.ascending.iter().find(|p| p.v == 0.0).expect("a knot at 0");
    let span = rig.hysteresis.span();
    let before = rig.hysteresis.border(Branch::Ascending, 0.0) / span;
    let after = rig.hysteresis.border(Branch::Ascending, 0.03) / span;
    for side in [before, after] {
        assert!(
            (point.f - side).abs() <= 1.96 * point.se,
            "{side} outside {} ± {}",
            point.f,
            1.96 * point.se
        );
    }
    let far = estimate.ascending.iter().find(|p| p.v == 0.5).expect("a knot at 0.5");
    assert!(far.se < 0.2 * point.se);
}

#[test]
fn identification_shows_intervals_that_hold_borders_that_bend() {
    let rig = Rig::new(waves(), 4000);
    let mut errors = Vec::new();
    for seed in 0..8 {
        let record = Record::new(rig.v.clone(), rig.output(0.02, seed)).expect("a record");
        let settings = Settings {
            order: Some(2),
            delay: Some(0),
            knots: Some(7),
            interval: Some(rig.hysteresis.interval()),
            refine: seed < 2,
            ..Settings::new(InputMap::Borders)
        };
        let identified = identify(&[&record], &settings).expect("a model");
        assert_eq!((identified.estimate.descending.len(), identified.estimate.ascending.len()), (7, 7));
        errors.extend(rig.errors(&identified.estimate));
    }
    // 112 points of 8 records, whose errors are correlated.
    assert!(share_covered(&errors) > 0.85, "{}", share_covered(&errors));
    let record = Record::new(rig.v.clone(), rig.output(0.02, 0)).expect("a record");
    let fixed = one_shot(&[&record], &rig.grid(7)).expect("an estimate");
    assert!(share_covered(&rig.errors(&fixed)) < 0.6);
}
