//! `switchback plant DATA.csv … --effect EFFECT --size 2 --out DIR`

use super::data_args::DataArgs;
use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use std::path::PathBuf;
use switchback_io::diagnosis::Units;
use switchback_io::values::{number, whole};
use switchback_io::{model, rig};
use switchback_lab::plant::{Request, json, plant, words};

/// Put a known fault into measured records, and print what was put in: to try whether a diagnosis finds it.
///
/// What the sensor makes of the output, a gain, and what the record of the input shows are changed in the records themselves. Any other
/// effect is carried by a model of the machine: its simulation with the effect less the one without is added to the measured output.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    data: DataArgs,

    /// Effect to put in; `switchback rig --list` shows all.
    #[arg(long, value_name = "EFFECT")]
    effect: String,

    /// Which law of the effect, 0 being the plain one.
    #[arg(long, default_value_t = Request::default().law, value_parser = whole::<usize>(0..=u64::from(u32::MAX)))]
    law: usize,

    /// What survives identification anew, over the residual that the records' own model leaves on held-out ones.
    #[arg(long, default_value_t = Request::default().size, value_parser = number)]
    size: f64,

    /// What else there is to the effect (a frequency, an instant, noise) is drawn from this.
    #[arg(long, default_value_t = Request::default().seed, value_parser = whole::<u64>(0..=u64::MAX))]
    seed: u64,

    /// Model that carries the effect, of `identify --method free --out` [default: one identified from the fit records, with a pole and knots
    /// to spare]
    #[arg(long, value_name = "MODEL.json")]
    model: Option<PathBuf>,

    /// Folder for rig.toml and the records; what was put in is printed, not written there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Print what was put in as JSON.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    output: Output,
}

/// What the folder gets.
const FILES: [&str; 2] = [rig::RIG_FILE, "*.csv"];

/// Plants the fault, writes the folder, prints what was put in.
///
/// # Errors
/// Data that cannot be read or carry nothing, an unknown effect or law, a size that is none, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let Args { effect, law, size, seed, .. } = args;
    let request = Request { effect: effect.clone(), law: *law, size: *size, seed: *seed };
    request.check()?;
    let host_model = args.model.as_deref().map(model::read).transpose()?;
    let host_model = host_model.as_ref().zip(args.model.as_deref());
    let (data, loaded) = args.data.load("plant", args.output.quiet)?;
    let folder = args.output.force.claim_if_asked(Some(&args.out), &FILES, &data.inputs(&loaded.plan))?;
    let injected = plant(&loaded.rig, &request, (data.place(), host_model))?;
    if let Some(folder) = folder {
        folder.commit(&rig::artefacts(&injected.rig))?;
    }
    let words = || words(&injected.fault, &Units::of(&injected.rig).output);
    args.output.quiet.describe_or(args.json, || json(&injected.fault), words)?;
    Ok(Outcome::Done)
}
