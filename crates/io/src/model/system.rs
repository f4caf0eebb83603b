//! A model that runs.

use super::curves::Curves;
use super::machine::Machine;
use super::points::Points;
use schemars::JsonSchema;
use serde::Serialize;
use switchback_diagnose::PortableModel;

/// A model that runs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum System {
    /// Of `gap`: borders with effects.
    Switched(Box<PortableModel>),
    /// Of the methods for any record: piecewise-linear curves.
    Curves(Curves),
    /// Of a comparison: a source with the values of a machine.
    Machine(Box<Machine>),
    /// Of the methods for pulse experiments: points of the borders.
    Points(Points),
}

impl System {
    /// The name of its form.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Switched(_) => "switched",
            Self::Curves(_) => "curves",
            Self::Machine(_) => "machine",
            Self::Points(_) => "points",
        }
    }

    /// Whether the errors of its parameters are known.
    pub(crate) fn has_covariance(&self) -> bool {
        match self {
            Self::Switched(model) => model.has_covariance(),
            Self::Curves(model) => model.covariance().is_some(),
            Self::Machine(_) => false,
            Self::Points(model) => model.covariance().is_some(),
        }
    }
}
