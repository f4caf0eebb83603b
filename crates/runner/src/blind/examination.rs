//! The blind study as an examination.

use super::{Case, Examiner, Sealed, Study, Ticket, WrittenKeys};
use super::{artefacts, design, examine, score, seal, summary};
use crate::examination::{Done, Examination, KEY_FILE, Measure, Report};
use crate::pages::INDEX;
use crate::plots;
use crate::provenance::PROVENANCE_FILE;
use miette::Diagnostic;
use switchback_gap::{Model, diagnose};
use switchback_maker::MakeError;
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

    fn report(&self, key_sha256: &str, cases: &[Case]) -> miette::Result<Report> {
        let scores = score(cases, &self.0.expect);
        let mut files = artefacts(&self.0, key_sha256, cases, &scores);
        for figure in plots::blind::figures(cases, &scores) {
            files.add(figure.name, figure.svg);
        }
        let is_as_expected = !scores.measures.iter().any(Measure::is_unexpected);
        Ok(Report { files, summary: summary(&scores), is_as_expected })
    }
}
