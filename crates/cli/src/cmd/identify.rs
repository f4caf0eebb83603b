//! `switchback identify DATA.csv …` or `switchback identify RIG.toml`

use super::data_args::DataArgs;
use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use crate::progress::Watch;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};
use switchback_io::identification::json::EstimateFile;
use switchback_io::identification::{self, Identification, Method, Request};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_io::progress::Stages;
use switchback_model::rig::Rig;
use switchback_report::pages::{self, INDEX};
use switchback_report::plots;

/// Identify the linear part and both borders from a rig's records.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,

    #[command(flatten)]
    asked: Asked,

    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,

    /// Also write estimate.json, model.json, series.csv, the plots and the page index.html into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// What is asked of the records.
#[derive(Debug, clap::Args)]
pub struct Asked {
    /// paper-descendant, paper-ascendant, joint, efficient, instrumental, free, linear-arx or memoryless [default:
    /// the best that the records allow]
    #[arg(long, value_parser = method(), hide_possible_values = true)]
    method: Option<Method>,

    /// Only models that could run in real time: no look ahead, and a reversal takes effect once it is confirmed.
    #[arg(long)]
    causal: bool,
}

/// What the folder gets.
const FILES: [&str; 6] =
    [INDEX, "estimate.json", "model.json", "series.csv", "borders.svg", "measured_and_simulated_*.svg"];

/// Reads, identifies, prints, and writes the folder if one was asked for.
///
/// # Errors
/// A rig that cannot be read or identified, or a folder that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let loaded = args.data.load("identify", args.output.quiet)?;
    let folder = args.output.force.claim_if_asked(args.out.as_deref(), &FILES, &args.data.inputs(&loaded))?;
    let rig = loaded.rig;
    let watch = Watch::new(args.output.quiet);
    let identification = identified(&rig, &args.asked, (args.data.path(), args.threads, &watch))?;
    watch.finish();
    if let Some(folder) = folder {
        folder.commit(&artefacts(&rig, &identification)?)?;
    }
    let json = || identification::json(&rig, &identification);
    args.output.quiet.describe_or(args.json, json, || identification::table(&rig, &identification))?;
    Ok(Outcome::Done)
}

/// The identification alone: nothing is read, printed or written. `place` is what messages call the records.
///
/// # Errors
/// Records that nothing can be identified from.
pub fn identified(
    rig: &Rig,
    asked: &Asked,
    (place, threads, progress): (&Path, Threads, &dyn Stages),
) -> miette::Result<Identification> {
    let method = asked.method.unwrap_or_else(|| identification::default_method(rig));
    let request = Request { method, causal: asked.causal };
    let identification = threads.install(|| identification::examined_watched(rig, request, progress))?;
    Ok(identification.map_err(|error| error.in_file(place))?)
}

fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name))
        .map(|name| Method::from_name(&name).expect("only names of methods are possible values"))
}

/// The files of an identification.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn artefacts(rig: &Rig, identification: &Identification) -> miette::Result<Artefacts> {
    let mut artefacts = Artefacts::default();
    artefacts.add("estimate.json", identification::json(rig, identification));
    if let Some(model) = model::identified(rig, identification) {
        artefacts.add("model.json", model.text());
    }
    artefacts.add("series.csv", model::identified_series(rig, identification).text());
    for (record, run) in rig.records.iter().zip(&identification.runs) {
        let Some(run) = run else { continue };
        let name = format!("measured_and_simulated_{}.svg", record.name);
        artefacts.add(name, plots::identify::outputs(rig, record, run));
    }
    if let Some(svg) = plots::identify::borders(&EstimateFile::of(rig, identification)) {
        artefacts.add("borders.svg", svg);
    }
    Ok(pages::bound(artefacts)?)
}
