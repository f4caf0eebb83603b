//! What stands in for a cause that the library lacks is not named.

use switchback_gap::{Effect, Model, Settings, Status, diagnose};
use switchback_maker::{Family, Ingredient, MakeRig};

#[test]
fn a_jump_of_the_borders_at_one_place_is_no_outliers() {
    let jump = Ingredient::plain("border_resolution", 2.0).unwrap();
    let family = Family { order: Some(3), shape: None };
    let rig = MakeRig::new(17070360193571593099).family(family).with(jump).make().unwrap().rig;
    let mut settings = Settings::default();
    settings.effects.retain(|effect| *effect != Effect::BorderResolution);
    let diagnosis = diagnose(&rig, Model::Identify, &settings).unwrap();
    assert_eq!(diagnosis.verdict.status, Status::Unexplained, "{:?}", diagnosis.verdict);
}
