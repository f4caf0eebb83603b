//! What stands in for a cause that the library lacks is not named.

use switchback_diagnose::{Effect, Model, Settings, Status, Verdict, diagnose};
use switchback_lab::generate::{Family, MakeRig, RequestedFault};

/// The verdict on a rig with the first of some effects by a library that lacks all of them.
fn verdict_without(effects: &[Effect], seed: u64, order: usize) -> Verdict {
    let cause = RequestedFault::plain(effects[0].name(), 2.0).unwrap();
    let family = Family { order: Some(order), shape: None };
    let rig = MakeRig::new(seed).family(family).with(cause).make().unwrap().rig;
    let settings = Settings::default().without(effects);
    diagnose(&rig, Model::Identify, &settings).unwrap().verdict
}

#[test]
fn a_jump_of_the_borders_at_one_place_is_no_outliers() {
    let verdict = verdict_without(&[Effect::BorderResolution], 17070360193571593099, 3);
    assert_eq!(verdict.status, Status::Unexplained, "{verdict:?}");
}

/// It passes for a gain that turns about a zero far away, a creep that begins at will, a lag beside a pole that has become an integrator. A zero
/// that differs from record to record is its limit, and no other effect.
#[test]
fn a_drift_of_the_sensor_is_no_other_effect() {
    for (seed, order) in [(34, 1), (33, 3), (34, 3)] {
        let verdict = verdict_without(&[Effect::SensorDrift, Effect::RecordOffset], seed, order);
        assert_eq!(verdict.status, Status::Unexplained, "{seed} {order}: {verdict:?}");
    }
}
