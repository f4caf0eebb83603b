//! `switchback export MODEL.json --to c` or `fmu`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};
use switchback_io::export::{self, Target, heading, name_from};
use switchback_io::model::{self, ModelFile};

/// Take a model with you: as a C header or an FMU that simulators open.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// model.json of `identify --out`, or nominal.json or augmented.json of `gap --out`.
    model: PathBuf,

    #[command(flatten)]
    asked: Asked,

    /// The file to write [default: the model's name with .h or .fmu, in this folder]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    #[command(flatten)]
    output: Output,
}

/// What to make of a model.
#[derive(Debug, clap::Args)]
pub struct Asked {
    /// What to make of it.
    #[arg(long, value_name = "TARGET", value_parser = target())]
    to: Target,

    /// What the model is called in the file [default: the name of the file, else of the rig]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,

    /// The library that goes into an FMU [default: the one beside this program]
    #[arg(long, value_name = "LIBRARY")]
    library: Option<PathBuf>,
}

fn target() -> impl TypedValueParser<Value = Target> {
    PossibleValuesParser::new(Target::ALL.map(Target::name))
        .map(|name| Target::from_name(&name).expect("only names of targets are possible values"))
}

/// Reads, translates, writes.
///
/// # Errors
/// A file that is no model, a model that looks ahead, or a file that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let file = model::read(&args.model)?;
    let name = args.asked.name(&file, args.out.as_deref());
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.{}", args.asked.to.ending())));
    // What is missing is reported before anything is claimed.
    let made = made(&file, &args.asked, (&args.model, &name))?;
    let target = args.output.force.claim_file(Some(&out), &[&args.model])?.expect("a file was named");
    target.commit(made)?;
    args.output.quiet.describe(&format!("{}\n", out.display()))?;
    Ok(Outcome::Done)
}

impl Asked {
    /// What the model is called, in a file of that path if there is one.
    pub fn name(&self, file: &ModelFile, out: Option<&Path>) -> String {
        let stem = out.and_then(Path::file_stem).and_then(|stem| stem.to_str());
        name_from(self.name.as_deref().or(stem).unwrap_or(&file.header.rig))
    }
}

/// The bytes of the file alone: nothing is read or written but the library of an FMU. `place` is what messages call the model, `name` what it is
/// called in the file.
///
/// # Errors
/// A model that looks ahead, or a library that is missing.
pub fn made(file: &ModelFile, asked: &Asked, (place, name): (&Path, &str)) -> miette::Result<Vec<u8>> {
    let program = file.causal().map_err(|error| error.in_file(place))?.program();
    let heading = heading(file, name);
    Ok(match asked.to {
        Target::C => switchback_model::step::c(&program, &heading).into(),
        Target::Fmu => {
            let library = export::library(asked.library.as_deref())?;
            export::fmu(file, (program, &heading), &library)?
        }
    })
}
