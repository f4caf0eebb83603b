//! Learns a posterior from a table of evidence (CSV: `label,weight,family,law,base`, then named numbers):
//!
//! - `cargo run -p switchback-lab --release --example learn -- fit TABLE.csv POSTERIOR.bin`: learns and writes the weights
//! - `… -- compare TABLE.csv FOLDER`: trees, network, ranker and their mean on the same folds, `comparison.md` and `comparison.json`
//! - `… -- thresholds TABLE.csv POSTERIOR.bin`: thresholds of what is reported, by losses, on rows that the posterior did not learn
//! - `… -- time ROWS COLUMNS CLASSES`: processor time of the trees on a drawn table

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use cpu_time::ProcessTime;
use miette::{IntoDiagnostic, miette};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use std::process::ExitCode;
use switchback_diagnose::posterior::{Losses, Posterior};
use switchback_io::input::own;
use switchback_io::output::{Artefacts, OutputFile, OutputFolder, note, print};
use switchback_lab::learning::{
    Binned, BoostingSettings, LearningSettings, Table, Target, boost, compare, fit, fit_thresholds, outcomes,
};

const USAGE: &str = "fit TABLE.csv POSTERIOR.bin, compare TABLE.csv FOLDER, thresholds TABLE.csv POSTERIOR.bin, or time ROWS COLUMNS CLASSES";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            note(&format!("error: {error}\n"));
            ExitCode::from(2)
        }
    }
}

fn run() -> miette::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let settings = LearningSettings::default();
    match words.as_slice() {
        ["fit", from, to] => {
            let place = OutputFile::claim(Path::new(to), false, &[Path::new(from)]).into_diagnostic()?;
            let table = table(from)?;
            let provenance =
                format!("learn fit {from}: {} rows, {} columns", table.rows(), table.columns.len());
            place.commit(fit(&table, &settings, &provenance).write()).into_diagnostic()
        }
        ["compare", from, to] => {
            let place = OutputFolder::claim(Path::new(to), false).into_diagnostic()?;
            let comparison = compare(&table(from)?, &settings);
            let mut files = Artefacts::default();
            files.add("comparison.md", comparison.markdown());
            files.add("comparison.json", comparison.json());
            place.commit(&files).into_diagnostic()?;
            print(&comparison.markdown())
        }
        ["thresholds", from, weights] => thresholds(&table(from)?, weights),
        ["time", rows, columns, classes] => time(number(rows)?, number(columns)?, number(classes)?),
        _ => Err(miette!("{USAGE}")),
    }
}

fn number(word: &str) -> miette::Result<usize> {
    word.parse().map_err(|_| miette!("`{word}` is no number; {USAGE}"))
}

fn bytes(file: &str) -> miette::Result<Vec<u8>> {
    own(Path::new(file)).map_err(|error| miette!("{file}: cannot be read: {error}"))
}

fn table(file: &str) -> miette::Result<Table> {
    let text = String::from_utf8(bytes(file)?).map_err(|_| miette!("{file}: is no text; give a CSV file"))?;
    Table::from_csv(&text).map_err(|error| miette!("{file}: {error}"))
}

fn thresholds(table: &Table, weights: &str) -> miette::Result<()> {
    let posterior = Posterior::read(&bytes(weights)?).map_err(|error| miette!("{weights}: {error}"))?;
    let mut p = Vec::new();
    for row in 0..table.rows() {
        let numbers = table.row(row);
        let named: Vec<(&str, f64)> = table.columns.iter().map(String::as_str).zip(numbers).collect();
        let family = &table.groups[row].family;
        let found = posterior.row(&named).and_then(|row| posterior.probabilities(&row, family));
        p.push(found.map_err(|error| miette!("{weights}: {error}"))?);
    }
    let position = |label: &usize| {
        let class = &table.classes[*label];
        let found = posterior.classes.iter().position(|known| known == class);
        found.ok_or_else(|| {
            miette!("{weights}: does not know the label `{class}` of the table; learn it anew")
        })
    };
    let labels = table.labels.iter().map(position).collect::<miette::Result<Vec<usize>>>()?;
    let (found, loss) = fit_thresholds(&p, &labels, &outcomes(&posterior.classes), &Losses::default());
    print(&format!("named from {:.3}, class from {:.3}: mean loss {loss:.3}\n", found.named, found.class))
}

fn time(rows: usize, columns: usize, classes: usize) -> miette::Result<()> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let labels: Vec<usize> = (0..rows).map(|row| row % classes).collect();
    let shift = |row: usize, column: usize| if labels[row] == column % (2 * classes) { 0.7 } else { 0.0 };
    let values: Vec<Vec<f64>> = (0..columns)
        .map(|c| (0..rows).map(|r| rng.random_range(-1.0..1.0) + shift(r, c)).collect())
        .collect();
    let started = ProcessTime::now();
    let settings = BoostingSettings::default();
    let trees = boost(&Binned::new(&values), &Target::Classes(labels, classes), &vec![1.0; rows], &settings);
    let spent = started.elapsed().as_secs_f64();
    let leaves: usize = trees.rounds.iter().flatten().map(|tree| tree.0.len().div_ceil(2)).sum();
    print(&format!(
        "{rows} rows, {columns} columns, {classes} classes, {} rounds, {leaves} leaves: {:.1} processor minutes\n",
        settings.rounds,
        spent / 60.0
    ))
}
