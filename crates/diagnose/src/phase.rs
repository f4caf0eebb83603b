//! How far a diagnosis has come.

/// What a diagnosis is doing. Phases come in this order; one that is founded on another model in between goes back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Phase {
    /// Identifying the nominal model, its order and its delay.
    Nominal,
    /// Fitting each effect on its own.
    Effects,
    /// Fitting two effects together.
    Pairs,
    /// Telling what each candidate closes and how certain its parameters are.
    Report,
}

impl Phase {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nominal => "identifying the nominal model",
            Self::Effects => "fitting each effect",
            Self::Pairs => "fitting pairs of effects",
            Self::Report => "measuring what they close",
        }
    }
}
