//! Properties of a whole dataset, against the operator by its definition.

use crate::support::hysteresis;
use proptest::prelude::*;
use std::collections::BTreeMap;
use switchback_identify::excitation::{Dataset, PlannedRecord, Reversals};
use switchback_model::hysteresis::{Branch, Interval, SwitchedHysteresis, output_by_definition};
use switchback_model::rig::Role;

fn dataset(hysteresis: &SwitchedHysteresis, order: usize, points: usize, periods: usize) -> Dataset {
    Dataset::new(hysteresis.interval(), order, points, periods)
        .expect("an interval wide enough for its levels")
}

fn record(records: &[PlannedRecord], role: Role) -> &PlannedRecord {
    records.iter().find(|record| record.role == role).expect("every role is there")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_input_stays_in_the_interval_and_moves(
        h in hysteresis(), order in 1..5usize, points in 1..12usize, periods in 3..9usize,
    ) {
        for record in dataset(&h, order, points, periods).records() {
            prop_assert!(record.v.iter().all(|v| h.interval().contains(*v)), "{}", record.name);
            prop_assert!(record.v[0] != record.v[1], "{}: the first move loads a border", record.name);
        }
    }

    #[test]
    fn every_level_is_visited_once_a_period_from_its_satellite_and_back(
        h in hysteresis(), order in 1..5usize, points in 1..12usize, periods in 3..9usize,
    ) {
        let plan = dataset(&h, order, points, periods);
        let records = plan.records();
        for (role, experiment) in [Role::Descendant, Role::Ascendant].into_iter().zip(plan.pulses()) {
            let v = &record(&records, role).v;
            let mut visits = BTreeMap::new();
            let mut last_visit = None;
            for t in 1..v.len() {
                if v[t] == experiment.satellite() {
                    continue;
                }
                *visits.entry(v[t].to_bits()).or_insert(0) += 1;
                prop_assert_eq!(v[t - 1], experiment.satellite());
                prop_assert!(v.get(t + 1).is_none_or(|next| *next == experiment.satellite()));
                prop_assert!(last_visit.is_none_or(|last| t - last >= order.max(2)));
                last_visit = Some(t);
            }
            prop_assert_eq!(visits.len(), points);
            for level in experiment.levels() {
                prop_assert_eq!(visits[&level.to_bits()], periods, "level {}", level);
            }
        }
    }

    #[test]
    fn every_visit_shows_its_border_and_every_return_the_end_of_the_other(
        h in hysteresis(), order in 1..4usize, points in 1..8usize,
    ) {
        let plan = dataset(&h, order, points, 3);
        let records = plan.records();
        let sides = [(Role::Descendant, Branch::Descending, h.u_high()), (Role::Ascendant, Branch::Ascending, h.u_low())];
        for ((role, branch, held), experiment) in sides.into_iter().zip(plan.pulses()) {
            let v = &record(&records, role).v;
            // An absurd value before the first move: none of it may be left after the loading move.
            let u = output_by_definition(&h, v, 1e9);
            for t in 1..v.len() {
                let expected =
                    if v[t] == experiment.satellite() { held } else { h.border(branch, v[t]) };
                prop_assert_eq!(u[t], expected, "{} at {}", role.name(), t);
            }
        }
        for (role, held) in [(Role::StepHigh, h.u_high()), (Role::StepLow, h.u_low())] {
            let u = output_by_definition(&h, &record(&records, role).v, 1e9);
            prop_assert!(u[1..].iter().all(|u| *u == held));
        }
    }

    #[test]
    fn a_free_drive_keeps_its_sizes_and_its_speed(
        h in hysteresis(), smallest in 0.01..0.3f64, seed in any::<u64>(), fastest in 0.01..0.5f64,
    ) {
        let width = h.interval().width();
        let drive = Reversals::new(h.interval())
            .with_sizes(smallest * width, width)
            .and_then(|drive| drive.with_fastest(fastest * width))
            .expect("settings in range");
        let plan = dataset(&h, 2, 4, 9).with_free(drive, seed);
        let [free, holdout] = [4, 5].map(|k| plan.records()[k].v.clone());
        for v in [free, holdout] {
            prop_assert!(v.iter().all(|v| h.interval().contains(*v)));
            prop_assert!(v.windows(2).all(|w| (w[1] - w[0]).abs() <= fastest * width * (1.0 + 1e-9)));
        }
    }
}

#[test]
fn the_held_out_record_is_drawn_anew_and_every_seed_anew() {
    let interval = Interval::new(-1.0, 1.0).expect("an interval");
    let plan = Dataset::new(interval, 2, 4, 9).expect("a plan");
    let drives = |seed| {
        let records = plan.clone().with_free(Reversals::new(interval), seed).records();
        [records[4].v.clone(), records[5].v.clone()]
    };
    let [[free, holdout], [other, _]] = [drives(1), drives(2)];
    assert_ne!(free[..holdout.len()], holdout[..]);
    assert_ne!(free, other);
    assert_eq!(free, drives(1)[0]);
}
