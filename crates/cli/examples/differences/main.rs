//! Compares simulators with machines that differ in one known quantity, and counts how often the right one is found.
//!
//! `cargo run --example differences -- --pairs 200`: pairs of twenty kinds in turn – twelve parameters, three effects that either of them lacks,
//! and two kinds where nothing differs. `--first N` is the first seed (1), `--words` prints each diagnosis. Prints one line a pair where something is
//! wrong, and a table.

mod pair;

use pair::{Kind, Pair};
use rayon::prelude::*;
use switchback_diagnose::Settings;
use switchback_io::diagnosis::{self, Report, ReportedDifference, Subject, Units};

/// What is counted of a kind.
#[derive(Debug, Clone, Copy, Default)]
struct Counted {
    pairs: usize,
    /// The right row comes first; of pairs without a difference: none is shown.
    right: usize,
    /// The true value lies in its 95 % interval, of those right.
    covered: usize,
    valued: usize,
    /// Rows of what is the same, and those of them that are shown as the same.
    same: usize,
    shown_same: usize,
}

impl Counted {
    fn add(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.right += other.right;
        self.covered += other.covered;
        self.valued += other.valued;
        self.same += other.same;
        self.shown_same += other.shown_same;
    }

    fn line(&self, name: &str) -> String {
        format!(
            "{name:<16} {:>5} {:>6} {:>8}/{:<4} {:>8}/{:<5}",
            self.pairs, self.right, self.covered, self.valued, self.shown_same, self.same
        )
    }
}

fn main() -> miette::Result<()> {
    let wishes: Vec<String> = std::env::args().collect();
    let of = |name: &str, otherwise: u64| -> u64 {
        let at = wishes.iter().position(|w| w == name);
        at.and_then(|k| wishes.get(k + 1)).and_then(|w| w.parse().ok()).unwrap_or(otherwise)
    };
    let (first, pairs) = (of("--first", 1), of("--pairs", 20));
    let in_full = wishes.iter().any(|w| w == "--words");
    let seeds: Vec<u64> = (first..first + pairs).collect();
    let one = |&seed: &u64| -> miette::Result<_> {
        let pair = Pair::draw(Kind::of(seed), seed);
        let report = diagnosis::examine(Subject::choose(pair.rig(), None)?, &Settings::default())?;
        Ok((compared(&pair, &report, seed), report))
    };
    let mut counted = [Counted::default(); Kind::ALL.len()];
    for (seed, done) in seeds.iter().zip(seeds.par_iter().map(one).collect::<Vec<_>>()) {
        let ((one, wrong), report) = done?;
        if in_full {
            println!("{}", switchback_report::diagnosis::words(&report, None));
        }
        if let Some(wrong) = wrong {
            println!("{wrong}");
        }
        counted[Kind::place(*seed)].add(one);
    }
    println!("{:<16} {:>5} {:>6} {:>13} {:>14}", "differs", "pairs", "right", "in interval", "same");
    let mut all = Counted::default();
    for (kind, counted) in Kind::ALL.iter().zip(counted).filter(|(_, c)| c.pairs > 0) {
        println!("{}", counted.line(&format!("{kind:?}")));
        all.add(counted);
    }
    println!("{}", all.line("all"));
    Ok(())
}

/// What is counted of one pair, and what is wrong with it.
fn compared(pair: &Pair, report: &Report, seed: u64) -> (Counted, Option<String>) {
    let units = Units::of(&report.rig);
    let rows: Vec<ReportedDifference> = (report.diagnosis.differences.iter())
        .flat_map(|found| found.rows.iter().map(|row| ReportedDifference::of(row, &units)))
        .collect();
    let is_the_one = |row: &&ReportedDifference| pair.kind.row() == Some(unnumbered(&row.what));
    let first = rows.iter().find(|row| row.differs);
    let right = match (first, pair.kind.row()) {
        (None, None) => !rows.is_empty(),
        (Some(row), Some(_)) => is_the_one(&row),
        _ => false,
    };
    let others = rows.iter().filter(|row| !is_the_one(row));
    let mut counted = Counted { pairs: 1, right: usize::from(right), ..Counted::default() };
    counted.same = others.clone().count();
    counted.shown_same = others.filter(|row| !row.differs).count();
    let mut error = None;
    if let (true, Some(row), Some([simulator, machine])) = (right, first, pair.truth()) {
        let deviation = match row.what.as_str() {
            // Only the distance of two zeros or delays means anything.
            "offset" | "delay" => (row.in_b - row.in_a) - (machine - simulator),
            _ => row.in_b - machine,
        };
        counted.valued = 1;
        error = Some(deviation / row.se);
        counted.covered = usize::from(deviation.abs() <= 1.96 * row.se);
    }
    let is_wrong = !right || counted.covered < counted.valued || counted.shown_same < counted.same;
    let wrong = is_wrong.then(|| {
        let shown = rows.iter().filter(|row| row.differs);
        let shown: Vec<String> =
            shown.map(|r| format!("{} {:.4e} → {:.4e} ± {:.1e}", r.what, r.in_a, r.in_b, r.se)).collect();
        format!("{seed} {:?} {:?} off by {error:?}: {}", pair.kind, pair.truth(), shown.join(", "))
    });
    (counted, wrong)
}

/// The name of a row without the number of its pole.
fn unnumbered(what: &str) -> &str {
    what.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_')
}
