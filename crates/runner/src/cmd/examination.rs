//! `switchback SCENARIO.toml` where rigs are sealed: `study = "blind"` or `study = "field"`.

use crate::examination::{
    Examination, Journal, Judged, KEY_FILE, PART_FILE, Part, SEALED_FILE, Sealed, key_file,
};
use crate::failure::{CommandResult, Outcome};
use crate::input::{read_text, stream};
use crate::options::{Force, Quiet, Shard};
use crate::output::{OutputError, OutputFolder, sha256};
use crate::progress::Meter;
use crate::study::Progress;
use std::path::Path;
use std::time::Instant;

/// Where the report goes.
#[derive(Debug, Clone, Copy)]
pub struct Place<'a> {
    /// The folder asked for.
    pub out: Option<&'a Path>,
    /// Whether files of others may be replaced there.
    pub force: Force,
}

impl Place<'_> {
    /// Claims the folder asked for, or the one that belongs to an examination.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn claim<E: Examination>(self, examination: &E) -> Result<OutputFolder, OutputError> {
        let default = || Path::new("reports").join(examination.name());
        self.force.claim(&self.out.map_or_else(default, Path::to_owned), E::FILES)
    }
}

/// Makes and seals the rigs, writes the key, diagnoses, opens, scores, writes the report, prints the summary.
///
/// Interrupted, it is taken up where it stood by starting it again: what is judged is kept in the folder until the report is written.
///
/// Runs on the rayon pool that it is called from. Only the printed time depends on it.
///
/// # Errors
/// A design that cannot be made, or a folder that cannot be written.
pub fn run<E: Examination>(examination: &E, place: Place<'_>, page: Page) -> CommandResult {
    // What a former run left stays until there is another report, the key with it.
    let folder = place.claim(examination)?;
    let Opened { keys, cases, journal } = judge(examination, examination.design()?, &folder, page)?;
    let outcome = conclude(examination, (&keys, &cases), folder, page)?;
    journal.close()?;
    Ok(outcome)
}

/// The same for one part of the rigs, which is judged and not scored: [`merge`](super::merge) makes the report. `scenario` is the file of
/// the examination.
///
/// # Errors
/// As [`run`].
pub fn run_part<E: Examination>(
    examination: &E,
    (scenario, shard): (&Path, Shard),
    place: Place<'_>,
    page: Page,
) -> CommandResult {
    let text = read_text(scenario)?;
    let default =
        Path::new("reports").join(format!("{}-part-{}-of-{}", examination.name(), shard.number, shard.of));
    let out = place.out.unwrap_or(&default);
    let name = stream::copy_name(scenario);
    let files = [PART_FILE, KEY_FILE, "answers.csv", "cases.jsonl", &name];
    let folder = place.force.claim(out, &files)?;
    let tickets = examination.design()?.into_iter().enumerate();
    let tickets = tickets.filter(|(position, _)| shard.holds(*position)).map(|(_, ticket)| ticket).collect();
    let Opened { keys, cases, journal } = judge(examination, tickets, &folder, page)?;
    let part = Part::new(scenario, text, (shard, JUDGING_SOURCES), keys, cases);
    folder.commit(&part.artefacts())?;
    journal.close()?;
    page.say(&format!("part {shard} written to {}", out.display()))?;
    Ok(Outcome::Done)
}

/// Rigs that were judged, with their key file.
struct Opened<C> {
    keys: String,
    cases: Vec<C>,
    journal: Journal<C>,
}

/// Makes and seals the rigs, writes the key, diagnoses and opens.
fn judge<E: Examination>(
    examination: &E,
    tickets: Vec<E::Ticket>,
    folder: &OutputFolder,
    page: Page,
) -> miette::Result<Opened<E::Case>> {
    page.say(&format!("{}: {}", examination.name(), examination.question()))?;
    let meter = Meter::counting("rigs made", page.quiet);
    meter.planned(tickets.len() as u64);
    let mut journal = Journal::open(folder.path(), JUDGING_SOURCES)?;
    let sealed = examination.seal(tickets, &journal.keys(), &|| meter.advanced(1))?;
    meter.finish();
    let keys = key_file(&sealed);
    // On disk before the first diagnosis: whoever doubts the report can hash it.
    journal.keep_keys(&keys)?;
    let place = folder.path().join(SEALED_FILE);
    page.say(&format!("{} rigs made, keys sealed in {}", sealed.len(), place.display()))?;
    page.say(&format!("SHA-256 {}", sha256(&keys)))?;
    let cases = examine(examination, sealed, &mut journal, page)?;
    Ok(Opened { keys, cases, journal })
}

/// Judges what the journal does not know, batch after batch. Cases come by their number in the design.
fn examine<E: Examination>(
    examination: &E,
    sealed: Vec<E::Sealed>,
    journal: &mut Journal<E::Case>,
    page: Page,
) -> miette::Result<Vec<E::Case>> {
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
    for batch in new.chunks(E::BATCH) {
        let judged = examination.judge(batch, &|| meter.advanced(1))?;
        journal.keep(batch.iter().map(Sealed::key_line).zip(&judged))?;
        cases.extend(judged);
    }
    meter.finish();
    page.say(&format!("diagnosed in {:.0} s\n", start.elapsed().as_secs_f64()))?;
    cases.sort_by_key(Judged::id);
    Ok(cases)
}

/// The SHA-256 of the sources that make, diagnose and judge: the program may be built anew meanwhile, or elsewhere.
pub(super) const JUDGING_SOURCES: &str = env!("JUDGING_SOURCES");

/// Scores, writes the report, prints the summary.
///
/// # Errors
/// A folder that cannot be written, or a figure that cannot be drawn.
pub fn conclude<E: Examination>(
    examination: &E,
    (keys, cases): (&str, &[E::Case]),
    folder: OutputFolder,
    page: Page,
) -> CommandResult {
    let out = folder.path().display().to_string();
    let mut report = examination.report(&sha256(keys), cases)?;
    report.files.add(KEY_FILE, keys);
    folder.commit(&report.files)?;
    let words = || format!("{}\nwritten to {out}\n", report.summary);
    page.quiet.tell_or(page.json, || report.files.text("results.json"), words)?;
    Ok(if report.is_as_expected { Outcome::Done } else { Outcome::Unmet })
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
