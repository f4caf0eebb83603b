//! What is asked of an identification.

use super::{Method, default_method};
use switchback_model::rig::Rig;

/// A method and what its model must be able to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// The method.
    pub method: Method,
    /// Whether the model must be able to run in real time: `y(t)` from `v` up to `t` alone.
    ///
    /// A direct term may stay, since `v(t)` is at hand when `y(t)` is wanted. No coefficient weighs a later sample, and a reversal takes effect at the
    /// sample that confirms it rather than at the extremum before, which only later samples show.
    pub causal: bool,
}

impl Request {
    /// A request of a rig: the method asked for, else the [best](default_method) that the records allow.
    pub fn new(rig: &Rig, method: Option<Method>, causal: bool) -> Self {
        Self { method: method.unwrap_or_else(|| default_method(rig)), causal }
    }
}

impl From<Method> for Request {
    fn from(method: Method) -> Self {
        Self { method, causal: false }
    }
}
