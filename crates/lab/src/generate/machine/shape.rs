//! The shape of a rig's borders.

/// The shape that a rig's borders follow at the levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Two parallel lines, `k·x ± F_C`.
    LeafSpring,
    /// A spring that stiffens, `k(x)·x ± F_C`.
    HardeningSpring,
    /// Two steps, one a border.
    Relay,
    /// Two different smooth curves, as in the paper's Fig. 3; the loop closes at its ends.
    General,
    /// Lines with a jump between two levels.
    Discontinuous,
    /// Borders that rise and fall.
    NonMonotone,
}

impl Shape {
    /// All shapes.
    pub(crate) const ALL: [Self; 6] = [
        Self::LeafSpring,
        Self::HardeningSpring,
        Self::Relay,
        Self::General,
        Self::Discontinuous,
        Self::NonMonotone,
    ];

    /// Whether its borders bend.
    pub(super) fn is_curved(self) -> bool {
        matches!(self, Self::HardeningSpring | Self::General | Self::NonMonotone)
    }

    /// The shape's name in a key.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::LeafSpring => "leaf spring",
            Self::HardeningSpring => "hardening spring",
            Self::Relay => "relay",
            Self::General => "general",
            Self::Discontinuous => "discontinuous",
            Self::NonMonotone => "non-monotone",
        }
    }
}
