//! Learners compared on a table of evidence, as `switchback train --draw COUNT --out TABLE.csv` writes it:
//!
//! `cargo run -p switchback-lab --release --example learners -- TABLE.csv`: trees, network, ranker and their mean on the same folds, which share
//! neither base nor law, at a quarter, a half and all of the rows.

#![allow(clippy::disallowed_methods, reason = "an example reads its arguments")]

use miette::miette;
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use switchback_io::input::own;
use switchback_io::output::{note, print};
use switchback_lab::learning::{Compared, LearningSettings, Table, compare};

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
    let [file] = &words[..] else { return Err(miette!("give one table: TABLE.csv")) };
    let bytes = own(Path::new(file)).map_err(|error| miette!("{file}: cannot be read: {error}"))?;
    let text = String::from_utf8(bytes).map_err(|_| miette!("{file}: is no text; give a CSV file"))?;
    let table = Table::from_csv(&text).map_err(|error| miette!("{file}: {error}"))?;
    let mut out = String::from(
        "| learner | share | rows | log score | Brier | calibration error (perfect) | first | first five |\n|---|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for Compared { name, share, scores: s } in compare(&table, &LearningSettings::default()) {
        let _ = writeln!(
            out,
            "| {name} | {share} | {} | {:.3} | {:.3} | {:.3} ({:.3}) | {:.1} % | {:.1} % |",
            s.rows,
            s.log,
            s.brier,
            s.calibration,
            s.perfect,
            100.0 * s.top1,
            100.0 * s.top5
        );
    }
    print(&out)
}
