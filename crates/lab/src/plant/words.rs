//! What was put in, in words.

use crate::generate::{InjectedFault, OBSERVABLE};
use std::fmt::Write;

/// Effect, law, magnitude and size; `unit` is that of the output.
pub fn words(fault: &InjectedFault, unit: &str) -> String {
    let how = if fault.injection.is_exact() {
        "changed in the records themselves"
    } else {
        "carried by a model, as if it did not interact with what that misses"
    };
    let mut text = format!(
        "{} ({}, {}): {:.4} {}, {how}\n",
        fault.effect,
        fault.law,
        fault.stage.name(),
        fault.magnitude,
        fault.unit
    );
    let _ = writeln!(
        text,
        "size {:.2}: what is left of it when the model is identified anew, over the residual without it, {:.4} {unit}",
        fault.size, fault.residual
    );
    let _ = writeln!(text, "raw size {:.2}: what a model given beforehand misses because of it", fault.raw);
    if (fault.size / fault.wanted - 1.0).abs() > 0.1 {
        let _ = writeln!(text, "(asked for {}; this law and these records go no closer)", fault.wanted);
    }
    if !fault.is_observable() {
        let _ = writeln!(text, "(below {OBSERVABLE} it is not observable in these records)");
    }
    text
}
