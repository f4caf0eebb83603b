//! What a model may be exported to.

/// A language or format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// One C99 header without allocation
    C,
    /// A co-simulation FMU of FMI 2.0 for this platform
    Fmu,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::C, Self::Fmu];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Fmu => "fmu",
        }
    }

    /// The target of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.name() == name)
    }

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::C => "h",
            Self::Fmu => "fmu",
        }
    }
}
