//! Kinds of texts, by the most bytes that one may have.

/// A kind of text that is read whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextKind {
    /// A rig file, a scenario, the label of a part: a person could write it. 16 MiB.
    Settings,
    /// A model, or the description of an FMU: tables of numbers among words. 128 MiB.
    Model,
    /// Results, figures and series of a report: a study of a thousand cells has a few million bytes. 512 MiB.
    Results,
}

impl TextKind {
    /// Most bytes of such a text.
    pub const fn most(self) -> u64 {
        match self {
            Self::Settings => 16 << 20,
            Self::Model => 128 << 20,
            Self::Results => 512 << 20,
        }
    }
}
