//! The designed experiments on every kind of border.

use proptest::collection::btree_set;
use proptest::prelude::*;
use std::collections::BTreeSet;
use switchback_identify::excitation::{Direction, PulseExperiment, StepExperiment};
use switchback_model::hysteresis::{Branch, Interval, LeafSpring, SwitchedHysteresis};

const LOADING: usize = 1;

fn direction() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::Descendant), Just(Direction::Ascendant)]
}

/// Experiments of random levels, order 1 to 5 and spacing up to three beyond the least, on a given interval.
fn experiment(interval: Interval) -> impl Strategy<Value = PulseExperiment> {
    let fractions = btree_set(1..1000u32, 0..16);
    (direction(), fractions, 1..=5usize, 0..=3usize).prop_map(move |(direction, fractions, order, extra)| {
        let (start, satellite) = (direction.opposite(interval), direction.satellite(interval));
        let inner = fractions.into_iter().map(|k| start + (satellite - start) * f64::from(k) / 1000.0);
        let levels = std::iter::once(start).chain(inner).collect();
        let experiment = PulseExperiment::with_levels(interval, direction, levels, order).unwrap();
        experiment.with_spacing_unmasked(order.max(2) + extra).unwrap()
    })
}

fn any_experiment() -> impl Strategy<Value = PulseExperiment> {
    crate::support::interval().prop_flat_map(experiment)
}

proptest! {
    #[test]
    fn a_pulse_experiment_masks_the_memory(
        (hysteresis, experiment) in crate::support::hysteresis().prop_flat_map(|h| {
            let experiment = experiment(h.interval());
            (Just(h), experiment)
        }),
    ) {
        let v = experiment.record_input(3 * experiment.period());
        let u = hysteresis.output(&v, f64::NAN);
        let (held, visited) = match experiment.direction() {
            Direction::Descendant => (hysteresis.u_high(), Branch::Descending),
            Direction::Ascendant => (hysteresis.u_low(), Branch::Ascending),
        };
        prop_assert_eq!(experiment.direction().visited_branch(), visited);
        for t in LOADING..v.len() {
            let table = if v[t] == experiment.satellite() { held } else { hysteresis.border(visited, v[t]) };
            prop_assert_eq!(u[t], table);
        }
    }

    #[test]
    fn each_level_is_visited_once_a_period_and_at_its_phase(experiment in any_experiment()) {
        let (s, m, period) = (experiment.spacing(), experiment.points(), experiment.period());
        prop_assert_eq!(period, s * (m + 3));
        prop_assert_eq!(experiment.visit_phase(0), 2 * s);
        for j in 1..m {
            // τ_j = (2 + j)s of (3.1), whose levels count from 1.
            prop_assert_eq!(experiment.visit_phase(j), (2 + (j + 1)) * s);
        }
        let mut expected = vec![experiment.satellite(); period];
        for (j, &level) in experiment.levels().iter().enumerate() {
            expected[experiment.visit_phase(j)] = level;
        }
        let v = experiment.record_input(2 * period);
        prop_assert_eq!(v[0], experiment.levels()[0]);
        prop_assert_eq!(&v[LOADING..LOADING + period], &expected[..]);
        prop_assert_eq!(&v[LOADING + period..], &expected[..]);
    }

    #[test]
    fn the_lagged_pulses_of_all_visits_have_disjoint_supports(experiment in any_experiment()) {
        let mut active = BTreeSet::new();
        for j in 0..experiment.points() {
            for lag in 1..=experiment.order() {
                prop_assert!(active.insert((experiment.visit_phase(j) + lag) % experiment.period()));
            }
        }
    }

    #[test]
    fn evenly_spaced_levels_are_ordered_and_stop_one_step_short_of_the_satellite(
        interval in crate::support::interval(), direction in direction(), m in 1..=64usize, order in 1..=5usize,
    ) {
        let experiment = PulseExperiment::evenly_spaced(interval, direction, m, order).unwrap();
        prop_assert_eq!(experiment.points(), m);
        prop_assert_eq!(experiment.spacing(), order.max(2));
        let step = interval.width() / m as f64;
        for (j, level) in experiment.levels().iter().enumerate() {
            let distance = (level - direction.opposite(interval)).abs();
            prop_assert!((distance - j as f64 * step).abs() < 1e-12 * (1.0 + interval.high().abs() + interval.width()));
        }
    }

    #[test]
    fn a_step_experiment_loads_the_border_and_holds_it(
        hysteresis in crate::support::hysteresis(), direction in direction(), samples in 0..40usize,
    ) {
        let v = StepExperiment::at_satellite_of(direction, hysteresis.interval()).record_input(samples);
        let u = hysteresis.output(&v, f64::NAN);
        let held = match direction {
            Direction::Descendant => hysteresis.u_high(),
            Direction::Ascendant => hysteresis.u_low(),
        };
        prop_assert_eq!(u.len(), samples + LOADING);
        prop_assert!(u[LOADING..].iter().all(|&now| now == held));
    }
}

#[test]
fn visits_on_adjacent_samples_put_u_on_the_wrong_border() {
    let interval = Interval::new(-1.0, 1.0).unwrap();
    let spring = LeafSpring::constant(1.0, 0.5).unwrap();
    let hysteresis = SwitchedHysteresis::new(interval, Box::new(spring)).unwrap();
    let experiment = PulseExperiment::evenly_spaced(interval, Direction::Descendant, 4, 1).unwrap();
    let experiment = experiment.with_spacing_unmasked(1).unwrap();

    let u = hysteresis.output(&experiment.record_input(experiment.period()), 0.0);
    let at = |j: usize| u[LOADING + experiment.visit_phase(j)];
    let border = |branch, j: usize| hysteresis.border(branch, experiment.levels()[j]);
    assert_eq!(at(1), border(Branch::Descending, 1), "V₂ is still reached by a fall");
    assert_eq!(at(2), border(Branch::Ascending, 2), "V₃ is reached by a rise from V₂");
    assert_eq!(at(3), border(Branch::Ascending, 3));
}
