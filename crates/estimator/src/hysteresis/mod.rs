//! The switched hysteresis operator (2.3) and the kinds of borders it can run on.

mod interval;
mod operator;

pub use interval::{Interval, IntervalError};
pub use operator::{HysteresisError, SwitchedHysteresis};

use std::fmt::Debug;

/// Which of the two borders the working point runs on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Branch {
    /// `C_a`, taken while `v` rises.
    Ascending,
    /// `C_d`, taken while `v` falls.
    Descending,
}

/// The two borders of a switched hysteresis, as functions of the input `v` (input units → `u` units).
pub trait BorderPair: Debug + Send + Sync {
    /// The ascending border `C_a(v)`.
    fn ascending(&self, v: f64) -> f64;

    /// The descending border `C_d(v)`.
    fn descending(&self, v: f64) -> f64;
}
