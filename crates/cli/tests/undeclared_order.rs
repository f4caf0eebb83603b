//! A rig that declares no order: what colours the equation error is looked for before models are compared as simulators.

use crate::common::verdict_on_changed;
use serde_json::json;

#[test]
fn rounding_is_named_where_the_equation_error_is_far_from_white() {
    let what = ["--effect", "sensor_quantisation", "--size", "10", "--seed", "2", "--order", "3"];
    let verdict = verdict_on_changed(&what, |rig| rig.replace("order = 3\n", ""));
    assert_eq!(verdict["effects"], json!(["sensor_quantisation"]), "{verdict:#}");
}
