//! `switchback train TABLE… --out POSTERIOR.bin`, and `switchback train --draw COUNT … --out TABLE.csv`

use crate::failure::{CommandResult, Outcome};
use crate::options::{Output, Threads};
use clap::ArgGroup;
use miette::{Diagnostic, miette};
use std::ops::Range;
use std::path::{Path, PathBuf};
use switchback_io::input::{names, own};
use switchback_io::output::note;
use switchback_lab::examination::measured_rigs;
use switchback_lab::learning::{Fitted, LearningSettings, Table, TableError, fit, outcomes, populations};
use switchback_lab::population::{MeasuredBases, evidence_table};
use switchback_study::Shard;
use thiserror::Error;

/// Train the posterior that decides on records which nobody designed.
///
/// First tables of evidence: rigs with known causes are drawn, and what the program sees of each is a row. Then the posterior learns from these.
/// What it reaches is reported for rows whose base and law it has not learnt.
#[derive(Debug, clap::Args)]
#[command(group(ArgGroup::new("work").required(true)))]
pub(crate) struct Args {
    /// Tables of evidence, or folders of these
    #[arg(value_name = "TABLE", group = "work")]
    tables: Vec<PathBuf>,

    /// Draw so many rigs, and write the table of their evidence
    #[arg(long, value_name = "COUNT", group = "work", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    draw: Option<u64>,

    /// Only one part of the rigs that are drawn: K of N
    #[arg(long, value_name = "K/N", conflicts_with = "tables")]
    shard: Option<Shard>,

    /// Seed of the population
    #[arg(long, value_name = "SEED", default_value_t = 1, conflicts_with = "tables")]
    seed: u64,

    /// Folder of measured rigs, half of the rigs drawn stand on these [default: none, made rigs only]
    #[arg(long, value_name = "RIGS", conflicts_with = "tables")]
    measured: Option<PathBuf>,

    /// The posterior, or the table, goes into this file.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    output: Output,
}

/// Tables that no posterior can be trained on.
#[derive(Debug, Error, Diagnostic)]
enum TableProblem {
    #[error("{0}: cannot be read: {1}")]
    #[diagnostic(help("give tables that `switchback train --draw COUNT --out TABLE.csv` has written"))]
    NotRead(String, String),
    #[error("{0}: has other columns than {1}")]
    #[diagnostic(help("draw it anew with this program"))]
    OtherColumns(String, String),
    #[error("{0}: holds no table (*.csv)")]
    #[diagnostic(help("give the folder into which the parts were written"))]
    NoTable(String),
    #[error("{place}: {source}")]
    #[diagnostic(help("give tables that `switchback train --draw COUNT --out TABLE.csv` has written"))]
    Bad { place: String, source: TableError },
}

/// Draws or trains.
///
/// # Errors
/// Tables that cannot be read or teach nothing, a folder that holds no measured rigs, or a file that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    let out = args.output.force.claim_file(Some(&args.out), &[])?;
    let bytes = match args.draw {
        Some(count) => {
            let numbers = numbers(count, args.shard);
            let bases = bases(args)?;
            args.threads.install(|| evidence_table(args.seed, numbers, &bases))?.into_bytes()
        }
        None => {
            let (table, files) = table(&args.tables)?;
            let provenance = format!(
                "switchback train: {} rows of {} columns in {files} tables",
                table.rows(),
                table.columns.len()
            );
            let fitted = args.threads.install(|| fit(&table, &LearningSettings::default(), &provenance))?;
            let place = args.tables.first().map_or_else(String::new, |place| place.display().to_string());
            let fitted = fitted.map_err(|source| TableProblem::Bad { place, source })?;
            args.output.quiet.describe(&summary(&fitted))?;
            fitted.posterior.write()
        }
    };
    if let Some(out) = out {
        out.commit(bytes)?;
    }
    Ok(Outcome::Done)
}

/// Numbers of the rigs of a part.
fn numbers(count: u64, shard: Option<Shard>) -> Range<u64> {
    let Some(Shard { number, of }) = shard else { return 0..count };
    let (number, of) = (number as u64, of as u64);
    count * (number - 1) / of..count * number / of
}

fn bases(args: &Args) -> miette::Result<MeasuredBases> {
    let Some(folder) = &args.measured else { return Ok(MeasuredBases::default()) };
    let (bases, refused) =
        args.threads.install(|| measured_rigs(folder).map(MeasuredBases::identified))??;
    for (name, reason) in refused {
        note(&format!("{name} is no base: {reason}\n"));
    }
    if bases.is_empty() {
        return Err(miette!(
            "{}: holds no measured rig that a model can be identified from; leave --measured out to draw made rigs only",
            folder.display()
        ));
    }
    Ok(bases)
}

/// The files of tables: those given, and those in folders given.
fn files(places: &[PathBuf]) -> Result<Vec<PathBuf>, TableProblem> {
    let mut all = Vec::new();
    for place in places {
        if !place.is_dir() {
            all.push(place.clone());
            continue;
        }
        let shown = || place.display().to_string();
        let names = names(place).map_err(|e| TableProblem::NotRead(shown(), e.to_string()))?;
        let mut found: Vec<PathBuf> = names
            .into_iter()
            .map(|name| place.join(name))
            .filter(|f| f.extension().is_some_and(|e| e == "csv") && f.is_file())
            .collect();
        if found.is_empty() {
            return Err(TableProblem::NoTable(shown()));
        }
        found.sort();
        all.append(&mut found);
    }
    Ok(all)
}

/// All tables as one, and their number.
fn table(places: &[PathBuf]) -> Result<(Table, usize), TableProblem> {
    let files = files(places)?;
    let shown = |file: &Path| file.display().to_string();
    let (mut all, mut header) = (String::new(), String::new());
    for file in &files {
        let not_read = |why: String| TableProblem::NotRead(shown(file), why);
        let bytes = own(file).map_err(|error| not_read(error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|_| not_read("it is no text".to_owned()))?;
        let (first, rows) = text.split_once('\n').unwrap_or((&text, ""));
        if header.is_empty() {
            first.clone_into(&mut header);
            all = format!("{header}\n");
        }
        if first != header {
            return Err(TableProblem::OtherColumns(shown(file), shown(&files[0])));
        }
        all.push_str(rows);
    }
    let place = files.first().map_or_else(String::new, |file| shown(file));
    let table = Table::from_csv(&all).map_err(|source| TableProblem::Bad { place, source })?;
    Ok((table, files.len()))
}

/// What the posterior reaches, a line a population.
fn summary(fitted: &Fitted) -> String {
    let Fitted { posterior, judged, probabilities, loss } = fitted;
    let mut rows = vec![
        [
            "population",
            "causes",
            "exact",
            "class",
            "each alike",
            "first 5",
            "named or class",
            "wrong of these",
            "else listed",
            "nothing: named",
            "foreign: named",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let percent = |x: &f64| format!("{:.1} %", 100.0 * x);
    for p in populations(judged, probabilities, &outcomes(&judged.classes), &posterior.thresholds) {
        let of = |(count, share): &(usize, f64)| format!("{} of {count}", percent(share));
        let shares = p.guess.iter().chain(&p.reported).map(percent);
        let row = [p.name.clone(), p.causes.to_string()].into_iter().chain(shares);
        rows.push(row.chain([of(&p.nothing), of(&p.foreign)]).collect());
    }
    let widths: Vec<usize> = (0..rows[0].len())
        .map(|k| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0))
        .collect();
    let mut text = format!(
        "{}; held out by base and law:\n\n",
        posterior.provenance.trim_start_matches("switchback train: ")
    );
    for row in rows {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        text += cells.join("  ").trim_end();
        text.push('\n');
    }
    let thresholds = posterior.thresholds;
    text + &format!(
        "\nnamed from {:.3}, class from {:.3}: mean loss {loss:.3} on measured bases\n",
        thresholds.named, thresholds.class
    )
}
