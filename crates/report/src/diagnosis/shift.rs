//! A held-out recording with another zero or gain, in a sentence and in JSON.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_io::diagnosis::{self, Estimate, Units, with_interval};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Shift {
    /// The recording.
    pub record: String,
    /// The constant that its output is above, output units; null where its zero is the same.
    pub offset: Option<Estimated>,
    /// The factor by which its output is larger; null where its gain is the same.
    pub gain: Option<Estimated>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Estimated {
    /// The estimate.
    pub value: f64,
    /// Half the width of its 95 % interval, by a block bootstrap.
    pub half_width: f64,
}

impl Shift {
    pub(super) fn of(shift: &diagnosis::Shift) -> Self {
        let written = |e: Estimate| Estimated { value: e.value, half_width: e.half_width };
        Self {
            record: shift.record.clone(),
            offset: shift.offset.map(written),
            gain: shift.gain.map(written),
        }
    }
}

/// A held-out recording with another zero or gain.
pub(super) fn sentence(shift: &diagnosis::Shift, units: &Units) -> String {
    let value = |e: &Estimate, x: f64| with_interval(x, [x - e.half_width, x + e.half_width]);
    let offset = shift.offset.as_ref().map(|e| {
        let side = if e.value < 0.0 { "below" } else { "above" };
        format!("lies {} {} {side}", value(e, e.value.abs()), units.output)
    });
    let gain = shift.gain.as_ref().map(|e| format!("is {} times", value(e, e.value)));
    let (differs, is) = match (gain, offset) {
        (Some(gain), Some(offset)) => (format!("{gain} as large and {offset}"), "gain and zero are others"),
        (Some(gain), None) if shift.gain.is_some_and(|g| g.value < 0.0) => (gain, "sign is another"),
        (Some(gain), None) => (gain, "gain is another"),
        (None, offset) => (offset.unwrap_or_default(), "zero is another"),
    };
    format!(
        "The output of {} {differs} that of the model of the fit records: its {is}. All that follows is without this \
         difference.",
        shift.record
    )
}
