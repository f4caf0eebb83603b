//! Differences between both sides of a comparison in the user's units.

use super::Units;
use std::f64::consts::TAU;
use switchback_diagnose::differences::{Row, RowKind};
use switchback_model::system::Unit;

/// A row of the table of differences as its user would state it.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportedDifference {
    /// The quantity.
    pub what: String,
    /// The effect whose parameter it is, where it is one.
    pub effect: Option<&'static str>,
    /// Whether it is a value that both sides have, or an effect of either.
    pub kind: RowKind,
    /// Its value in what was compared with the machine; NaN for the shape of an effect that this lacks.
    pub in_a: f64,
    /// Its value in the machine.
    pub in_b: f64,
    /// Standard error of the latter.
    pub se: f64,
    /// Unit of all three; empty for a pure number.
    pub unit: String,
    /// Probability that it differs.
    pub probability: f64,
    /// Whether it differs.
    pub differs: bool,
    /// Share of the gap that would stay without it, all others fitted again.
    pub closure: f64,
    /// The attribute of a MuJoCo joint that it is.
    pub attribute: Option<&'static str>,
}

impl ReportedDifference {
    /// A row in the units of a rig.
    pub fn of(row: &Row, units: &Units) -> Self {
        let (factor, unit) = scaled(row.unit, units);
        Self {
            what: row.what.clone(),
            effect: row.effect,
            kind: row.kind,
            in_a: factor * row.in_a,
            in_b: factor * row.in_b,
            se: factor * row.se,
            unit,
            probability: row.probability,
            differs: row.differs,
            closure: row.closure,
            attribute: attribute(&row.what),
        }
    }
}

/// The factor from the units of a system to those of its user, and their name.
fn scaled(unit: Unit, units: &Units) -> (f64, String) {
    let Units { input, output, sample_time, .. } = units;
    match unit {
        Unit::One => (1.0, String::new()),
        Unit::Input => (1.0, input.clone()),
        Unit::Output => (1.0, output.clone()),
        Unit::Samples => (*sample_time, "s".to_owned()),
        Unit::OutputPerInput => (1.0, format!("{output}/{input}")),
        Unit::OutputPerSquaredInput => (1.0, format!("{output}/{input}²")),
        Unit::OutputPerSpeed => (*sample_time, format!("{output}·s/{input}")),
        Unit::OutputPerAcceleration => (sample_time * sample_time, format!("{output}·s²/{input}")),
        Unit::Speed => (1.0 / sample_time, format!("{input}/s")),
        Unit::Frequency => (1.0 / (TAU * sample_time), "Hz".to_owned()),
    }
}

/// The attributes of a joint in MuJoCo's model files.
fn attribute(what: &str) -> Option<&'static str> {
    Some(match what {
        "friction" => "frictionloss",
        "damping" => "damping",
        "inertia" => "armature",
        "stiffness" => "stiffness",
        _ => return None,
    })
}
