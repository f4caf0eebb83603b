//! An examination, ready to run.

use super::case::Case;
use super::design::Design;
use super::examiner::Examiner;
use super::field::{self, Bases};
use super::laboratory;
use super::report::Report;
use super::scenario::Study;
use super::scores::Scores;
use super::sealed::{Key, Sealed, WrittenKeys};
use super::ticket::{Ticket, tickets};
use crate::generate::MakeError;
use miette::Diagnostic;
use rayon::prelude::*;
use switchback_diagnose::diagnose;
use thiserror::Error;

/// An examination, ready to run. Nothing that it gives depends on the number of threads.
#[derive(Debug)]
pub struct Examination<'a> {
    study: Study,
    rigs: field::Rigs<'a>,
    examiner: Examiner,
}

/// Why a study stopped.
#[derive(Debug, Error, Diagnostic)]
#[error("a rig of the study could not be made: {0}")]
#[diagnostic(help("this is a mistake of the program; another seed may avoid it"))]
struct StudyError(#[from] MakeError);

impl<'a> Examination<'a> {
    /// An examination of the program's own diagnosis; the laboratory has no bases.
    pub fn new(study: Study, bases: &'a Bases) -> Self {
        Self::of(diagnose, study, bases)
    }

    /// The same of any diagnosis.
    pub fn of(examiner: Examiner, study: Study, bases: &'a Bases) -> Self {
        Self { study, rigs: field::Rigs::new(bases), examiner }
    }

    /// Its scenario.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Rigs to be made, in random order.
    pub fn tickets(&self) -> Vec<Ticket> {
        tickets(&self.study, self.rigs.bases)
    }

    /// Makes rigs in parallel and keeps their keys; `before` is the text of a key file that the same program wrote, or empty. `done` hears of
    /// each rig.
    ///
    /// # Errors
    /// A rig that cannot be made.
    pub fn seal(
        &self,
        tickets: Vec<Ticket>,
        before: &str,
        done: &(dyn Fn() + Sync),
    ) -> miette::Result<Vec<Sealed>> {
        let written = WrittenKeys::read(before);
        if self.study.design == Design::Field {
            self.rigs.identify(&tickets);
        }
        let sealed = tickets.into_par_iter().with_max_len(1).map(|ticket| {
            let line = written.of(&ticket);
            let key = match self.study.design {
                Design::Laboratory => {
                    Key::Laboratory(Box::new(laboratory::sealed(&self.study, &ticket, line)?))
                }
                Design::Field => Key::Field(self.rigs.sealed(&ticket, line)),
            };
            done();
            Ok(Sealed { ticket, key })
        });
        Ok(sealed.collect::<Result<_, MakeError>>().map_err(StudyError)?)
    }

    /// Diagnoses a rig, then opens its key.
    ///
    /// # Errors
    /// A rig that cannot be made again.
    pub fn judge(&self, Sealed { ticket, key }: &Sealed) -> miette::Result<Case> {
        match key {
            Key::Laboratory(key) => {
                Ok(laboratory::judged(&self.study, (ticket, key), self.examiner).map_err(StudyError)?)
            }
            Key::Field(key) => Ok(self.rigs.judged((ticket, key), self.examiner)),
        }
    }

    /// Scores the cases.
    pub fn score(&self, cases: &[Case]) -> Scores {
        match self.study.design {
            Design::Laboratory => laboratory::score(cases, &self.study.expect),
            Design::Field => field::score(cases, &self.study.expect),
        }
    }

    /// The report without its figures; `key_sha256` is the hash of the sealed keys.
    pub fn report(&self, key_sha256: &str, cases: &[Case], scores: &Scores) -> Report {
        Report::of(&self.study, key_sha256, cases, scores)
    }
}

impl Examination<'static> {
    /// One without bases: of the laboratory, or for cases of the field that were judged elsewhere.
    pub fn without_bases(study: Study) -> Self {
        static NONE: Bases = Bases { all: Vec::new(), spare: 0 };
        Self::new(study, &NONE)
    }
}
