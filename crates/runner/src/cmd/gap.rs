//! `switchback gap RIG.toml`

use crate::diagnosis::{self, Report, Subject};
use crate::failure::{CommandResult, Outcome};
use crate::model;
use crate::output::{Artefacts, OutputFolder, print};
use crate::plots;
use crate::rig;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use switchback_gap::Effect;

/// Diagnose the gap between a model and a rig: where it lies, which effect causes it, how far that effect closes it.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The rig file; the CSV files it names lie beside it.
    rig: PathBuf,

    /// Diagnose this model: model.json of `identify --out`, nominal.json or augmented.json of `gap --out`, or the output of
    /// `identify --json` [default: the columns y_sim if the records have them, else the model identified from the fit records]
    #[arg(long, value_name = "MODEL.json")]
    model: Option<PathBuf>,

    /// Leave this effect out of the candidates, where you know that the rig has none of it; may be given more than once.
    #[arg(long, value_name = "EFFECT", value_parser = effect(), hide_possible_values = true)]
    without: Vec<Effect>,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    /// Also write the verdict, gap.json, the models nominal.json and augmented.json, series.csv, the figures and the next
    /// experiment into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads, diagnoses, prints, and writes the folder if one was asked for.
///
/// # Errors
/// A rig or model that cannot be read or diagnosed, or a folder that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let rig = rig::read(&args.rig)?;
    let subject = Subject::choose(rig, args.model.as_deref())?;
    let folder = args.out.as_deref().map(OutputFolder::claim).transpose()?;
    let report = diagnosis::examine(subject, &args.without).map_err(|error| error.in_file(&args.rig))?;
    if let Some(folder) = folder {
        folder.commit(&artefacts(&report))?;
    }
    print(&if args.json {
        diagnosis::json(&report)
    } else {
        diagnosis::words(&report, args.out.as_deref())
    })?;
    Ok(Outcome::Done)
}

fn effect() -> impl TypedValueParser<Value = Effect> {
    PossibleValuesParser::new(Effect::ALL.map(Effect::name))
        .map(|name| Effect::from_name(&name).expect("only names of effects are possible values"))
}

fn artefacts(report: &Report) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add("gap.json", diagnosis::json(report));
    for (name, file) in model::diagnosed(report) {
        artefacts.add(name, file.text());
    }
    artefacts.add("series.csv", model::diagnosed_series(report));
    artefacts.add("verdict.txt", diagnosis::words(report, None));
    for figure in plots::gap::figures(report) {
        artefacts.add(figure.name, figure.svg);
    }
    if let Some(csv) = diagnosis::next_experiment(report) {
        artefacts.add(diagnosis::NEXT_EXPERIMENT, csv);
    }
    artefacts
}
