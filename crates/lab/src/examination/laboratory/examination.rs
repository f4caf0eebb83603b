//! The blind study as an examination.

use super::{Case, Examiner, Scores, Sealed, Study, Ticket, WrittenKeys};
use super::{artefacts, design, examine, score, seal, summary};
use crate::examination::{Done, Examination, KEY_FILE, Measure, Report};
use crate::generate::MakeError;
use miette::Diagnostic;
use switchback_diagnose::{Model, diagnose};
use switchback_io::INDEX;
use switchback_io::provenance::PROVENANCE_FILE;
use thiserror::Error;

/// A blind study with the program's own diagnosis.
#[derive(Debug, Clone)]
pub struct Blind(pub Study);

/// Why a study stopped.
#[derive(Debug, Error, Diagnostic)]
#[error("a rig of the study could not be made: {0}")]
#[diagnostic(help("this is a mistake of the program; another seed may avoid it"))]
struct StudyError(#[from] MakeError);

impl Examination for Blind {
    type Ticket = Ticket;
    type Sealed = Sealed;
    type Case = Case;
    type Scores = Scores;

    const FILES: &'static [&'static str] = &[
        KEY_FILE,
        PROVENANCE_FILE,
        "results.json",
        INDEX,
        "summary.txt",
        "answers.csv",
        "confusion.*",
        "accuracy.*",
        "calibration.*",
        "abstention.*",
        "closure.*",
        "baselines.*",
        "where.csv",
    ];

    /// 5,600 rigs take two to ten hours on two threads; the mean is nearer to their lower end.
    const SECONDS: f64 = 5.0;

    fn name(&self) -> &str {
        &self.0.name
    }

    fn question(&self) -> &str {
        &self.0.question
    }

    fn design(&self) -> miette::Result<Vec<Ticket>> {
        Ok(design(&self.0).map_err(StudyError)?)
    }

    fn seal(&self, tickets: Vec<Ticket>, before: &str, done: Done<'_>) -> miette::Result<Vec<Sealed>> {
        Ok(seal(tickets, &WrittenKeys::read(before), done).map_err(StudyError)?)
    }

    fn judge(&self, rig: &Sealed) -> miette::Result<Case> {
        let examiner: Examiner<'_> = &|rig, settings| diagnose(rig, Model::Identify, settings);
        Ok(examine(rig, examiner).map_err(StudyError)?)
    }

    fn score(&self, cases: &[Case]) -> Scores {
        score(cases, &self.0.expect)
    }

    fn report(&self, key_sha256: &str, cases: &[Case], scores: &Scores) -> miette::Result<Report> {
        let files = artefacts(&self.0, key_sha256, cases, scores);
        let is_as_expected = !scores.measures.iter().any(Measure::is_unexpected);
        Ok(Report { files, summary: summary(scores), is_as_expected })
    }
}
