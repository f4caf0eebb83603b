//! `switchback SCENARIO.toml` with `study = "blind"`.

use crate::blind::{self, Case, Examiner, Journal, KEY_FILE, Sealed, Study};
use crate::failure::{CommandResult, Outcome};
use crate::options::{Force, Quiet};
use crate::output::{Artefacts, sha256};
use crate::progress::Meter;
use crate::study::Progress;
use miette::Diagnostic;
use std::path::Path;
use std::time::Instant;
use switchback_gap::{Model, diagnose};
use switchback_maker::MakeError;
use thiserror::Error;

/// What the folder gets beside the key.
const REPORT: [&str; 10] = [
    "results.json",
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

/// Why a study stopped.
#[derive(Debug, Error, Diagnostic)]
#[error("a rig of the study could not be made: {0}")]
#[diagnostic(help("this is a mistake of the program; another seed may avoid it"))]
pub struct StudyError(#[from] MakeError);

/// Makes and seals the rigs, writes the key, diagnoses, opens, scores, writes the report into `out`, prints the summary.
///
/// Interrupted, it is taken up where it stood by starting it again: what is judged is kept in `out` until the report is written.
///
/// Runs on the rayon pool that it is called from. Only the printed time depends on it.
///
/// # Errors
/// A scenario that cannot be used, or a folder that cannot be written.
pub fn run(scenario: &Path, out: Option<&Path>, page: Page, force: Force) -> CommandResult {
    let study = blind::read(scenario)?;
    let default = Path::new("reports").join(&study.name);
    let out = out.unwrap_or(&default);
    force.claim(out, &REPORT)?;
    let folder = force.claim(out, &[KEY_FILE])?;
    page.say(&format!("{}: {}", study.name, study.question))?;

    let tickets = blind::design(&study).map_err(StudyError)?;
    let meter = Meter::counting("rigs made", page.quiet);
    meter.planned(tickets.len() as u64);
    let mut journal = Journal::open(out, JUDGING_SOURCES)?;
    let sealed = blind::seal(tickets, &journal.keys(), &|| meter.advanced(1)).map_err(StudyError)?;
    meter.finish();
    let key = blind::key_file(&sealed);
    let hash = sha256(&key);
    // On disk before the first diagnosis: whoever doubts the report can hash it.
    folder.commit(&only(KEY_FILE, key))?;
    journal.keep_keys(&hash)?;
    page.say(&format!("{} rigs made, keys sealed in {}", sealed.len(), out.join(KEY_FILE).display()))?;
    page.say(&format!("SHA-256 {hash}"))?;

    let cases = examine(sealed, &mut journal, page)?;
    let outcome = conclude(&study, &hash, &cases, (out, force), page)?;
    journal.close()?;
    Ok(outcome)
}

/// Rigs diagnosed before their keys are opened and they are kept; bounds memory and what an interruption costs, changes no result.
/// At the end of a batch threads wait for the last rig.
const BATCH: usize = 64;

/// Judges what the journal does not know, batch after batch. Cases come by their number in the design.
fn examine(sealed: Vec<Sealed>, journal: &mut Journal, page: Page) -> miette::Result<Vec<Case>> {
    let examiner: Examiner<'_> = &|rig, settings| diagnose(rig, Model::Identify, settings);
    let mut cases: Vec<Case> = sealed.iter().filter_map(|rig| journal.recall(rig).cloned()).collect();
    let new: Vec<Sealed> = sealed.into_iter().filter(|rig| journal.recall(rig).is_none()).collect();
    if !cases.is_empty() {
        page.say(&format!("{} of them are judged already: taken up where it was interrupted", cases.len()))?;
    }
    let meter = Meter::counting("rigs diagnosed", page.quiet);
    meter.planned(new.len() as u64);
    let start = Instant::now();
    for batch in new.chunks(BATCH) {
        let judged = blind::examine(batch, examiner, &|| meter.advanced(1)).map_err(StudyError)?;
        journal.keep(batch, &judged)?;
        cases.extend(judged);
    }
    meter.finish();
    page.say(&format!("diagnosed in {:.0} s\n", start.elapsed().as_secs_f64()))?;
    cases.sort_by_key(|case| case.id);
    Ok(cases)
}

/// The SHA-256 of the sources that make, diagnose and judge: the program may be built anew meanwhile, or elsewhere.
const JUDGING_SOURCES: &str = env!("JUDGING_SOURCES");

fn conclude(
    study: &Study,
    hash: &str,
    cases: &[Case],
    (out, force): (&Path, Force),
    page: Page,
) -> CommandResult {
    let scores = blind::score(cases, &study.expect);
    let report = blind::artefacts(study, hash, cases, &scores)?;
    force.claim(out, &REPORT)?.commit(&report)?;
    let words = || format!("{}\nwritten to {}\n", blind::summary(&scores), out.display());
    page.quiet.tell_or(page.json, || report.text("results.json"), words)?;
    let broken = scores.measures.iter().any(blind::Measure::is_unexpected);
    Ok(if broken { Outcome::Unmet } else { Outcome::Done })
}

fn only(name: &str, contents: String) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add(name, contents);
    artefacts
}

/// What is printed: words as the work goes on, nothing but results.json at its end, or nothing.
#[derive(Debug, Clone, Copy)]
pub struct Page {
    /// Whether results.json is printed.
    pub json: bool,
    /// Whether words are not.
    pub quiet: Quiet,
}

impl Page {
    fn say(self, line: &str) -> miette::Result<()> {
        if self.json { Ok(()) } else { self.quiet.tell(&format!("{line}\n")) }
    }
}
