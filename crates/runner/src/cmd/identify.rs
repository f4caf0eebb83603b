//! `switchback identify RIG.toml`

use crate::failure::{CommandResult, Outcome};
use crate::identification::{self, Identification, Method};
use crate::model;
use crate::output::{Artefacts, OutputFolder, print};
use crate::plots;
use crate::rig;
use std::path::PathBuf;
use switchback_estimator::rig::Rig;

/// Identify the linear part and both borders from a rig's records.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The rig file; the CSV files it names lie beside it.
    rig: PathBuf,

    /// paper-descendant, paper-ascendant, joint, efficient, free, linear-arx or memoryless [default: the best that the
    /// records allow]
    #[arg(long, value_parser = method_by_name)]
    method: Option<Method>,

    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,

    /// Also write estimate.json, model.json, series.csv and the plots into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads, identifies, prints, and writes the folder if one was asked for.
///
/// # Errors
/// A rig that cannot be read or identified, or a folder that cannot be written.
pub fn run(args: &Args) -> CommandResult {
    let rig = rig::read(&args.rig)?;
    let folder = args.out.as_deref().map(OutputFolder::claim).transpose()?;
    let method = args.method.unwrap_or_else(|| identification::default_method(&rig));
    let identification = identification::identify(&rig, method).map_err(|error| error.in_file(&args.rig))?;
    if let Some(folder) = folder {
        folder.commit(&artefacts(&rig, &identification)?)?;
    }
    let page = if args.json {
        identification::json(&rig, &identification)
    } else {
        identification::table(&rig, &identification)
    };
    print(&page)?;
    Ok(Outcome::Done)
}

fn method_by_name(name: &str) -> Result<Method, String> {
    let known = || Method::ALL.map(Method::name).join(", ");
    Method::from_name(name).ok_or_else(|| format!("the methods are {}", known()))
}

fn artefacts(rig: &Rig, identification: &Identification) -> miette::Result<Artefacts> {
    let mut artefacts = Artefacts::default();
    artefacts.add("estimate.json", identification::json(rig, identification));
    if let Some(model) = model::identified(rig, identification) {
        artefacts.add("model.json", model.text());
    }
    artefacts.add("series.csv", model::identified_series(rig, identification));
    for (record, run) in rig.records.iter().zip(&identification.runs) {
        let Some(run) = run else { continue };
        let name = format!("measured_and_simulated_{}.svg", record.name);
        artefacts.add(name, plots::identify::outputs(rig, record, run)?);
    }
    if let Some(svg) = plots::identify::borders(rig, identification)? {
        artefacts.add("borders.svg", svg);
    }
    Ok(artefacts)
}
