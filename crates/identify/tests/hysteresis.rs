//! The operator (2.3) on every kind of border.

use proptest::collection::vec;
use proptest::prelude::*;
use switchback_model::hysteresis::{
    Branch, HysteresisError, Interval, LeafSpring, Line, StraightLines, SwitchedHysteresis,
    output_by_definition,
};

/// Inputs on nine levels of the interval, so that rises, falls and rests all occur, at repeated levels too.
fn input(interval: Interval) -> impl Strategy<Value = Vec<f64>> {
    vec((0..=8u32).prop_map(move |k| interval.low() + interval.width() * f64::from(k) / 8.0), 0..60)
}

/// One sample of (2.3), word for word.
fn restated(hysteresis: &SwitchedHysteresis, v: &[f64], before: f64, t: usize) -> f64 {
    if t == 0 {
        return before;
    }
    if v[t] > v[t - 1] {
        hysteresis.border(Branch::Ascending, v[t])
    } else if v[t] < v[t - 1] {
        hysteresis.border(Branch::Descending, v[t])
    } else {
        restated(hysteresis, v, before, t - 1)
    }
}

proptest! {
    #[test]
    fn the_operator_its_definition_and_a_per_sample_restatement_agree_exactly(
        (hysteresis, v) in crate::support::hysteresis().prop_flat_map(|h| {
            let v = input(h.interval());
            (Just(h), v)
        }),
        before in -5.0..5.0,
    ) {
        let fast = hysteresis.output(&v, before);
        let restated: Vec<f64> = (0..v.len()).map(|t| restated(&hysteresis, &v, before, t)).collect();
        prop_assert_eq!(&fast, &output_by_definition(&hysteresis, &v, before));
        prop_assert_eq!(&fast, &restated);
    }

    #[test]
    fn what_came_before_is_forgotten_at_the_first_move(
        (hysteresis, v) in crate::support::hysteresis().prop_flat_map(|h| {
            let v = input(h.interval());
            (Just(h), v)
        }),
    ) {
        let (one, other) = (hysteresis.output(&v, -7.0), hysteresis.output(&v, 7.0));
        for t in 0..v.len() {
            let moved = v[..=t].windows(2).any(|pair| pair[0] != pair[1]);
            prop_assert_eq!(one[t] == other[t], moved);
        }
    }

    #[test]
    fn a_hysteresis_that_was_built_satisfies_assumption_1(hysteresis in crate::support::hysteresis()) {
        prop_assert!(hysteresis.u_low() < hysteresis.u_high());
        prop_assert!(hysteresis.span() > 0.0);
    }
}

#[test]
fn friction_alone_is_enough_for_assumption_1() {
    let spring = LeafSpring::constant(0.0, 1.0).unwrap();
    let hysteresis = SwitchedHysteresis::new(Interval::new(-1.0, 1.0).unwrap(), Box::new(spring)).unwrap();
    assert_eq!((hysteresis.u_low(), hysteresis.u_high(), hysteresis.span()), (-1.0, 1.0, 2.0));
}

#[test]
fn borders_whose_ends_meet_or_cross_are_refused_with_both_values() {
    let interval = Interval::new(0.0, 2.0).unwrap();
    let falling =
        StraightLines::new(Line { slope: -1.0, offset: 1.0 }, Line { slope: 0.0, offset: 0.5 }).unwrap();
    let error = SwitchedHysteresis::new(interval, Box::new(falling)).unwrap_err();
    assert_eq!(error, HysteresisError::Assumption1 { u_low: 0.5, u_high: -1.0 });
    assert!(error.to_string().contains("C_d(h_m) = 0.5 must lie below C_a(h_M) = -1"));

    let meeting = LeafSpring::constant(0.0, 0.0).unwrap();
    assert!(SwitchedHysteresis::new(interval, Box::new(meeting)).is_err());
}

#[test]
fn borders_that_overflow_at_an_end_are_refused() {
    let spring = LeafSpring::hardening(1.0, 1e300, 0.0).unwrap();
    assert!(SwitchedHysteresis::new(Interval::new(-1e6, 1e6).unwrap(), Box::new(spring)).is_err());
}

#[test]
fn an_input_without_samples_gives_an_output_without_samples() {
    let spring = LeafSpring::constant(1.0, 1.0).unwrap();
    let hysteresis = SwitchedHysteresis::new(Interval::new(-1.0, 1.0).unwrap(), Box::new(spring)).unwrap();
    assert!(hysteresis.output(&[], 0.0).is_empty());
    assert!(output_by_definition(&hysteresis, &[], 0.0).is_empty());
}
