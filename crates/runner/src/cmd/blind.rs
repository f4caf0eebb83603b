//! `switchback SCENARIO.toml` with `study = "blind"`.

use crate::blind::{self, Examiner, Study};
use crate::failure::{CommandResult, Outcome};
use crate::output::{Artefacts, OutputFolder};
use indicatif::{ProgressBar, ProgressStyle};
use miette::{Diagnostic, IntoDiagnostic};
use std::path::Path;
use std::time::Instant;
use switchback_maker::MakeError;
use thiserror::Error;

/// Why a study stopped.
#[derive(Debug, Error, Diagnostic)]
#[error("a rig of the study could not be made: {0}")]
#[diagnostic(help("this is a mistake of the program; another seed may avoid it"))]
pub struct StudyError(#[from] MakeError);

/// Makes and seals the rigs, writes the key, diagnoses, opens, scores, writes the report into `out`, prints the summary.
///
/// # Errors
/// A scenario that cannot be used, or a folder that cannot be written.
pub fn run(scenario: &Path, out: &Path, examiner: Examiner<'_>) -> CommandResult {
    let study = blind::read(scenario)?;
    let folder = OutputFolder::claim(out)?;
    let tickets = blind::design(&study).map_err(StudyError)?;
    let count = tickets.len();
    println!("{}: {}", study.name, study.question);

    let bar = progress("making", count);
    let sealed = blind::seal(tickets, &|| bar.inc(1)).map_err(StudyError)?;
    bar.finish_and_clear();
    let key = blind::key_file(&sealed);
    let hash = blind::sha256(&key);
    folder.commit(&only("key.jsonl", key))?;
    println!(
        "{count} rigs made; their keys are sealed in {}\nSHA-256 {hash}",
        out.join("key.jsonl").display()
    );

    let bar = progress("diagnosing", count);
    let start = Instant::now();
    let cases = blind::examine(&sealed, examiner, &|| bar.inc(1)).map_err(StudyError)?;
    bar.finish_and_clear();
    let spent = start.elapsed().as_secs_f64();
    println!("diagnosed in {spent:.0} s, {:.2} s a rig in parallel\n", spent / count as f64);

    report(&study, &hash, &cases, out)
}

fn report(study: &Study, hash: &str, cases: &[blind::Case], out: &Path) -> CommandResult {
    let scores = blind::score(cases, &study.expect);
    OutputFolder::claim(out)?.commit(&blind::artefacts(study, hash, cases, &scores)?)?;
    print!("{}", blind::summary(&scores));
    println!("\nreport: {}", out.display());
    let broken = scores.measures.iter().any(blind::Measure::is_unexpected);
    Ok(if broken { Outcome::Unmet } else { Outcome::Done })
}

fn only(name: &str, contents: String) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add(name, contents);
    artefacts
}

/// A bar on a terminal; elsewhere indicatif stays silent.
fn progress(what: &'static str, count: usize) -> ProgressBar {
    let bar = ProgressBar::new(count as u64).with_prefix(what);
    let style = ProgressStyle::with_template("{prefix:>10} [{bar:40}] {pos}/{len} {eta}").into_diagnostic();
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar
}
