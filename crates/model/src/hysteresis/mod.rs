//! The switched hysteresis operator (2.3) and the kinds of borders it can run on.

mod border_error;
mod definition;
mod discontinuous;
mod general;
mod interval;
mod leaf_spring;
mod non_monotone;
mod operator;
mod relay;
mod straight_lines;
mod table;

pub use border_error::BorderError;
pub use definition::output_by_definition;
pub use discontinuous::Discontinuous;
pub use discontinuous::Piece;
pub use general::General;
pub use general::SaturatingCurve;
pub use interval::Interval;
pub use interval::IntervalError;
pub use leaf_spring::LeafSpring;
pub use non_monotone::NonMonotone;
pub use non_monotone::Wave;
pub use operator::HysteresisError;
pub use operator::SwitchedHysteresis;
pub use relay::Relay;
pub use straight_lines::Line;
pub use straight_lines::StraightLines;
pub use table::Table;
pub use table::TablePoint;

use std::fmt;

/// Which of the two borders the working point runs on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Branch {
    /// `C_a`, taken while `v` rises.
    Ascending,
    /// `C_d`, taken while `v` falls.
    Descending,
}

impl fmt::Display for Branch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ascending => "ascending",
            Self::Descending => "descending",
        })
    }
}

/// The two borders of a switched hysteresis, as functions of the input `v` (input units → `u` units).
///
/// Implementations are defined and finite for every `v` of a working interval of reasonable size;
/// [`SwitchedHysteresis::new`] joins them to an interval and checks Assumption 1 there.
pub trait BorderPair: fmt::Debug + Send + Sync {
    /// The ascending border `C_a(v)`.
    fn ascending(&self, v: f64) -> f64;

    /// The descending border `C_d(v)`.
    fn descending(&self, v: f64) -> f64;
}
