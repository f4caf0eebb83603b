//! `switchback bench SCENARIO BASELINE NEW`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use crate::progress::Meter;
use std::path::{Path, PathBuf};
use switchback_io::output::{Artefacts, OutputFile, OutputFolder};
use switchback_io::values::{positive, share, whole};
use switchback_report::plots;
use switchback_study::refuse_other_kinds;
use switchback_study::scenario::Scenario;
use switchback_versions::{
    self as bench, BenchError, Comparison, Entry, History, Label, Limits, Version, Versions,
};

/// Compare two versions of an estimator on the same noise; exit code 1 where the new one is worse.
///
/// Each version is a method of the scenario: a [[method]], or `joint`, `efficient`, `instrumental`, `linear-arx`, `memoryless`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The scenario whose records both estimate from.
    scenario: PathBuf,

    /// The method to compare with.
    baseline: String,

    /// The method to judge.
    new: String,

    /// Replicates of each cell [default: those of the scenario]
    #[arg(long, value_name = "N", value_parser = whole::<u32>(2..=u32::MAX.into()))]
    replicates: Option<u32>,

    /// Seed of the noise [default: that of the scenario]
    #[arg(long, value_name = "SEED", value_parser = whole::<u64>(0..=u64::MAX))]
    seed: Option<u64>,

    /// A difference of bias that matters, in standard deviations of the baseline
    #[arg(long, value_name = "SDS", default_value_t = Limits::default().bias, value_parser = positive, help_heading = "Limits")]
    bias: f64,

    /// A difference of standard deviations that matters, as a share
    #[arg(long, value_name = "SHARE", default_value_t = Limits::default().sd, value_parser = share, help_heading = "Limits")]
    sd: f64,

    /// A difference of failures that matters, as a share of the replicates
    #[arg(long, value_name = "SHARE", default_value_t = Limits::default().failures, value_parser = chance, help_heading = "Limits")]
    failures: f64,

    /// How often two versions without a difference may give an alarm
    #[arg(long, value_name = "SHARE", default_value_t = Limits::default().false_alarms, value_parser = chance, help_heading = "Limits")]
    false_alarms: f64,

    /// Also exit with 1 where the two are not shown to be equivalent
    #[arg(long, help_heading = "Limits")]
    equivalent: bool,

    /// Add what came out to this file, a line a version
    #[arg(long, value_name = "FILE", requires = "label", help_heading = "History")]
    history: Option<PathBuf>,

    /// What the new version is called in the history: its commit, tag or date
    #[arg(long, value_name = "TEXT", requires = "history", help_heading = "History")]
    label: Option<Label>,

    /// Write bench.json, bench.txt and, with --history, history.svg into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// A share that is less than all.
fn chance(text: &str) -> Result<f64, String> {
    let chance = share(text).map_err(|error| error.to_string())?;
    if chance < 1.0 { Ok(chance) } else { Err("write a share below 1, as 0.01 or 1%".to_owned()) }
}

/// What the folder gets.
const FILES: [&str; 3] = ["bench.json", "bench.txt", "history.svg"];

/// Reads, claims what is to be written, asks both, judges, writes, prints.
///
/// # Errors
/// A scenario that cannot be read or run, a method that cannot be asked, a file or folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    refuse_other_kinds(&args.scenario)?;
    let mut scenario = Scenario::read(&args.scenario)?;
    if let Some(seed) = args.seed {
        scenario = scenario.with_seed(seed);
    }
    let versions = Versions::of(scenario, [&args.baseline, &args.new])?;
    let kept = args.kept()?;
    let folder = args.output.force.claim_if_asked(args.out.as_deref(), &FILES, &args.inputs())?;
    let (who, comparison) = args.compare(&versions)?;
    let origin = (versions.scenario(), versions.seed());
    let history = kept.zip(args.label.as_ref()).map(|((mut history, file), label)| {
        let entry = Entry::of(label.clone(), &comparison, origin, &who);
        history.add(entry.clone());
        (history, file, entry)
    });
    let drawn = history.as_ref().map(|(history, _, entry)| plots::history(&history.of(entry)));
    let words = bench::words(&comparison, origin, &who);
    let json = || bench::json(&comparison, origin, &who);
    if let Some(folder) = folder {
        commit(folder, (json(), &words), drawn)?;
    }
    if let Some((history, file, _)) = history {
        file.commit(history.text())?;
    }
    args.output.quiet.describe_or(args.json, json, || words.clone())?;
    Ok(args.outcome(&comparison))
}

impl Args {
    fn limits(&self) -> Limits {
        Limits {
            bias: self.bias,
            sd: self.sd.ln_1p(),
            failures: self.failures,
            false_alarms: self.false_alarms,
        }
    }

    /// Files that are read, and written in no other way.
    fn inputs(&self) -> Vec<&Path> {
        [Some(&self.scenario), self.history.as_ref()].into_iter().flatten().map(PathBuf::as_path).collect()
    }

    /// The history so far, and the file that holds it: of nobody else, since every line of it is an entry.
    fn kept(&self) -> miette::Result<Option<(History, OutputFile)>> {
        let Some(path) = self.history.as_deref() else { return Ok(None) };
        History::read(path)?;
        let file = OutputFile::claim(path, true, &[&self.scenario])?;
        // What another run has added meanwhile.
        Ok(Some((History::read(path)?, file)))
    }

    fn compare(&self, versions: &Versions) -> miette::Result<([Version; 2], Comparison)> {
        let meter = Meter::new(self.output.quiet);
        let replicates = self.replicates.unwrap_or_else(|| versions.replicates());
        let limits = self.limits();
        let compared = self.threads.install(|| {
            let who = versions.begin()?;
            let [baseline, new] = versions.errors(replicates, &meter)?;
            Ok::<_, BenchError>((who, Comparison::of(&baseline, &new, limits)))
        })?;
        meter.finish();
        versions.end();
        Ok(compared?)
    }

    fn outcome(&self, comparison: &Comparison) -> Outcome {
        let is_alarm = comparison.verdict() == bench::Verdict::Worse;
        if is_alarm || (self.equivalent && !comparison.is_equivalent()) {
            Outcome::Unmet
        } else {
            Outcome::Done
        }
    }
}

fn commit(
    folder: OutputFolder,
    (json, words): (String, &str),
    history: Option<String>,
) -> miette::Result<()> {
    let mut artefacts = Artefacts::default();
    artefacts.add("bench.json", json);
    artefacts.add("bench.txt", words);
    if let Some(svg) = history {
        artefacts.add("history.svg", svg);
    }
    Ok(folder.commit(&artefacts)?)
}
