//! `switchback plant DATA.csv … --effect EFFECT --size 2 --out DIR`

use super::data_args::DataArgs;
use super::rig::RigCommandError;
use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, number, whole};
use miette::Diagnostic;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use switchback_diagnose::Stage;
use switchback_identify::free::Model;
use switchback_io::diagnosis::Units;
use switchback_io::model::{self, ModelFile, System};
use switchback_io::output::{stamped, stamped_schema};
use switchback_io::rig;
use switchback_lab::generate::{
    InjectedFault, InjectedRig, InjectionContext, InjectionError, OBSERVABLE, RequestedFault,
};
use switchback_model::rig::Rig;
use thiserror::Error;

/// Put a known fault into measured records, and print what was put in: to try whether a diagnosis finds it.
///
/// What the sensor makes of the output, a gain, and what the record of the input shows are changed in the records themselves. Any other
/// effect is carried by a model of the machine: its simulation with the effect less the one without is added to the measured output.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,

    #[command(flatten)]
    asked: Asked,

    /// Folder for rig.toml and the records; what was put in is printed, not written there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Print what was put in as JSON.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    output: Output,
}

/// The fault that is asked for.
#[derive(Debug, clap::Args)]
pub struct Asked {
    /// Effect to put in; `switchback rig --list` shows all.
    #[arg(long, value_name = "EFFECT")]
    effect: String,

    /// Which law of the effect, 0 being the plain one.
    #[arg(long, default_value_t = 0, value_parser = whole::<usize>(0..=u64::from(u32::MAX)))]
    law: usize,

    /// What survives identification anew, over the residual that the records' own model leaves on held-out ones.
    #[arg(long, default_value_t = 2.0, value_parser = number)]
    size: f64,

    /// What else there is to the effect (a frequency, an instant, noise) is drawn from this.
    #[arg(long, default_value_t = 1, value_parser = whole::<u64>(0..=u64::MAX))]
    seed: u64,

    /// Model that carries the effect, of `identify --method free --out` [default: one identified from the fit records, with a pole and knots
    /// to spare]
    #[arg(long, value_name = "MODEL.json")]
    model: Option<PathBuf>,
}

impl Asked {
    /// The file of the model that carries the effect, where one is given.
    pub fn model(&self) -> Option<&Path> {
        self.model.as_deref()
    }

    fn requested_fault(&self) -> Result<RequestedFault, RigCommandError> {
        Ok(RequestedFault::with_law(&self.effect, self.law, self.size)?)
    }
}

/// Why nothing was planted.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum PlantError {
    /// The records are no ground for a fault.
    #[error("{data}: {error}")]
    #[diagnostic(help(
        "faults are planted into records of a machine with a loop, at least one to fit and better one held out; `switchback identify` shows what \
         the records show"
    ))]
    Context {
        /// The data.
        data: String,
        /// What is wrong.
        error: InjectionError,
    },
    /// The model is of another form.
    #[error("{model}: a model of the form `{kind}` cannot carry a fault")]
    #[diagnostic(help(
        "make one with `switchback identify --method free --out DIR`, or leave `--model` out"
    ))]
    Model {
        /// The model file.
        model: String,
        /// Its form.
        kind: &'static str,
    },
    /// The model is of records that are sampled otherwise.
    #[error("{model}: the model was identified at {at} s a sample, these records have {rig} s")]
    #[diagnostic(help(
        "identify the model from records that are sampled as these are, or leave `--model` out"
    ))]
    SampleTime {
        /// The model file.
        model: String,
        /// Seconds between its samples.
        at: f64,
        /// Seconds between those of the records.
        rig: f64,
    },
}

/// What the folder gets.
const FILES: [&str; 2] = [rig::RIG_FILE, "*.csv"];

/// Plants the fault, writes the folder, prints what was put in.
///
/// # Errors
/// Data that cannot be read or carry nothing, an unknown effect or law, a size that is none, or a folder that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    args.asked.requested_fault()?;
    let host_model = args.asked.model().map(model::read).transpose()?;
    let host_model = host_model.as_ref().zip(args.asked.model());
    let loaded = args.data.load("plant", args.output.quiet)?;
    let folder = args.output.force.claim_if_asked(Some(&args.out), &FILES, &args.data.inputs(&loaded))?;
    let injected = injected(&loaded.rig, &args.asked, (args.data.path(), host_model))?;
    if let Some(folder) = folder {
        folder.commit(&rig::artefacts(&injected.rig))?;
    }
    let words = || reported(&injected.fault, &Units::of(&injected.rig).output);
    args.output.quiet.describe_or(args.json, || page(&injected.fault), words)?;
    Ok(Outcome::Done)
}

/// The records with the fault alone: nothing is read, printed or written. `place` is what messages call the records; the carrier is a model and
/// what messages call that.
///
/// # Errors
/// An unknown effect or law, or records or a model that cannot carry it.
pub fn injected(
    rig: &Rig,
    asked: &Asked,
    (place, host_model): (&Path, Option<(&ModelFile, &Path)>),
) -> miette::Result<InjectedRig> {
    let requested_fault = asked.requested_fault()?;
    let refused = |error| PlantError::Context { data: name(place), error };
    let context = match host_model {
        Some((file, path)) => InjectionContext::carried_by(rig, carrying(rig, file, path)?),
        None => InjectionContext::new(rig),
    };
    Ok(context.and_then(|context| context.inject(&requested_fault, asked.seed)).map_err(refused)?)
}

/// The model of a file, where it can carry a fault into the records of a rig.
fn carrying<'f>(rig: &Rig, file: &'f ModelFile, path: &Path) -> miette::Result<&'f Model> {
    file.header.check_units([&rig.input_label, &rig.output_label], (path, "rig"))?;
    let model = name(path);
    if !file.header.runs_at(rig.sample_time) {
        let at = file.header.sample_time;
        return Err(PlantError::SampleTime { model, at, rig: rig.sample_time }.into());
    }
    match &file.system {
        System::Curves(curves) => Ok(curves.model()),
        other @ (System::Switched(_) | System::Points(_)) => {
            Err(PlantError::Model { model, kind: other.kind() }.into())
        }
    }
}

fn name(path: &Path) -> String {
    path.display().to_string()
}

/// Name and version of the layout of what was put in.
const SCHEMA: &str = "switchback/plant/1";

/// What was put in, in words; `unit` is that of the output.
pub fn reported(fault: &InjectedFault, unit: &str) -> String {
    let how = if fault.injection.is_exact() {
        "changed in the records themselves"
    } else {
        "carried by a model, as if it did not interact with what that misses"
    };
    let mut text = format!(
        "{} ({}, {}): {:.4} {}, {how}\n",
        fault.effect,
        fault.law,
        fault.stage.name(),
        fault.magnitude,
        fault.unit
    );
    let _ = writeln!(
        text,
        "size {:.2}: what is left of it when the model is identified anew, over the residual without it, {:.4} {unit}",
        fault.size, fault.residual
    );
    let _ = writeln!(text, "raw size {:.2}: what a model given beforehand misses because of it", fault.raw);
    if (fault.size / fault.wanted - 1.0).abs() > 0.1 {
        let _ = writeln!(text, "(asked for {}; this law and these records go no closer)", fault.wanted);
    }
    if !fault.is_observable() {
        let _ = writeln!(text, "(below {OBSERVABLE} it is not observable in these records)");
    }
    text
}

/// A fault planted into measured records: `plant --json`.
///
/// Keys stand in the order of the alphabet.
#[derive(Serialize, JsonSchema)]
struct Page {
    /// The effect's name.
    effect: &'static str,
    /// Whether the records themselves were changed; else a model carried it.
    exact: bool,
    /// Its law.
    law: &'static str,
    /// Its magnitude.
    magnitude: f64,
    /// Whether the records can show it at all.
    observable: bool,
    /// How it came in.
    injection: &'static str,
    /// What a model given beforehand misses.
    #[schemars(range(min = 0))]
    raw_size: f64,
    /// The residual without the fault, output units.
    #[schemars(range(min = 0))]
    residual: f64,
    /// What survives identification anew, over the residual.
    #[schemars(range(min = 0))]
    size: f64,
    /// Where it acts.
    #[schemars(with = "Stage")]
    stage: &'static str,
    /// Its unit.
    unit: &'static str,
    /// Size asked for.
    #[schemars(range(min = 0))]
    wanted_size: f64,
}

/// The JSON Schema of [`page`].
pub fn schema() -> Schema {
    stamped_schema::<Page>(SCHEMA)
}

/// The same as one JSON object.
pub fn page(fault: &InjectedFault) -> String {
    let page = Page {
        effect: fault.effect,
        exact: fault.injection.is_exact(),
        law: fault.law,
        magnitude: fault.magnitude,
        observable: fault.is_observable(),
        injection: fault.injection.name(),
        raw_size: fault.raw,
        residual: fault.residual,
        size: fault.size,
        stage: fault.stage.name(),
        unit: fault.unit,
        wanted_size: fault.wanted,
    };
    stamped(SCHEMA, &page)
}
