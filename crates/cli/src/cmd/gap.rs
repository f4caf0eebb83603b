//! `switchback gap DATA.csv …` or `switchback gap RIG.toml`

use super::data_args::DataArgs;
use super::power::{self, PowerArgs};
use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use crate::progress::Watch;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::value_parser;
use miette::Diagnostic;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use switchback_diagnose::Effect;
use switchback_diagnose::posterior::Prior;
use switchback_host::{FmuError, Map, Simulator, predictions};
use switchback_io::diagnosis::{
    self, Checked, DiagnosisError, Expectation, NoPosterior, Report, Request, Subject, examine_watched,
    posterior, prior, stability,
};
use switchback_io::model;
use switchback_io::output::note;
use switchback_io::rig::{self, Loaded};
use switchback_model::rig::Rig;
use switchback_report::diagnosis as text;
use switchback_report::diagnosis::artefacts;
use switchback_report::pages::INDEX;
use thiserror::Error;

/// Diagnose the gap between a model and a rig: where it lies, which effect causes it, how far that effect closes it.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    data: DataArgs,

    /// Diagnose this model: model.json of `identify --out`, nominal.json or augmented.json of `gap --out`, or the output of
    /// `identify --json` [default: the columns y_sim if the records have them, else the model identified from the fit records]
    #[arg(long, value_name = "MODEL.json")]
    model: Option<PathBuf>,

    /// What differs from these records: of another day, another unit, another bench. Files of measurements, read as the others are, or one rig
    /// file; may be given more than once.
    #[arg(long, value_name = "RECORDS", conflicts_with_all = ["model", "fmu", "power"])]
    against: Vec<PathBuf>,

    /// Leave this effect out of the candidates, where you know that the rig has none of it; may be given more than once.
    #[arg(long, value_name = "EFFECT", value_parser = effect(), hide_possible_values = true)]
    without: Vec<Effect>,

    /// Show this effect as a cause where else it belongs to the model: coloured_noise, in records that nobody designed; may be given more
    /// than once.
    #[arg(long, value_name = "EFFECT", value_parser = effect(), hide_possible_values = true)]
    ask: Vec<Effect>,

    /// Only nominal models that could run in real time, so that they can be exported: no look ahead, and a reversal takes effect once it is
    /// confirmed.
    #[arg(long)]
    causal: bool,

    /// How common it is, on machines like yours, that nothing is missing, and that the cause is none of the effects, e.g.
    /// none=0.2,unexplained=0.1: for records that nobody designed.
    #[arg(long, value_name = "SHARES", value_parser = prior)]
    prior: Option<Prior>,

    /// Let this posterior decide on records that nobody designed, as `switchback train` trains it [default: the one built in]
    #[arg(long, value_name = "POSTERIOR.bin")]
    posterior: Option<PathBuf>,

    /// Diagnose a simulator: run this co-simulation FMU (FMI 2.0) over the records, and take its outputs for y_sim.
    #[arg(long, value_name = "MODEL.fmu", conflicts_with_all = ["model", "power"])]
    fmu: Option<PathBuf>,

    /// Which variables of the FMU are the input and the output, e.g. v=position,y=force; delay=1 where its output is a sample late
    /// [default: the only ones, or v and y]
    #[arg(long, value_name = "VARIABLES", value_parser = switchback_host::map, requires = "fmu")]
    map: Option<Map>,

    /// Seconds without a sign of life after which the FMU is ended.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = patience, requires = "fmu", hide_default_value = true)]
    patience: Duration,

    /// What must come out, e.g. "gap < 2 %" or "cause none", in the words of the keys of --json, or of a simulator "delay = 0" or "friction
    /// within 5 %"; may be given more than once. Exit code 1 where it does not, after everything is written.
    #[arg(long, value_name = "EXPECTATION", value_parser = Expectation::parse)]
    expect: Vec<Expectation>,

    /// Also diagnose so many samples of three quarters of the records, and each recording alone, and say which give the same verdict [default: 10
    /// where only the option is given]
    #[arg(long, value_name = "SAMPLES", num_args = 0..=1, default_missing_value = "10", value_parser = value_parser!(u16).range(1..=1000), conflicts_with = "power")]
    stability: Option<u16>,

    /// Also say why the first candidate comes first: the errors that each saves, by how far ahead it predicts.
    #[arg(long, conflicts_with = "power")]
    explain: bool,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    /// Also write the verdict, gap.json, the models nominal.json and augmented.json, series.csv, the figures, the next
    /// experiment and all of it on one page, index.html, into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Also write series.mcap into that folder: series.csv as a log for Foxglove, Rerun or PlotJuggler, a topic a record (if built with the
    /// feature `mcap`).
    #[arg(long, requires = "out", conflicts_with = "power")]
    mcap: bool,

    #[command(flatten)]
    power: PowerArgs,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// What the folder gets.
const FILES: [&str; 13] = [
    "gap.json",
    "nominal.json",
    "augmented.json",
    "aligned.json",
    "series.csv",
    SERIES_LOG,
    "verdict.txt",
    "where.svg",
    "candidates.svg",
    "residuals.svg",
    "outputs_*.svg",
    diagnosis::NEXT_EXPERIMENT,
    INDEX,
];

/// Reads, diagnoses, prints, and writes the folder if one was asked for.
///
/// # Errors
/// A rig or model that cannot be read or diagnosed, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let (data, loaded) = args.data.load("gap", args.output.quiet)?;
    if args.power.power {
        return run_power(args, &data, &loaded);
    }
    if args.mcap && !model::WRITES_LOGS {
        return Err(Unwritten.into());
    }
    let folder = args.output.force.claim_if_asked(args.out.as_deref(), &FILES, &data.inputs(&loaded.plan))?;
    let (rig, mut notes) = (simulated(args, loaded.rig)?, loaded.reported.warnings);
    notes.extend(args.fmu.as_ref().map(|fmu| format!("the predictions are those of {}", fmu.display())));
    let subject = match args.against.is_empty() {
        true => Subject::choose(rig, args.model.as_deref())?,
        false => Subject::against(rig, &args.data.of(&args.against).load("gap", args.output.quiet)?.1.rig)?,
    };
    let subject = subject.noting(notes);
    let watch = Watch::new(args.output.quiet);
    let settings = request(args)?.settings();
    let report = args.threads.install(|| {
        let asked = args.stability.map(|samples| (subject.clone(), samples));
        let mut report = examine_watched(subject, &settings, &watch)?;
        report.stability =
            asked.map(|(subject, samples)| stability(&subject, &settings, (&report, samples.into()), &watch));
        Ok(report)
    })?;
    let report = report.map_err(|error: DiagnosisError| error.in_file(data.place()))?;
    watch.finish();
    if let Some(folder) = folder {
        let mut files = artefacts(&report)?;
        if args.mcap {
            files.add(SERIES_LOG, series_log(&report)?);
        }
        folder.commit(&files)?;
    }
    let words = || {
        let why = if args.explain { text::why(&report) } else { String::new() };
        text::words(&report, args.out.as_deref()) + &why
    };
    args.output.quiet.describe_or(args.json, || text::json(&report), words)?;
    Ok(met(args, &report))
}

/// The series as a log.
const SERIES_LOG: &str = "series.mcap";

fn series_log(report: &Report) -> Result<Vec<u8>, Unwritten> {
    let labels = [&report.rig.input_label, &report.rig.output_label].map(String::as_str);
    model::diagnosed_series(report).log(labels).map_err(|_| Unwritten)
}

/// A log that this program cannot write.
#[derive(Debug, Error, Diagnostic)]
#[error("--mcap: this program was built without the feature `mcap`")]
#[diagnostic(help(
    "install it with `cargo install --locked --path crates/cli --features mcap`, or leave the option out: series.csv holds the same"
))]
struct Unwritten;

/// The rig with the predictions of the FMU, if one was given.
fn simulated(args: &Args, rig: Rig) -> Result<Rig, FmuError> {
    let Some(fmu) = &args.fmu else { return Ok(rig) };
    let map = args.map.clone().unwrap_or_default();
    predictions(rig, &Simulator { fmu, map, patience: args.patience })
}

/// Shows which expectations hold.
fn met(args: &Args, report: &Report) -> Outcome {
    let checked: Vec<Checked> = args.expect.iter().map(|expected| expected.check(report)).collect();
    for one in &checked {
        // What is broken is reported even where nothing else is.
        if !one.holds || !args.output.quiet.quiet {
            note(&format!("{}\n", one.says));
        }
    }
    if checked.iter().all(|one| one.holds) { Outcome::Done } else { Outcome::Unmet }
}

/// A positive number of seconds.
fn patience(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0 && *seconds <= 1e6);
    seconds.map(Duration::from_secs_f64).ok_or_else(|| "give a positive number of seconds".to_owned())
}

/// What is asked of a diagnosis.
fn request(args: &Args) -> Result<Request, NoPosterior> {
    let Args { without, ask, causal, prior, .. } = args;
    let posterior = args.posterior.as_deref().map(posterior).transpose()?.map(Arc::new);
    Ok(Request { without: without.clone(), ask: ask.clone(), causal: *causal, prior: *prior, posterior })
}

fn run_power(args: &Args, data: &rig::Request, loaded: &Loaded) -> CommandResult {
    let asked = power::Order {
        model: args.model.as_deref(),
        settings: request(args)?.settings(),
        out: args.out.as_ref(),
        json: args.json,
        options: (args.threads, args.output.quiet, args.output.force),
    };
    power::run(&args.power, asked, (data, loaded))
}

fn effect() -> impl TypedValueParser<Value = Effect> {
    PossibleValuesParser::new(Effect::ALL.map(Effect::name))
        .map(|name| Effect::from_name(&name).expect("only names of effects are possible values"))
}
