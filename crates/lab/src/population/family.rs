//! Where a training rig comes from.

/// Where a training rig comes from: folds of a learner share no family.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// A machine of the laboratory with designed experiments.
    Laboratory,
    /// A machine of the field by [`MakeRig`](crate::generate::MakeRig)'s own draws.
    Field,
    /// A machine of wide draws: other orders, borders, drives, noises and errors than any other family's.
    Wide,
    /// Measured records as they are; faults are carried into them.
    Measured,
    /// Measured inputs and residuals around a machine near the measured one, or around one of wide draws.
    Resampled,
}

impl Family {
    /// All families.
    pub const ALL: [Self; 5] = [Self::Laboratory, Self::Field, Self::Wide, Self::Measured, Self::Resampled];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Laboratory => "laboratory",
            Self::Field => "field",
            Self::Wide => "wide",
            Self::Measured => "measured",
            Self::Resampled => "resampled",
        }
    }

    /// Whether its inputs were measured.
    pub fn is_measured(self) -> bool {
        matches!(self, Self::Measured | Self::Resampled)
    }
}
