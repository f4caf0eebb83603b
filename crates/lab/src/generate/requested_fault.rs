//! An effect to be put into a rig.

use crate::generate::effects::laws_of;
use crate::generate::key::TrueEffect;
use crate::generate::law::Law;
use crate::generate::make_error::MakeError;

/// An effect to be put into a rig.
#[derive(Debug, Clone, Copy)]
pub struct RequestedFault {
    /// Its law.
    pub law: &'static dyn Law,
    /// Whether that is the plain one.
    pub plain: bool,
    /// Size of all effects together.
    pub size: f64,
}

impl RequestedFault {
    /// The plain law of an effect, at a size in noise standard deviations.
    ///
    /// # Errors
    /// [`MakeError::UnknownEffect`] or [`MakeError::Size`].
    pub fn plain(effect: &str, size: f64) -> Result<Self, MakeError> {
        Self::with_law(effect, 0, size)
    }

    /// The `law`-th law of an effect (0 is the plain one).
    ///
    /// # Errors
    /// [`MakeError::UnknownEffect`], [`MakeError::UnknownLaw`] or [`MakeError::Size`].
    pub fn with_law(effect: &str, law: usize, size: f64) -> Result<Self, MakeError> {
        let laws = laws_of(effect);
        if laws.is_empty() {
            let known = crate::generate::EFFECTS
                .iter()
                .chain(&crate::generate::FOREIGN)
                .copied()
                .collect::<Vec<_>>()
                .join(", ");
            return Err(MakeError::UnknownEffect { name: effect.to_owned(), known });
        }
        if !(size.is_finite() && size > 0.0) {
            return Err(MakeError::Size(size));
        }
        let chosen = laws.get(law).ok_or_else(|| MakeError::UnknownLaw {
            effect: effect.to_owned(),
            laws: laws.len(),
            law,
        })?;
        Ok(Self { law: *chosen, plain: law == 0, size })
    }

    /// What is true of it once its magnitude is found, and what size that makes.
    pub(crate) fn found(&self, magnitude: f64, size: f64) -> TrueEffect {
        TrueEffect {
            effect: self.law.effect(),
            law: self.law.name(),
            plain: self.plain,
            stage: self.law.stage(),
            nature: self.law.nature(),
            magnitude,
            unit: self.law.unit(),
            quantity: self.law.quantity(),
            wanted: self.size,
            size,
        }
    }
}
