//! `switchback export MODEL.json --to c` or `fmu`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use switchback_io::export::{Request, Target};
use switchback_io::model;

/// Take a model with you: as a C header or an FMU that simulators open.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// model.json of `identify --out`, or nominal.json or augmented.json of `gap --out`.
    model: PathBuf,

    /// What to make of it.
    #[arg(long, value_name = "TARGET", value_parser = target())]
    to: Target,

    /// What the model is called in the file [default: the name of the file, else of the rig]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,

    /// The library that goes into an FMU [default: the one beside this program]
    #[arg(long, value_name = "LIBRARY")]
    library: Option<PathBuf>,

    /// The file to write [default: the model's name with .h or .fmu, in this folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    #[command(flatten)]
    output: Output,
}

fn target() -> impl TypedValueParser<Value = Target> {
    PossibleValuesParser::new(Target::ALL.map(Target::name))
        .map(|name| Target::from_name(&name).expect("only names of targets are possible values"))
}

/// Reads, translates, writes.
///
/// # Errors
/// A file that is no model, a model that looks ahead, or a file that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let file = model::read(&args.model)?;
    let request = Request { to: args.to, name: args.name.clone(), library: args.library.clone() };
    let name = request.name(&file, args.out.as_deref());
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.{}", args.to.ending())));
    // What is missing is reported before anything is claimed.
    let made = request.export(&file, (&args.model, &name))?;
    let target = args.output.force.claim_file(Some(&out), &[&args.model])?.expect("a file was named");
    target.commit(made)?;
    args.output.quiet.describe(&format!("{}\n", out.display()))?;
    Ok(Outcome::Done)
}
