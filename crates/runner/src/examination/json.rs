//! Measures, shares and bins in results.json.

use super::calibration::CalibrationBin;
use super::measure::{Bound, Measure, Share};
use serde_json::{Value, json};

/// One line of the summary.
pub fn measure_json(measure: &Measure) -> Value {
    json!({
        "key": measure.key, "measure": measure.text, "must_reach": measure.target.map(bound),
        "expected": measure.expected.map(bound), "reached": measure.reached, "interval": measure.interval,
        "rigs": measure.rigs, "meets": measure.meets_target(),
    })
}

/// A share with its counts.
pub fn share_json(share: Share) -> Value {
    json!({"share": share.value(), "count": share.count, "of": share.of})
}

/// Bins of a calibration.
pub fn bins_json(bins: &[CalibrationBin]) -> Vec<Value> {
    bins.iter().map(|b| json!({"claimed": b.claimed, "held": share_json(b.held)})).collect()
}

fn bound(bound: Bound) -> Value {
    match bound {
        Bound::AtLeast(x) => json!({"at_least": x}),
        Bound::AtMost(x) => json!({"at_most": x}),
        Bound::Within(low, high) => json!({"within": [low, high]}),
    }
}
