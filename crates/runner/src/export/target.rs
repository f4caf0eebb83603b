//! What a model may be exported to.

/// A language or format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Target {
    /// One file that needs NumPy and nothing else
    Python,
    /// One C99 header without allocation
    C,
    /// A co-simulation FMU of FMI 2.0 for this platform
    Fmu,
}

impl Target {
    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Python => "py",
            Self::C => "h",
            Self::Fmu => "fmu",
        }
    }
}
