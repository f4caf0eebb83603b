//! What is asked of an identification.

use super::Method;

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

impl From<Method> for Request {
    fn from(method: Method) -> Self {
        Self { method, causal: false }
    }
}
