//! What can be wrong with a rig, all of it reported at once.

use crate::input::{FileError, TomlError};
use miette::{Diagnostic, LabeledSpan, SourceCode};
use std::collections::HashSet;
use std::fmt::{self, Display};
use switchback_table::table::{DataError, TableError};
use thiserror::Error;

/// One thing that is wrong. Each message names file, place and remedy.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum RigProblem {
    /// A file could not be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// Something in the rig file is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Toml(#[from] TomlError),
    /// Something in a file of measurements is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Data(#[from] DataError),
    /// What was asked for on the command line does not go together.
    #[error("{message}")]
    #[diagnostic(help("{remedy}"))]
    Asked {
        /// What is wrong.
        message: String,
        /// What to do about it.
        remedy: String,
    },
}

impl From<TableError> for RigProblem {
    fn from(error: TableError) -> Self {
        match error {
            TableError::File(error) => Self::File(error),
            TableError::Data(error) => Self::Data(error),
        }
    }
}

/// Why a rig could not be read: everything that was found wrong.
#[derive(Debug, Error)]
pub struct RigError {
    /// At least one.
    problems: Vec<Listed>,
}

/// A problem in a list.
#[derive(Debug, Error)]
#[error("{problem}")]
struct Listed {
    problem: RigProblem,
    /// Whether one before has the same remedy, which is then reported there only.
    is_reported: bool,
}

impl Diagnostic for Listed {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        if self.is_reported { None } else { self.problem.help() }
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.problem.source_code()
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.problem.labels()
    }
}

impl RigError {
    /// # Panics
    /// Without a problem.
    pub fn new(problems: Vec<RigProblem>) -> Self {
        assert!(!problems.is_empty(), "an error says what is wrong");
        let mut reported = HashSet::new();
        let listed = problems.into_iter().map(|problem| {
            let remedy = problem.help().map(|remedy| remedy.to_string());
            Listed { is_reported: remedy.is_some_and(|remedy| !reported.insert(remedy)), problem }
        });
        Self { problems: listed.collect() }
    }

    /// All that is wrong, at least one thing.
    pub fn problems(&self) -> impl Iterator<Item = &RigProblem> {
        self.problems.iter().map(|listed| &listed.problem)
    }

    /// The problem, where it is the only one.
    fn only(&self) -> Option<&RigProblem> {
        match &self.problems[..] {
            [only] => Some(&only.problem),
            _ => None,
        }
    }
}

impl<P: Into<RigProblem>> From<P> for RigError {
    fn from(problem: P) -> Self {
        Self::new(vec![problem.into()])
    }
}

impl Display for RigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.only() {
            Some(problem) => problem.fmt(f),
            None => write!(f, "{} things are wrong", self.problems.len()),
        }
    }
}

impl Diagnostic for RigError {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.only().and_then(Diagnostic::help)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.only().and_then(Diagnostic::source_code)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.only().and_then(Diagnostic::labels)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        match self.only() {
            Some(_) => None,
            None => Some(Box::new(self.problems.iter().map(|problem| problem as &dyn Diagnostic))),
        }
    }
}
