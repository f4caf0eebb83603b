//! Learns a posterior from a table of evidence:
//!
//! - `cargo run -p switchback-lab --release --example learn -- evidence SEED FIRST COUNT TABLE.csv [RIGS]`: evidence of so many rigs of the population, a row a
//!   rig; shards are begun beside each other and are the same at any number of threads
//! - `… -- report TABLE.csv`: each population's shares out of fold, and the thresholds of least loss
//! - `… -- fit TABLE.csv POSTERIOR.bin`: learns and writes the weights
//! - `… -- compare TABLE.csv FOLDER`: trees, network, ranker and their mean on the same folds, `comparison.md`
//! - `… -- thresholds TABLE.csv POSTERIOR.bin`: thresholds of what is reported, by losses, on rows that the posterior did not learn
//!
//! `TABLE.csv` may be a folder of such tables with the same columns. `RIGS` is the folder of measured rigs, `../shared/rigs` if nothing is said.
//! - `… -- time ROWS COLUMNS CLASSES`: processor time of the trees on a drawn table

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use cpu_time::ProcessTime;
use miette::{IntoDiagnostic, miette};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::fmt::Write;
use std::ops::Range;
use std::path::Path;
use std::process::ExitCode;
use switchback_diagnose::posterior::{Losses, Posterior};
use switchback_io::input::own;
use switchback_io::output::{Artefacts, OutputFile, OutputFolder, note, print};
use switchback_lab::examination::measured_rigs;
use switchback_lab::learning::{
    Binned, BoostingSettings, Compared, Comparison, Group, LearningSettings, Population, Table, Target,
    boost, compare, fit, fit_thresholds, held_out, outcomes, populations,
};
use switchback_lab::population::{EvidenceRow, MeasuredBases, draw};

const USAGE: &str = "evidence SEED FIRST COUNT TABLE.csv [RIGS], report TABLE.csv, fit TABLE.csv POSTERIOR.bin, compare TABLE.csv FOLDER, thresholds TABLE.csv POSTERIOR.bin, or time ROWS COLUMNS CLASSES";

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
            files.add("comparison.md", learners(&comparison));
            place.commit(&files).into_diagnostic()?;
            print(&learners(&comparison))
        }
        ["evidence", seed, first, count, to, rest @ ..] => {
            let place = OutputFile::claim(Path::new(to), false, &[]).into_diagnostic()?;
            let range = number(first)? as u64..(number(first)? + number(count)?) as u64;
            place.commit(evidence(number(seed)? as u64, range, &bases(rest)?)).into_diagnostic()
        }
        ["report", from] => {
            let (judged, p) = held_out(&table(from)?, &settings);
            let outcomes = outcomes(&judged.classes);
            let (thresholds, loss) = fit_thresholds(&p, &judged.labels, &outcomes, &Losses::default());
            print(&shares(&populations(&judged, &p, &outcomes, &thresholds)))?;
            print(&format!(
                "named from {:.3}, class from {:.3}: mean loss {loss:.3}\n",
                thresholds.named, thresholds.class
            ))
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

fn table(place: &str) -> miette::Result<Table> {
    let mut files = vec![place.to_owned()];
    if Path::new(place).is_dir() {
        let entries = std::fs::read_dir(place).into_diagnostic()?;
        files = entries
            .filter_map(|e| Some(e.ok()?.path().display().to_string()))
            .filter(|f| f.ends_with(".csv"))
            .collect();
        files.sort();
    }
    let (mut all, mut header) = (String::new(), String::new());
    for file in &files {
        let text =
            String::from_utf8(bytes(file)?).map_err(|_| miette!("{file}: is no text; give a CSV file"))?;
        let (first, rows) = text.split_once('\n').unwrap_or((&text, ""));
        if header.is_empty() {
            header = first.to_owned();
            all = format!("{header}\n");
        }
        if first != header {
            return Err(miette!("{file}: other columns than {}; make its evidence anew", files[0]));
        }
        all.push_str(rows);
    }
    Table::from_csv(&all).map_err(|error| miette!("{place}: {error}"))
}

fn bases(rest: &[&str]) -> miette::Result<MeasuredBases> {
    let folder = Path::new(rest.first().copied().unwrap_or("../shared/rigs"));
    if !folder.is_dir() {
        note(&format!("NO MEASURED BASES: there is no folder {}; made rigs only\n", folder.display()));
        return Ok(MeasuredBases::default());
    }
    Ok(MeasuredBases::identified(measured_rigs(folder)?).0)
}

/// Rows of the training table.
fn evidence(seed: u64, range: Range<u64>, bases: &MeasuredBases) -> String {
    let rows: Vec<EvidenceRow> =
        range.into_par_iter().filter_map(|index| EvidenceRow::of(&draw(seed, index, bases)?)).collect();
    let mut text = String::from("label,weight,family,law,base,size,kind,given,also");
    for (name, _) in rows.first().map_or(&[][..], |row| &row.columns) {
        let _ = write!(text, ",{name}");
    }
    text.push('\n');
    for row in rows {
        let EvidenceRow { label, group: Group { family, law, base }, truth, columns } = row;
        let given = if truth.is_given { "yes" } else { "no" };
        let _ = write!(
            text,
            "{label},1,{family},\"{law}\",\"{base}\",{},{},{given},{}",
            truth.size as f32,
            truth.kind,
            truth.also.join(";")
        );
        for (_, value) in columns {
            let _ = write!(text, ",{}", value as f32);
        }
        text.push('\n');
    }
    text
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

/// Learners in Markdown.
fn learners(comparison: &Comparison) -> String {
    let mut text = String::from(
        "| learner | rows | log score | Brier | calibration error (perfect) | first | first five |\n|---|--:|--:|--:|--:|--:|--:|\n",
    );
    for Compared { name, scores: s, .. } in &comparison.all {
        let _ = writeln!(
            text,
            "| {name} | {} | {:.3} | {:.3} | {:.3} ({:.3}) | {:.1} % | {:.1} % |",
            s.rows,
            s.log,
            s.brier,
            s.calibration,
            s.perfect,
            100.0 * s.top1,
            100.0 * s.top5
        );
    }
    text
}

/// Shares of populations in Markdown.
fn shares(all: &[Population]) -> String {
    let mut text = String::from(
        "| population | causes | exact | class | class, effects alike | first five | named or class | wrong of these | else on the shortlist | \
         nothing: named | foreign: named |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for p in all {
        let percent = |x: &f64| format!("{:.1} %", 100.0 * x);
        let guess: Vec<String> = p.guess.iter().map(percent).collect();
        let reported: Vec<String> = p.reported.iter().map(percent).collect();
        let of = |(count, share): &(usize, f64)| format!("{} of {count}", percent(share));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            p.name,
            p.causes,
            guess.join(" | "),
            reported.join(" | "),
            of(&p.nothing),
            of(&p.foreign)
        );
    }
    text
}
