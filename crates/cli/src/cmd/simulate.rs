//! `switchback simulate MODEL.json INPUT.csv`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use miette::Diagnostic;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use switchback_diagnose::Effect;
use switchback_io::identification::unit;
use switchback_io::input::{DataError, DataProblem};
use switchback_io::model::{self, Header, ModelFile, Run};
use switchback_io::output::{note, print, stamped, stamped_schema};
use switchback_io::rig::{ColumnNames, InputSeries, RigError, RigProblem, Sampling, read_input};
use thiserror::Error;

/// Run a model on a new input, with a 95 % band: `identify --out` and `gap --out` write such models.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// model.json of `identify --out`, or nominal.json or augmented.json of `gap --out`.
    model: PathBuf,

    #[command(flatten)]
    asked: Asked,

    /// Write the columns t,v,y,y_low,y_high, t as it stands in the input's file, into this file instead of printing them.
    #[arg(long, value_name = "CSV")]
    out: Option<PathBuf>,

    /// Print one JSON object instead: the fit figure, the share within the band, warnings and notes.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    output: Output,
}

/// The input that a model is to run on.
#[derive(Debug, clap::Args)]
pub struct Asked {
    /// The input to play: CSV in any dialect, one column at least. With a measured output beside it the run begins where the record does,
    /// and the fit is reported; where that is missing at the beginning, the run begins at rest.
    #[arg(value_name = "INPUT.csv")]
    file: PathBuf,

    /// Column of the input, by name or number [default: guessed from the header]
    #[arg(long, value_name = "COLUMN")]
    input: Option<String>,

    /// Column of the measured output, if there is one; `none` to leave it out and begin at rest.
    #[arg(long, value_name = "COLUMN")]
    output: Option<String>,

    /// Column of the time; `none` for rows that are even whatever it says [default: guessed; without one, a row is a sample]
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,

    /// Interpolate the rows linearly to the model's sample time.
    #[arg(long)]
    resample: bool,
}

impl Asked {
    /// The file that holds the input.
    pub fn file(&self) -> &Path {
        &self.file
    }
}

/// Why a model did not run.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum SimulateError {
    /// The model knows no border for the input.
    #[error("{input}: the input runs along a border that the model does not know")]
    #[diagnostic(help("identify the model from records that run on both borders, or with `--method free`"))]
    NoRun {
        /// The input file.
        input: String,
    },
    /// The input is sampled otherwise.
    #[error("{input}: the samples are {found} s apart, but the model was identified at {model} s")]
    #[diagnostic(help("sample the input as the model was, or add `--resample` to interpolate it linearly"))]
    SampleTime {
        /// The input file.
        input: String,
        /// Seconds between its samples.
        found: f64,
        /// Seconds between those of the model.
        model: f64,
    },
}

/// Reads both, runs, writes or prints.
///
/// # Errors
/// A file that is no model or no input, an input that cannot be run, or an output that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let file = model::read(&args.model)?;
    let place = args.asked.file.as_path();
    let input = played(&args.asked, (&file, &args.model))?;
    let target = args.output.force.claim_file(args.out.as_deref(), &[place, &args.model])?;
    let simulation = Simulation::new(file, input, place)?;
    match target {
        Some(file) => {
            file.commit(simulation.csv())?;
            args.output.quiet.describe_or(args.json, || simulation.json(), || simulation.words())?;
        }
        None if args.json => print(&simulation.json())?,
        None => {
            if !args.output.quiet.quiet {
                note(&simulation.words());
            }
            print(&simulation.csv())?;
        }
    }
    Ok(Outcome::Done)
}

/// A model that ran on an input.
#[derive(Debug)]
pub struct Simulation {
    file: ModelFile,
    input: InputSeries,
    run: Run,
}

impl Simulation {
    /// Runs a model on an input, which messages call by its `place`.
    ///
    /// # Errors
    /// An input in other units, or one that runs along a border that the model does not know.
    pub fn new(file: ModelFile, input: InputSeries, place: &Path) -> miette::Result<Self> {
        let labels = [input.input_label.as_str(), input.output_label.as_deref().unwrap_or_default()];
        file.header.check_units(labels, (place, "file"))?;
        match free_run(&file, &input) {
            Some(run) => Ok(Self { file, input, run }),
            None => Err(SimulateError::NoRun { input: place.display().to_string() }.into()),
        }
    }

    /// The input, input units.
    pub fn input(&self) -> &[f64] {
        &self.input.v
    }

    /// The run.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// The columns `t,v,y,y_low,y_high`.
    pub fn csv(&self) -> String {
        table(&self.input, &self.run)
    }

    /// What ran and how well as one JSON object.
    pub fn json(&self) -> String {
        self.page().json()
    }

    /// The same in words.
    pub fn words(&self) -> String {
        self.page().words()
    }

    fn page(&self) -> Page<'_> {
        Page::of(&self.file, &self.input, &self.run)
    }
}

/// The run from the measured initial state, or from rest where none was measured or the input begins with nothing to simulate.
fn free_run(file: &ModelFile, input: &InputSeries) -> Option<Run> {
    let Some(y) = &input.y else { return file.run(&input.v, None) };
    let label = input.output_label.as_deref().unwrap_or("output");
    let missing = y.iter().filter(|y| y.is_nan()).count();
    let is_usable = |run: &Run| run.start < input.v.len() && y[..run.start].iter().all(|y| y.is_finite());
    let from_measured = (missing < y.len()).then(|| file.run(&input.v, Some(&filled(y)))).flatten();
    let from_rest = || {
        let mut run = file.run(&input.v, None)?;
        run.notes.push(format!(
            "no initial state could be taken from `{label}`: it is missing there, or the record ends before the input has moved"
        ));
        Some(run)
    };
    let mut run = from_measured.filter(is_usable).or_else(from_rest)?.judged(y);
    if missing > 0 {
        run.notes.push(format!(
            "`{label}` is missing in {missing} of {} samples: the fit is judged on the others",
            y.len()
        ));
    }
    Some(run)
}

/// The last value that was measured in place of each that was not.
fn filled(y: &[f64]) -> Vec<f64> {
    let first = y.iter().copied().find(|y| y.is_finite()).unwrap_or(0.0);
    let held = y.iter().scan(first, |last, y| {
        *last = if y.is_finite() { *y } else { *last };
        Some(*last)
    });
    held.collect()
}

/// Reads the input, at the sample time of a model, which messages call by its path.
///
/// # Errors
/// A file that is no input, or one that is sampled otherwise.
pub fn played(args: &Asked, (file, model): (&ModelFile, &Path)) -> miette::Result<InputSeries> {
    let sample_time = file.header.sample_time;
    let names =
        ColumnNames { time: args.time.clone(), input: args.input.clone(), output: args.output.clone() };
    let sampling = Sampling { sample_time: Some(sample_time), resample: args.resample };
    let command = format!("switchback simulate {} {}", model.display(), args.file.display());
    let other = |error: &RigError| {
        error.problems().find_map(|problem| match problem {
            RigProblem::Data(DataError {
                problem: DataProblem::OtherSampleTime { mean_step, .. }, ..
            }) => Some(*mean_step),
            _ => None,
        })
    };
    read_input(&args.file, &names, sampling, &command).map_err(|error| match other(&error) {
        Some(found) => {
            SimulateError::SampleTime { input: args.file.display().to_string(), found, model: sample_time }
                .into()
        }
        None => error.into(),
    })
}

fn table(input: &InputSeries, run: &Run) -> String {
    let unit = input.time_unit.iter().filter(|_| input.times.is_some());
    let unit: String = unit.map(|unit| format!(" [{unit}]")).collect();
    let mut text = format!("t{unit},v,y,y_low,y_high\n");
    for (k, v) in input.v.iter().enumerate() {
        let t = match &input.times {
            Some(times) => times[k].clone(),
            None => stamp(input.start + k as f64 * input.sample_time).to_string(),
        };
        let _ = writeln!(text, "{t},{v},{},{},{}", run.y[k], run.low[k], run.high[k]);
    }
    text
}

/// Twelve digits of a time: they drop what rounding left of a product, and no meaning.
fn stamp(t: f64) -> f64 {
    format!("{t:.11e}").parse().unwrap_or(t)
}

/// Name and version of the layout of a run.
const SCHEMA: &str = "switchback/simulate/1";

/// A run of a model: `simulate --json`.
#[derive(Serialize, JsonSchema)]
struct Page<'a> {
    /// The model's part.
    #[schemars(extend("enum" = Header::PARTS))]
    model: &'a str,
    /// The model's rig.
    rig: &'a str,
    /// Effects in the model.
    #[schemars(with = "Vec<Effect>")]
    effects: Vec<&'a str>,
    /// First simulated sample.
    start: usize,
    /// Samples simulated.
    samples: usize,
    /// Fit to the measured output, where there is one.
    fit_percent: Option<f64>,
    /// Share of the measured outputs within the 95 % band.
    #[schemars(range(min = 0, max = 1))]
    covered: Option<f64>,
    /// Where the input leaves what the model was identified on.
    warnings: Vec<String>,
    /// How the input was read.
    notes: Vec<String>,
    /// Version of Switchback that wrote it.
    version: &'static str,
}

/// The JSON Schema of what `--json` prints.
pub fn schema() -> Schema {
    stamped_schema::<Page<'_>>(SCHEMA)
}

impl<'a> Page<'a> {
    fn of(file: &'a ModelFile, input: &InputSeries, run: &'a Run) -> Self {
        let header = &file.header;
        Self {
            model: &header.part,
            rig: &header.rig,
            effects: header.effects.iter().map(|added| added.effect.as_str()).collect(),
            start: run.start,
            samples: input.v.len() - run.start,
            fit_percent: run.fit_percent.filter(|fit| fit.is_finite()),
            covered: input.y.as_ref().and_then(|y| run.covered(y)),
            warnings: [
                input.warnings.clone(),
                header.identified_on.warnings(&input.v, header.sample_time, unit(&header.input)),
            ]
            .concat(),
            notes: [input.notes.as_slice(), &run.notes].concat(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    fn json(&self) -> String {
        stamped(SCHEMA, self)
    }

    fn words(&self) -> String {
        let with = if self.effects.is_empty() {
            String::new()
        } else {
            format!(" with {}", self.effects.join(" and "))
        };
        let mut text =
            format!("{} model of {}{with}: {} samples simulated", self.model, self.rig, self.samples);
        if let Some(fit) = self.fit_percent {
            let _ = write!(text, ", fit {fit:.2} %");
        }
        if let Some(covered) = self.covered {
            let _ = write!(text, ", {:.1} % of the measured outputs within the 95 % band", 100.0 * covered);
        }
        text.push('\n');
        for warning in &self.warnings {
            let _ = writeln!(text, "warning: {warning}");
        }
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
        text
    }
}
