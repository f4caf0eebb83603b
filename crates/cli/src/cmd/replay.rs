//! `switchback replay RESULTS ID`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use miette::{Diagnostic, IntoDiagnostic};
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::fmt::{self, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use switchback_io::output::{Artefacts, columns, stamped, stamped_schema};
use switchback_study::consistency::{Estimated, Single, SingleRecord, Study};
use switchback_study::results::{self, Cell, Results, Series};
use thiserror::Error;

/// Run one replicate of a study again, alone: why it has no estimate, or how far off one is.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The results of the study: a results.json, a results.json.gz, or the report folder that holds one.
    results: PathBuf,

    /// CELL:REPLICATE, both as in results.json and counted from 0; or REPLICATE alone, for every cell
    #[arg(value_name = "ID")]
    id: Id,

    /// Write the records that the cell's estimate is made from into this folder, as CSV.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print one JSON object instead of words.
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// Which replicate, in which cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Id {
    /// All of them where there is none.
    cell: Option<usize>,
    replicate: u32,
}

impl FromStr for Id {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const WANTED: &str =
            "write CELL:REPLICATE as in 17:118, or REPLICATE alone as in 118, whole numbers up to 4294967295";
        let (cell, replicate) = match text.split_once(':') {
            Some((cell, replicate)) => (Some(cell.parse().map_err(|_| WANTED)?), replicate),
            None => (None, text),
        };
        Ok(Self { cell, replicate: replicate.parse().map_err(|_| WANTED)? })
    }
}

impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(cell) = self.cell {
            write!(f, "{cell}:")?;
        }
        write!(f, "{}", self.replicate)
    }
}

/// What was asked for is not there.
#[derive(Debug, Error, Diagnostic)]
enum ReplayError {
    #[error("{id}: the results have {cells} cells, counted from 0")]
    #[diagnostic(help("the number of a cell is its place in `cells` of results.json"))]
    NoCell { id: Id, cells: usize },
    #[error("{id}: the study has {replicates} replicates, counted from 0")]
    #[diagnostic(help(
        "the numbers of those without an estimate are in `failures` of each cell of results.json"
    ))]
    NoReplicate { id: Id, replicates: usize },
    #[error("{id}: --out writes the records of one cell")]
    #[diagnostic(help("name the cell too, as in 0:{replicate}", replicate = id.replicate))]
    ManyRecords { id: Id },
    #[error("{name}: the scenario in the results has other cells than the results")]
    #[diagnostic(help("another version of the program made them: replay with version {version}"))]
    OtherCells { name: String, version: String },
}

/// Reads the results, runs the replicate, shows what came out.
///
/// # Errors
/// Results that are none or of another version, a cell that is not there, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let results = results::read(&args.results)?;
    let id = args.id;
    let cells = results.cells.len();
    if id.cell.is_some_and(|cell| cell >= cells) {
        return Err(ReplayError::NoCell { id, cells }.into());
    }
    let of = |cell: &Cell| cell.replicates;
    let replicates =
        id.cell.map_or_else(|| results.cells.iter().map(of).max(), |k| Some(of(&results.cells[k])));
    let replicates = replicates.unwrap_or_default();
    if id.replicate as usize >= replicates {
        return Err(ReplayError::NoReplicate { id, replicates }.into());
    }
    let files = ["descendant.csv", "ascendant.csv", "record.csv"];
    let folder = args.output.force.claim_if_asked(args.out.as_deref(), &files, &[&args.results])?;
    let scenario = results.to_scenario()?;
    let study = args.threads.install(|| Study::plan(&scenario))?.into_diagnostic()?;
    study.begin_methods().into_diagnostic()?;
    let found = args.threads.install(|| study.replicate(id.replicate as usize))?;
    if found.len() != cells {
        let Results { name, version, .. } = results;
        return Err(ReplayError::OtherCells { name, version }.into());
    }
    if let Some(folder) = folder {
        let cell = id.cell.ok_or(ReplayError::ManyRecords { id })?;
        let records = args.threads.install(|| study.records(cell, id.replicate))?.into_diagnostic()?;
        folder.commit(&artefacts(&records))?;
    }
    let chosen: Vec<(usize, &Cell, &Single)> = (0..cells)
        .filter(|cell| id.cell.is_none_or(|chosen| chosen == *cell))
        .map(|cell| (cell, &results.cells[cell], &found[cell]))
        .collect();
    let words = || match &chosen[..] {
        [(_, cell, single)] if id.cell.is_some() => one_cell(id, cell, single, args.out.as_deref()),
        _ => all_cells(id, &chosen),
    };
    args.output.quiet.describe_or(args.json, || json(id, &chosen), words)?;
    Ok(Outcome::Done)
}

fn one_cell(id: Id, cell: &Cell, single: &Single, out: Option<&Path>) -> String {
    let mut text = format!("replicate {} of {}, N = {}\n", id.replicate, cell.series, cell.samples);
    match &single.estimates {
        Err(reason) => {
            let _ = writeln!(text, "no estimate: {reason}");
        }
        Ok(estimates) => {
            let header =
                ["parameter", "truth", "estimate", "error", "reported se", "error/se"].map(str::to_owned);
            let row = |e: &Estimated| {
                let [truth, estimate] = [e.truth, e.truth + e.error].map(|x| format!("{x:.6}"));
                let [error, se] = [e.error, e.se].map(|x| format!("{x:.3e}"));
                [e.name.clone(), truth, estimate, error, se, format!("{:+.2}", e.error / e.se)]
            };
            text += &columns(&[header].into_iter().chain(estimates.iter().map(row)).collect::<Vec<_>>());
        }
    }
    if let Some(out) = out {
        let _ = writeln!(text, "records written to {}", out.display());
    }
    text
}

/// The estimates that are furthest off, and those that are none.
fn all_cells(id: Id, cells: &[(usize, &Cell, &Single)]) -> String {
    const MOST: usize = 12;
    let mut text = String::new();
    let title = |cell: &Cell| format!("{}, N = {}", cell.series, cell.samples);
    let failed = cells.iter().filter_map(|(k, cell, single)| {
        let reason = single.estimates.as_ref().err()?;
        Some(format!("  {k}:{}  {}: {reason}", id.replicate, title(cell)))
    });
    let failed: Vec<String> = failed.collect();
    let _ = writeln!(
        text,
        "replicate {}: no estimate in {} of {} cells",
        id.replicate,
        failed.len(),
        cells.len()
    );
    failed.iter().take(MOST).for_each(|line| text += &format!("{line}\n"));
    if failed.len() > MOST {
        let _ = writeln!(text, "  … and {} more", failed.len() - MOST);
    }
    let mut off: Vec<(f64, String)> = cells
        .iter()
        .flat_map(|(k, cell, single)| {
            let estimates = single.estimates.as_deref().unwrap_or_default();
            let line = |e: &Estimated| format!("  {k}:{}  {} of {}", id.replicate, e.name, title(cell));
            estimates.iter().map(|e| (e.error / e.se, line(e))).collect::<Vec<_>>()
        })
        .filter(|(z, _)| z.is_finite())
        .collect();
    off.sort_by(|(x, _), (y, _)| y.abs().total_cmp(&x.abs()));
    let _ = writeln!(text, "furthest off, in reported standard errors:");
    for (z, line) in off.iter().take(MOST) {
        let _ = writeln!(text, "{line}: {z:+.2}");
    }
    text
}

/// Name and version of the layout.
const SCHEMA: &str = "switchback/replay/1";

/// One replicate alone: `replay --json`.
#[derive(Serialize, JsonSchema)]
struct Page<'a> {
    /// Its number.
    replicate: u32,
    /// The cells.
    cells: Vec<PageCell<'a>>,
}

#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Cell")]
struct PageCell<'a> {
    /// Its number in results.json.
    cell: usize,
    #[serde(flatten)]
    series: &'a Series,
    /// `N`: regression samples of each experiment.
    samples: usize,
    /// Why there are no estimates.
    failed: Option<&'a str>,
    /// Estimates with their errors: estimate less truth.
    parameters: &'a [Estimated],
}

/// The JSON Schema of what `--json` prints.
pub(crate) fn schema() -> Schema {
    stamped_schema::<Page<'_>>(SCHEMA)
}

fn json(id: Id, cells: &[(usize, &Cell, &Single)]) -> String {
    let cells = cells.iter().map(|&(number, cell, single)| PageCell {
        cell: number,
        series: &cell.series,
        samples: cell.samples,
        failed: single.estimates.as_ref().err().map(String::as_str),
        parameters: single.estimates.as_deref().unwrap_or_default(),
    });
    stamped(SCHEMA, &Page { replicate: id.replicate, cells: cells.collect() })
}

/// Each record as the data that every verb reads.
fn artefacts(records: &[SingleRecord]) -> Artefacts {
    let mut artefacts = Artefacts::default();
    for SingleRecord { name, v, y } in records {
        let rows = v.iter().zip(y).fold("v,y\n".to_owned(), |mut text, (v, y)| {
            let _ = writeln!(text, "{v},{y}");
            text
        });
        artefacts.add(format!("{name}.csv"), rows);
    }
    artefacts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_names_a_replicate_and_perhaps_a_cell() {
        let ids = ["17:118", "118"].map(|text| text.parse::<Id>());
        assert_eq!(ids, [Ok(Id { cell: Some(17), replicate: 118 }), Ok(Id { cell: None, replicate: 118 })]);
        for text in ["", ":", "1:", ":1", "-1", "1:2:3", "a"] {
            assert!(text.parse::<Id>().is_err(), "{text}");
        }
    }
}
