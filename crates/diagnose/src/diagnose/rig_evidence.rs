//! What evidence says of a rig by itself, asked once and only where it is needed.

use std::cell::OnceCell;
use switchback_model::rig::Rig;

use crate::evidence::Judged;
use crate::posterior::{Classification, PosteriorError};
use crate::settings::Settings;

/// A rig whose evidence may be asked for: it takes longer than fits of all effects where experiments were designed.
pub(super) struct RigEvidence<'a> {
    rig: &'a Rig,
    settings: &'a Settings,
    known: OnceCell<Classification>,
}

impl<'a> RigEvidence<'a> {
    pub(super) fn new(rig: &'a Rig, settings: &'a Settings) -> Self {
        Self { rig, settings, known: OnceCell::new() }
    }

    /// The probabilities by it; those of the prior, where the records show no nominal system.
    ///
    /// # Errors
    /// [`PosteriorError`] where the posterior was trained with other columns.
    pub(super) fn classification(&self) -> Result<&Classification, PosteriorError> {
        if let Some(known) = self.known.get() {
            return Ok(known);
        }
        let found = match Judged::identified(self.rig) {
            Ok(Some(judged)) => Classification::of(&judged, self.settings)?,
            Ok(None) | Err(_) => Classification::of_prior(self.settings),
        };
        Ok(self.known.get_or_init(|| found))
    }

    /// The prior alone.
    pub(super) fn prior(&self) -> Classification {
        Classification::of_prior(self.settings)
    }
}
