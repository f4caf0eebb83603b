//! `switchback SCENARIO.toml` where rigs are sealed: `study = "blind"` or `study = "field"`.

use super::partial;
use crate::build::{BUILD, JUDGING_SOURCES};
use crate::failure::{CommandResult, Outcome};
use crate::interrupt::{self, SignalGuard};
use crate::options::{Force, Quiet, Threads};
use crate::progress::Meter;
use rayon::prelude::*;
use serde_json::json;
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};
use switchback_io::input::{TextKind, read_text, stream};
use switchback_io::output::{FolderError, OutputFolder, note, sha256};
use switchback_io::provenance::{PROVENANCE_FILE, Provenance};
use switchback_lab::examination::{
    Case, Examination, KEY_FILE, Part, Partial, Report, Sealed, Study, Ticket, answers, key_file,
};
use switchback_report::examination::report;
use switchback_report::pages;
use switchback_study::Shard;
use switchback_study::consistency::Progress;
use switchback_study::journal::{Journal, SEALED_FILE};
use switchback_study::parts::PART_FILE;

/// Where the report goes, and how it is made and reported.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Order<'a> {
    /// The folder asked for.
    pub(crate) out: Option<&'a Path>,
    /// Whether files of others may be replaced there.
    pub(crate) force: Force,
    /// Worker threads.
    pub(crate) threads: Threads,
    /// What is printed.
    pub(crate) page: Page,
}

impl Order<'_> {
    /// Claims the folder asked for, or the one that belongs to an examination.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub(crate) fn claim(self, study: &Study) -> Result<OutputFolder, FolderError> {
        let default = || Path::new("reports").join(&study.name);
        self.force.claim(&self.out.map_or_else(default, Path::to_owned), study.design.files())
    }
}

/// Makes and seals the rigs, writes the key, diagnoses, opens, scores, writes the report, prints the summary.
///
/// Interrupted, it is taken up where it stood by starting it again: what is judged is kept in the folder until the report is written.
/// Only the printed time depends on the threads.
///
/// # Errors
/// A design that cannot be made, or a folder that cannot be written.
pub(crate) fn run(examination: &Examination<'_>, order: Order<'_>) -> CommandResult {
    let Order { threads, page, .. } = order;
    let provenance = Provenance::begin(BUILD, threads.at_once());
    // What a former run left stays until there is another report, the key with it.
    let files = examination.study().design.files();
    let folder = order.claim(examination.study())?;
    let place = folder.path().to_owned();
    let Begun { mut journal, sealed } = seal(examination, examination.tickets(), &place, order)?;
    let keys = key_file(&sealed);
    let of = sealed.len();
    let partial = |cases: &[Case]| {
        let partial = Partial { rigs: cases.len(), of };
        let report = threads.install(|| report(examination, &sha256(&keys), cases))?.of_part(partial);
        let bound = pages::bound(report.files.clone())?;
        order.force.claim(&partial::place(&place), files)?.commit(&bound)?;
        describe(&report, &partial::place(&place), page)
    };
    let Some(cases) = examine(examination, sealed, (&mut journal, &partial), order)? else {
        return Ok(Outcome::Stopped);
    };
    let outcome = threads.install(|| {
        let mut report = report(examination, &sha256(&keys), &cases);
        report.files.add_beside(PROVENANCE_FILE, provenance.end(Vec::new()).text());
        conclude(report, &keys, folder, page)
    })??;
    journal.close()?;
    partial::forget(&place, files, order.force);
    Ok(outcome)
}

/// The same for one part of the rigs, which is judged and not scored: [`merge`](super::merge) makes the report. `scenario` is the file of
/// the examination.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_part(
    examination: &Examination<'_>,
    (scenario, shard): (&Path, Shard),
    order: Order<'_>,
) -> CommandResult {
    let provenance = Provenance::begin(BUILD, order.threads.at_once());
    let text = read_text(scenario, TextKind::Settings)?;
    let study = examination.study();
    let default = Path::new("reports").join(format!("{}-part-{}-of-{}", study.name, shard.number, shard.of));
    let out = order.out.unwrap_or(&default);
    let name = stream::copy_name(scenario);
    let files = [PART_FILE, KEY_FILE, "answers.csv", "cases.jsonl", &name, PROVENANCE_FILE];
    let folder = order.force.claim(out, &files)?;
    folder.refuse_part(Some(json!({ "scenario": name, "shard": shard }).to_string().as_bytes()))?;
    let tickets = examination.tickets().into_iter().enumerate();
    let tickets = tickets.filter(|(position, _)| shard.holds(*position)).map(|(_, ticket)| ticket).collect();
    let Begun { mut journal, sealed } = seal(examination, tickets, folder.path(), order)?;
    let keys = key_file(&sealed);
    let of = sealed.len();
    let reported = |cases: &[Case]| {
        order.page.say(&format!("stopped: {} of {of} rigs of part {shard} are judged and kept", cases.len()))
    };
    let Some(cases) = examine(examination, sealed, (&mut journal, &reported), order)? else {
        return Ok(Outcome::Stopped);
    };
    let answers = answers(study.design, &cases);
    let part = Part::new(scenario, text, (shard, JUDGING_SOURCES), keys, cases);
    let mut artefacts = part.artefacts(answers);
    artefacts.add_beside(PROVENANCE_FILE, provenance.end(Vec::new()).text());
    folder.commit(&artefacts)?;
    journal.close()?;
    order.page.say(&format!("part {shard} written to {}", out.display()))?;
    Ok(Outcome::Done)
}

/// An examination whose rigs are made.
struct Begun {
    journal: Journal<Case>,
    sealed: Vec<Sealed>,
}

/// Makes and seals the rigs, and writes the key.
fn seal(
    examination: &Examination<'_>,
    tickets: Vec<Ticket>,
    folder: &Path,
    order: Order<'_>,
) -> miette::Result<Begun> {
    let Order { threads, page, .. } = order;
    page.say(&format!("{}: {}", examination.study().name, examination.study().question))?;
    let meter = Meter::counting("rigs made", page.quiet);
    meter.planned(tickets.len() as u64);
    let mut journal = Journal::open(folder, JUDGING_SOURCES)?;
    let before = journal.keys();
    let sealed = threads.install(|| examination.seal(tickets, &before, &|| meter.advanced(1)))??;
    meter.finish();
    let keys = key_file(&sealed);
    // On disk before the first diagnosis: whoever doubts the report can hash it.
    journal.keep_keys(&keys)?;
    let place = folder.join(SEALED_FILE);
    page.say(&format!("{} rigs made, keys sealed in {}", sealed.len(), place.display()))?;
    page.say(&format!("SHA-256 {}", sha256(&keys)))?;
    Ok(Begun { journal, sealed })
}

/// Reported of what is judged where an examination is stopped.
type Stopped<'a> = &'a dyn Fn(&[Case]) -> miette::Result<()>;

/// How often it is asked whether someone wished the examination to stop.
const MOMENT: Duration = Duration::from_millis(100);

/// Judges what the journal does not know, in parallel, and keeps each rig as soon as it is judged. Cases come by their number in the design;
/// `None` if someone wished it to stop, after `stopped` has been reported.
fn examine(
    examination: &Examination<'_>,
    sealed: Vec<Sealed>,
    (journal, stopped): (&mut Journal<Case>, Stopped<'_>),
    order: Order<'_>,
) -> miette::Result<Option<Vec<Case>>> {
    let Order { threads, page, .. } = order;
    let (mut cases, mut new) = (Vec::new(), Vec::new());
    for rig in sealed {
        match journal.recall(&rig.key_line()) {
            Some(case) => cases.push(case.clone()),
            None => new.push(rig),
        }
    }
    if !cases.is_empty() {
        page.say(&format!("{} of them are judged already: taken up where it was interrupted", cases.len()))?;
    }
    let meter = Meter::counting("rigs diagnosed", page.quiet);
    meter.planned(new.len() as u64);
    let start = Instant::now();
    let _signal_guard = SignalGuard::new();
    let (describe, reported) = mpsc::channel();
    let judge = |describe: &mut mpsc::Sender<_>, rig: &Sealed| {
        let judged = examination.judge(rig).map(|case| (rig.key_line(), case));
        // Nobody listens any more once the examination is stopped, or something has failed.
        describe.send(judged).map_err(|_| ())
    };
    let is_done = thread::scope(|scope| -> miette::Result<bool> {
        // One rig may take as long as twenty others: each is a task of its own.
        let judging = || new.par_iter().with_max_len(1).try_for_each_with(describe, judge);
        scope.spawn(|| threads.install(judging));
        let reported = reported;
        loop {
            match reported.recv_timeout(MOMENT) {
                Ok(judged) => {
                    let (key_line, case) = judged?;
                    journal.keep(&key_line, &case)?;
                    meter.advanced(1);
                    cases.push(case);
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => return Ok(true),
            }
            if interrupt::is_wished() {
                cases.sort_by_key(|case: &Case| case.id);
                if !cases.is_empty() {
                    stopped(&cases)?;
                }
                note("stopped; what was finished is kept, run the same command again to go on\n");
                return Ok(false);
            }
        }
    })?;
    meter.finish();
    page.say(&format!("diagnosed in {:.0} s\n", start.elapsed().as_secs_f64()))?;
    cases.sort_by_key(|case: &Case| case.id);
    Ok(is_done.then_some(cases))
}

/// Writes the report with its keys, prints the summary.
///
/// # Errors
/// A folder that cannot be written.
pub(crate) fn conclude(mut report: Report, keys: &str, folder: OutputFolder, page: Page) -> CommandResult {
    let out = folder.path().to_owned();
    report.files.add(KEY_FILE, keys);
    report.files = pages::bound(report.files)?;
    folder.commit(&report.files)?;
    describe(&report, &out, page)?;
    Ok(if report.is_as_expected { Outcome::Done } else { Outcome::Unmet })
}

fn describe(report: &Report, out: &Path, page: Page) -> miette::Result<()> {
    let words = || format!("{}\nwritten to {}\n", report.summary, out.display());
    page.quiet.describe_or(page.json, || report.files.text("results.json"), words)
}

/// What is printed: words as the work goes on, nothing but results.json at its end, or nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Page {
    /// Whether results.json is printed.
    pub(crate) json: bool,
    /// Whether words are not.
    pub(crate) quiet: Quiet,
}

impl Page {
    fn say(self, line: &str) -> miette::Result<()> {
        if self.json { Ok(()) } else { self.quiet.describe(&format!("{line}\n")) }
    }
}
