//! The fault that is asked for.

use crate::generate::{RecipeError, RequestedFault};

/// An effect, its law and its size.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The effect.
    pub effect: String,
    /// Which law of it, 0 being the plain one.
    pub law: usize,
    /// What survives identification anew, over the residual that the records' own model leaves on held-out ones.
    pub size: f64,
    /// What else there is to the effect is drawn from this.
    pub seed: u64,
}

impl Default for Request {
    fn default() -> Self {
        Self { effect: String::new(), law: 0, size: 2.0, seed: 1 }
    }
}

impl Request {
    /// Refuses a fault that there is not.
    ///
    /// # Errors
    /// [`RecipeError`] for an unknown effect or law, or a size that is none.
    pub fn check(&self) -> Result<(), RecipeError> {
        self.requested_fault().map(|_| ())
    }

    pub(super) fn requested_fault(&self) -> Result<RequestedFault, RecipeError> {
        Ok(RequestedFault::with_law(&self.effect, self.law, self.size)?)
    }
}
