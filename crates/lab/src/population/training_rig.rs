//! A rig to learn from.

use super::family::Family;
use crate::generate::injection::Base;
use crate::generate::{InjectionError, TrueEffect};
use switchback_model::rig::Rig;

/// What a rig was made to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Nothing: the machine with the errors that it has by itself.
    Nothing,
    /// One effect, perhaps with a much smaller second one.
    One,
    /// Two effects of much the same size.
    Pair,
    /// An effect that no library of causes knows.
    Foreign,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Nothing, Self::One, Self::Pair, Self::Foreign];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::One => "one",
            Self::Pair => "pair",
            Self::Foreign => "foreign",
        }
    }
}

/// What is true of a training rig.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingTruth {
    /// What it was made to show.
    pub kind: Kind,
    /// What was put in, the largest first. The size of each is its own, in the unit of `size`.
    pub effects: Vec<TrueEffect>,
    /// Root mean square of what all effects change in the held-out residuals after identification anew, to first order, over that of the
    /// residuals without them.
    pub size: f64,
    /// Where the rig comes from.
    pub family: Family,
    /// Name of the measured base; of a made rig its family.
    pub base: String,
    /// Names of what the machine has by itself. Whoever names one of these is not wrong.
    pub own: Vec<&'static str>,
    /// Order of the machine's linear part.
    pub order: usize,
    /// Kind of borders.
    pub borders: &'static str,
    /// Noise and model errors as a share of the output's standard deviation.
    pub noise: f64,
}

impl TrainingTruth {
    /// The effect with the largest size.
    pub fn label(&self) -> Option<&'static str> {
        self.effects.first().map(|effect| effect.effect)
    }
}

/// Size below which an effect leaves no trace that anybody could name: what changes less than a third of the noise adds a twentieth to its energy.
const FAINT: f64 = 0.33;

/// A rig to learn from.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingRig {
    /// What a user's folder would hold. Where a model is given, each record has its prediction.
    pub rig: Rig,
    /// The same records without effects: the same inputs, noise and model errors. A model given beforehand is one of these.
    pub before: Rig,
    /// Whether a model is given.
    pub is_given: bool,
    /// What is withheld.
    pub truth: TrainingTruth,
}

impl TrainingRig {
    /// The size as the program's own identification has it: the model identified from `before`, its structure kept, against one identified anew.
    ///
    /// # Errors
    /// [`InjectionError`] where the records give no model or leave nothing.
    pub fn identified_size(&self) -> Result<f64, InjectionError> {
        Ok(Base::new(&self.before)?.surviving(&self.rig))
    }

    /// The outcome that holds, of a size that survives identification anew: the effect with the largest size, `unexplained` of a foreign one, or `none` where what
    /// is left is too faint to be seen.
    pub fn outcome(&self, surviving: f64) -> Option<&'static str> {
        // A model that was given has absorbed nothing.
        let left = if self.is_given { self.truth.size } else { surviving };
        match self.truth.kind {
            _ if left < FAINT => Some("none"),
            Kind::Nothing => Some("none"),
            Kind::Foreign => Some("unexplained"),
            Kind::One | Kind::Pair => self.truth.label(),
        }
    }

    /// Names that are not wrong: of all effects that were put in, and of those that the machine has by itself.
    pub fn true_names(&self) -> Vec<&'static str> {
        self.truth.effects.iter().map(|effect| effect.effect).chain(self.truth.own.iter().copied()).collect()
    }

    /// What survives identification anew, to first order or as the program identifies: the less. The latter chooses order and delay, too.
    pub fn surviving_size(&self) -> f64 {
        let first_order = self.truth.size;
        let identified = (first_order > 0.0).then(|| self.identified_size().ok()).flatten();
        identified.map_or(first_order, |identified| identified.min(first_order))
    }
}
