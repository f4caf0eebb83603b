//! What a verdict owes to the held-out records: a cause does them no harm, a gap that they do not show is none, and what a higher order
//! does is no cause.

use crate::bench::{input, output, played, record, response, rig, white};
use switchback_diagnose::{Effect, Model, Settings, Status, Verdict, diagnose};
use switchback_lab::generate::{MakeRig, RequestedFault};
use switchback_model::rig::{RigRecord, Usage};

/// A record of the bench's rig behind a play.
fn loose(name: &str, usage: Usage, (samples, phase): (usize, f64), play: f64) -> RigRecord {
    let v = input(samples, phase);
    let y = output(&played(&v, play));
    record(name, usage, v, y)
}

fn reported(order: Option<usize>, records: Vec<RigRecord>, settings: &Settings) -> Verdict {
    diagnose(&rig(order, records), Model::Identify, settings).expect("a diagnosis").verdict
}

fn names(verdict: &Verdict, effect: Effect) -> bool {
    verdict.effects.contains(&effect) || verdict.class.contains(&effect)
}

#[test]
fn a_cause_that_degrades_validation_one_held_out_record_is_out_whatever_another_one_gains() {
    let records = |tight: f64| {
        vec![
            loose("sweep", Usage::Fit, (3000, 0.0), 0.3),
            loose("drive", Usage::Holdout, (2000, 1.0), 0.3),
            loose("after the repair", Usage::Holdout, (1000, 2.0), tight),
        ]
    };
    let lasting = reported(Some(1), records(0.3), &Settings::default());
    assert!(names(&lasting, Effect::Backlash) && lasting.calibrated, "{lasting:?}");
    let repaired = reported(Some(1), records(0.0), &Settings::default());
    assert!(!names(&repaired, Effect::Backlash), "{repaired:?}");
}

#[test]
fn what_no_held_out_record_shows_is_no_gap() {
    // The size of the noise moves no simulation, and no candidate has it: it is found one step ahead, where it does no harm.
    let noise = RequestedFault::plain("proportional_noise", 2.0).expect("an effect of the maker");
    let rig = MakeRig::new(3).with(noise).make().expect("a rig can be made of this seed").rig;
    let diagnosis = diagnose(&rig, Model::Identify, &Settings::default()).expect("a diagnosis");
    let reported = (diagnosis.verdict.status, diagnosis.probability_none, diagnosis.probability_unexplained);
    assert!(diagnosis.gap.before.ci90[0] <= 0.0, "{:?}", diagnosis.gap);
    assert!(reported.0 == Status::None && reported.1 < 0.5 && reported.2 > 0.3, "{reported:?}");
}

#[test]
fn what_a_higher_order_does_is_no_cause() {
    // Two lightly damped poles, and room for one.
    let a = [-1.5, 0.85];
    let ringing = |name: &str, usage, (samples, phase): (usize, f64), seed| {
        let mut white = white(seed);
        let v = input(samples, phase);
        let y = response(&v, &a, &mut || 0.01 * white());
        record(name, usage, v, y)
    };
    let records =
        vec![ringing("sweep", Usage::Fit, (3000, 0.0), 1), ringing("drive", Usage::Holdout, (1500, 1.0), 2)];
    let settings = Settings { max_order: 1, ..Settings::default() };
    let verdict = reported(None, records, &settings);
    assert!(verdict.effects.is_empty() && verdict.class.is_empty(), "{verdict:?}");
}

#[test]
fn the_colour_of_noise_is_a_cause_only_where_it_is_asked_for_or_the_order_is_known() {
    let coloured = |name: &str, usage: Usage, (samples, phase): (usize, f64), seed: u64| {
        let (v, mut white, mut error) = (input(samples, phase), white(seed), 0.0);
        let mut noise = || {
            error = 0.9 * error + 0.01 * white();
            error
        };
        let y = response(&v, &[-0.6], &mut noise);
        record(name, usage, v, y)
    };
    let records = || {
        vec![coloured("sweep", Usage::Fit, (3000, 0.0), 5), coloured("drive", Usage::Holdout, (1500, 1.0), 6)]
    };
    // A second pole would take the colour.
    let plain = Settings { max_order: 1, ..Settings::default() };
    let in_the_field = reported(None, records(), &plain);
    assert_eq!(in_the_field.status, Status::None, "{in_the_field:?}");
    for (order, settings) in [(None, plain.clone().asking(&[Effect::ColouredNoise])), (Some(1), plain)] {
        let verdict = reported(order, records(), &settings);
        assert_eq!(verdict.effects, [Effect::ColouredNoise], "{verdict:?}");
    }
}
