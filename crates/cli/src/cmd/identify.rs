//! `switchback identify DATA.csv …` or `switchback identify RIG.toml`

use super::data_args::DataArgs;
use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use crate::progress::Watch;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use switchback_io::identification::{self, Method, Request, examined_watched};
use switchback_report::identification::artefacts;
use switchback_report::pages::INDEX;

/// Identify the linear part and both borders from a rig's records.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    data: DataArgs,

    /// paper-descendant, paper-ascendant, joint, efficient, instrumental, free, linear-arx or memoryless [default:
    /// the best that the records allow]
    #[arg(long, value_parser = method(), hide_possible_values = true)]
    method: Option<Method>,

    /// Only models that could run in real time: no look ahead, and a reversal takes effect once it is confirmed.
    #[arg(long)]
    causal: bool,

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

/// What the folder gets.
const FILES: [&str; 6] =
    [INDEX, "estimate.json", "model.json", "series.csv", "borders.svg", "measured_and_simulated_*.svg"];

/// Reads, identifies, prints, and writes the folder if one was asked for.
///
/// # Errors
/// A rig that cannot be read or identified, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let (data, loaded) = args.data.load("identify", args.output.quiet)?;
    let folder = args.output.force.claim_if_asked(args.out.as_deref(), &FILES, &data.inputs(&loaded.plan))?;
    let rig = loaded.rig;
    let request = Request::new(&rig, args.method, args.causal);
    let watch = Watch::new(args.output.quiet);
    let identification = args.threads.install(|| examined_watched(&rig, request, &watch))?;
    let identification = identification.map_err(|error| error.in_file(data.place()))?;
    watch.finish();
    if let Some(folder) = folder {
        folder.commit(&artefacts(&rig, &identification)?)?;
    }
    let json = || identification::json(&rig, &identification);
    args.output.quiet.describe_or(args.json, json, || identification::table(&rig, &identification))?;
    Ok(Outcome::Done)
}

fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name))
        .map(|name| Method::from_name(&name).expect("only names of methods are possible values"))
}
