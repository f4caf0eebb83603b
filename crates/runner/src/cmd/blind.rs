//! `switchback SCENARIO.toml` with `study = "blind"`.

use crate::blind::{self, Case, Examiner, Journal, KEY_FILE, PART_FILE, Part, Sealed, Study, Ticket};
use crate::failure::{CommandResult, Outcome};
use crate::input::read_text;
use crate::options::{Force, Quiet, Shard};
use crate::output::{Artefacts, OutputFolder, sha256};
use crate::plots;
use crate::progress::Meter;
use crate::study::Progress;
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use std::time::Instant;
use switchback_gap::{Model, diagnose};
use switchback_maker::MakeError;
use thiserror::Error;

/// What the folder gets.
const FILES: [&str; 11] = [
    KEY_FILE,
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

/// Where the report goes.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// The folder asked for.
    pub out: Option<&'a Path>,
    /// Whether files of others may be replaced there.
    pub force: Force,
}

impl Place<'_> {
    /// The folder asked for, or the one that belongs to a study.
    fn folder(self, study: &Study) -> PathBuf {
        self.out.map_or_else(|| Path::new("reports").join(&study.name), Path::to_owned)
    }
}

/// Makes and seals the rigs, writes the key, diagnoses, opens, scores, writes the report, prints the summary.
///
/// Interrupted, it is taken up where it stood by starting it again: what is judged is kept in the folder until the report is written.
///
/// Runs on the rayon pool that it is called from. Only the printed time depends on it.
///
/// # Errors
/// A scenario that cannot be used, or a folder that cannot be written.
pub fn run(scenario: &Path, place: Place<'_>, page: Page) -> CommandResult {
    let study = blind::read(scenario)?;
    let out = place.folder(&study);
    place.force.claim(&out, &FILES)?;
    // What a former run left stays until there is another report.
    let folder = place.force.claim(&out, &[KEY_FILE])?;
    let tickets = blind::design(&study).map_err(StudyError)?;
    let Judged { keys, cases, journal } = judge(&study, tickets, folder, page)?;
    let outcome = conclude(&study, &keys, &cases, Place { out: Some(&out), ..place }, page)?;
    journal.close()?;
    Ok(outcome)
}

/// The same for one part of the rigs, which is judged and not scored: [`merge`](super::merge) makes the report.
///
/// # Errors
/// As [`run`].
pub fn run_part(scenario: &Path, shard: Shard, place: Place<'_>, page: Page) -> CommandResult {
    let study = blind::read(scenario)?;
    let text = read_text(scenario)?;
    let default = Path::new("reports").join(format!("{}-part-{}-of-{}", study.name, shard.number, shard.of));
    let out = place.out.unwrap_or(&default);
    let name = scenario.file_name().unwrap_or_default().to_string_lossy();
    let files = [PART_FILE, KEY_FILE, "answers.csv", "cases.jsonl", &name];
    place.force.claim(out, &files)?;
    let folder = place.force.claim(out, &[KEY_FILE])?;
    let tickets = blind::design(&study).map_err(StudyError)?.into_iter().enumerate();
    let tickets = tickets.filter(|(position, _)| shard.holds(*position)).map(|(_, ticket)| ticket).collect();
    let Judged { keys, cases, journal } = judge(&study, tickets, folder, page)?;
    let part = Part::new(scenario, text, (shard, JUDGING_SOURCES), keys, cases);
    place.force.claim(out, &[])?.commit(&part.artefacts())?;
    journal.close()?;
    page.say(&format!("part {shard} written to {}", out.display()))?;
    Ok(Outcome::Done)
}

/// Rigs that were judged, with their key file.
struct Judged {
    keys: String,
    cases: Vec<Case>,
    journal: Journal,
}

/// Makes and seals the rigs, writes the key, diagnoses and opens.
fn judge(study: &Study, tickets: Vec<Ticket>, folder: OutputFolder, page: Page) -> miette::Result<Judged> {
    page.say(&format!("{}: {}", study.name, study.question))?;
    let meter = Meter::counting("rigs made", page.quiet);
    meter.planned(tickets.len() as u64);
    let out = folder.path().to_owned();
    let mut journal = Journal::open(&out, JUDGING_SOURCES)?;
    let sealed = blind::seal(tickets, &journal.keys(), &|| meter.advanced(1)).map_err(StudyError)?;
    meter.finish();
    let keys = blind::key_file(&sealed);
    let hash = sha256(&keys);
    // On disk before the first diagnosis: whoever doubts the report can hash it.
    folder.commit(&only(KEY_FILE, keys.clone()))?;
    journal.keep_keys(&hash)?;
    page.say(&format!("{} rigs made, keys sealed in {}", sealed.len(), out.join(KEY_FILE).display()))?;
    page.say(&format!("SHA-256 {hash}"))?;
    let cases = examine(sealed, &mut journal, page)?;
    Ok(Judged { keys, cases, journal })
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
pub(super) const JUDGING_SOURCES: &str = env!("JUDGING_SOURCES");

/// Scores, writes the report, prints the summary.
///
/// # Errors
/// A folder that cannot be written, or a figure that cannot be drawn.
pub fn conclude(study: &Study, keys: &str, cases: &[Case], place: Place<'_>, page: Page) -> CommandResult {
    let out = place.folder(study);
    let scores = blind::score(cases, &study.expect);
    let mut report = blind::artefacts(study, &sha256(keys), cases, &scores);
    for figure in plots::blind::figures(cases, &scores)? {
        report.add(figure.name, figure.svg);
    }
    report.add(KEY_FILE, keys);
    place.force.claim(&out, &FILES)?.commit(&report)?;
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
