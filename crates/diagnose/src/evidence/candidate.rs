//! Candidates and their columns.

use super::context::Signal;
use switchback_model::system::Term;

/// One shape of an effect: columns with free coefficients.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) effect: &'static str,
    /// Numbers of its columns.
    pub(super) columns: Vec<usize>,
    /// The law at its start, where it has one.
    pub(super) term: Option<Term>,
}

/// Candidates and their columns.
#[derive(Debug, Clone, Default)]
pub(super) struct Candidates {
    pub(super) all: Vec<Candidate>,
    pub(super) columns: Vec<Signal>,
}

impl Candidates {
    pub(super) fn add(&mut self, signal: Signal) -> usize {
        self.columns.push(signal);
        self.columns.len() - 1
    }

    pub(super) fn group(&mut self, effect: &'static str, columns: Vec<usize>) {
        self.all.push(Candidate { effect, columns, term: None });
    }
}
