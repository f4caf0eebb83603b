//! The effect that a rig is to have.

use crate::generate::{MakeError, RequestedFault};

/// An effect that is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The effect.
    pub effect: &'static str,
    /// Which of its laws; 0 is the plain one.
    pub law: usize,
    /// What should survive identification anew.
    pub size: f64,
    /// Whether the maker puts it into the machine, rather than into its records.
    pub by_maker: bool,
}

impl Wanted {
    /// An effect by its plain law.
    pub(crate) fn plain(effect: &'static str, size: f64) -> Self {
        Self { effect, law: 0, size, by_maker: false }
    }

    /// What the maker needs to know.
    ///
    /// # Errors
    /// [`MakeError`] for an effect or law that does not exist.
    pub(crate) fn requested_fault(&self) -> Result<RequestedFault, MakeError> {
        RequestedFault::with_law(self.effect, self.law, self.size)
    }
}
