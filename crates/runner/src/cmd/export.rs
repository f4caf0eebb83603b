//! `switchback export MODEL.json --to python`, `c` or `fmu`

use crate::export::{self, Target, heading, name_from};
use crate::failure::{CommandResult, Outcome};
use crate::model;
use crate::options::{Force, Quiet};
use std::path::PathBuf;

/// Take a model with you: as a Python file, a C header or an FMU that simulators open.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// model.json of `identify --out`, or nominal.json or augmented.json of `gap --out`.
    model: PathBuf,

    /// What to make of it.
    #[arg(long, value_name = "TARGET")]
    to: Target,

    /// The file to write [default: the model's name with .py, .h or .fmu, in this folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// What the model is called in the file [default: the name of the file, else of the rig]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,

    /// The library that goes into an FMU [default: the one beside this program]
    #[arg(long, value_name = "LIBRARY")]
    library: Option<PathBuf>,

    #[command(flatten)]
    quiet: Quiet,

    #[command(flatten)]
    force: Force,
}

/// Reads, translates, writes.
///
/// # Errors
/// A file that is no model, a model that looks ahead, or a file that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let file = model::read(&args.model)?;
    let causal = file.causal().map_err(|error| error.in_file(&args.model))?;
    let stem = args.out.as_deref().and_then(|out| out.file_stem()).and_then(|stem| stem.to_str());
    let name = name_from(args.name.as_deref().or(stem).unwrap_or(&file.header.rig));
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.{}", args.to.ending())));
    // What is missing is told before anything is claimed.
    let library = match args.to {
        Target::Fmu => export::library(args.library.as_deref())?,
        Target::Python | Target::C => Vec::new(),
    };
    let target = args.force.claim_file(Some(&out), &[&args.model])?.expect("a file was named");
    let program = causal.program();
    let heading = heading(&file, &name);
    match args.to {
        Target::Python => target.commit(switchback_step::python(&program, &heading))?,
        Target::C => target.commit(switchback_step::c(&program, &heading))?,
        Target::Fmu => target.commit(export::fmu(&file, (program, &heading), &library)?)?,
    }
    args.quiet.tell(&format!("{}\n", out.display()))?;
    Ok(Outcome::Done)
}
