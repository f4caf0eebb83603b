//! Why a rig could not be identified.

use super::Method;
use miette::Diagnostic;
use std::path::Path;
use thiserror::Error;

/// Why a method found no system.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum IdentificationError {
    /// The rig lacks an experiment that the method is made for.
    #[error("{rig}: the method {method} needs {needed} among the fit records")]
    #[diagnostic(help(
        "choose `--method free`, which takes any record, or add a [[record]] with that `role` and `use = \"fit\"` to a rig file"
    ))]
    MissingExperiment {
        /// The rig's name, or its file where that is known.
        rig: String,
        /// The method asked for.
        method: Method,
        /// The role that is missing.
        needed: &'static str,
    },
    /// The method refused the records.
    #[error("{rig}: the method {method} cannot identify from these records: {reason}")]
    #[diagnostic(help("{remedy}"))]
    Refused {
        /// The rig's name, or its file where that is known.
        rig: String,
        /// The method used.
        method: Method,
        /// What it said.
        reason: String,
        /// What to try.
        remedy: String,
    },
    /// The result simulates every record worse than a constant would.
    #[error("{rig}: what the method {method} found is of no use: {reported}")]
    #[diagnostic(help(
        "check that the columns hold the input and the output of one machine, look for drift between the records, or set another `order` in a rig file"
    ))]
    Useless {
        /// The rig's name, or its file where that is known.
        rig: String,
        /// The method used.
        method: Method,
        /// What the free runs came to.
        reported: String,
    },
}

impl IdentificationError {
    /// Names the rig by its file, which a message should lead to.
    pub fn in_file(mut self, file: &Path) -> Self {
        let (Self::MissingExperiment { rig, .. } | Self::Refused { rig, .. } | Self::Useless { rig, .. }) =
            &mut self;
        *rig = file.display().to_string();
        self
    }
}
