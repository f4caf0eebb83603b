//! A method of others.

use crate::ForeignName;
use crate::results::Group;
use std::time::Duration;

/// A method of others, as a scenario states it.
#[derive(Debug, Clone, PartialEq)]
pub struct ForeignMethod {
    /// Unique in the scenario.
    pub name: ForeignName,
    /// Who estimates.
    pub program: Program,
    /// The parameters that it estimates, in the order of the results.
    pub groups: Vec<Group>,
    /// A replicate fails that has no answer within this time after the one before.
    pub patience: Duration,
    /// Whether each replicate is estimated once more from the same noise with its sign changed.
    pub antithetic: bool,
    /// Processes at once; as many as there are threads where none is given.
    pub workers: Option<usize>,
}

/// Who estimates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Program {
    /// A command with its arguments, at least one word.
    Command(Vec<String>),
    /// A function of whoever runs the study.
    Function,
}

impl ForeignMethod {
    /// A function that estimates all parameters.
    pub fn function(name: ForeignName) -> Self {
        Self {
            name,
            program: Program::Function,
            groups: Group::ALL.to_vec(),
            patience: PATIENCE,
            antithetic: true,
            workers: None,
        }
    }
}

/// Long enough for an interpreter to begin on a machine that is busy.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);
