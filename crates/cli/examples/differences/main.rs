//! Compares simulators with machines that differ in known quantities, and counts how often the right ones are found.
//!
//! `cargo run --example differences -- --pairs 200`: pairs of twenty kinds in turn – twelve parameters, three effects that either of them lacks,
//! and two kinds where nothing differs. `--joints 100`: joints with the attributes of MuJoCo's, friction, damping, armature and delay off in turn and all
//! together. `--same 100`: pairs in which nothing differs, with effects and without. `--bad-samples 60`: pairs with one sample of the machine's far off. `--first N` is the first seed (1), `--words` prints each diagnosis. Prints one line a pair where something is wrong, and a table.

mod bad_samples;
mod counting;
mod drive;
mod joint;
mod pair;

use counting::{Counted, compared};
use joint::{Joint, Off};
use pair::{Kind, Pair};
use rayon::prelude::*;
use switchback_diagnose::Settings;
use switchback_io::diagnosis::{self, Report, Subject};
use switchback_model::rig::Rig;

/// Rigs after which results are printed.
const AT_ONCE: usize = 20;

/// A simulator beside a machine, and the rows that must come first, each with its values in both.
struct Made {
    kind: String,
    rig: Rig,
    expected: Vec<(&'static str, [f64; 2])>,
    /// Whether these rows must name the attributes of a joint.
    is_joint: bool,
}

impl Made {
    fn pair(seed: u64) -> Self {
        let pair = Pair::draw(Kind::of(seed), seed);
        let expected = pair.kind.row().zip(pair.truth()).into_iter().collect();
        Self { kind: format!("{:?}", pair.kind), rig: pair.rig(), expected, is_joint: false }
    }

    fn same(seed: u64) -> Self {
        let pair = Pair::draw([Kind::Same, Kind::SameEffects][(seed % 2) as usize], seed);
        Self { kind: format!("{:?}", pair.kind), rig: pair.rig(), expected: Vec::new(), is_joint: false }
    }

    fn joint(seed: u64) -> Self {
        let off = Off::ALL[(seed % Off::ALL.len() as u64) as usize];
        let joint = Joint::draw(off, seed);
        Self { kind: format!("{off:?}"), rig: joint.rig(), expected: joint.expected(), is_joint: true }
    }
}

fn main() -> miette::Result<()> {
    let wishes: Vec<String> = std::env::args().collect();
    let of = |name: &str| -> Option<u64> {
        let at = wishes.iter().position(|w| w == name)?;
        wishes.get(at + 1)?.parse().ok()
    };
    let first = of("--first").unwrap_or(1);
    if let Some(count) = of("--bad-samples") {
        return bad_samples::run(first, count);
    }
    let (make, count): (fn(u64) -> Made, u64) = match (of("--joints"), of("--same")) {
        (Some(count), _) => (Made::joint, count),
        (None, Some(count)) => (Made::same, count),
        (None, None) => (Made::pair, of("--pairs").unwrap_or(20)),
    };
    let in_full = wishes.iter().any(|w| w == "--words");
    let seeds: Vec<u64> = (first..first + count).collect();
    let one = |&seed: &u64| -> miette::Result<_> {
        let made = make(seed);
        let report = examined(made.rig.clone())?;
        Ok((compared(&made, &report, seed), made.kind, report))
    };
    let mut table: Vec<(String, Counted)> = Vec::new();
    let done = seeds.chunks(AT_ONCE).flat_map(|some| some.par_iter().map(one).collect::<Vec<_>>());
    for done in done {
        let ((counted, wrong), kind, report) = done?;
        if in_full {
            println!("{}", switchback_report::diagnosis::words(&report, None));
        }
        if let Some(wrong) = wrong {
            println!("{wrong}");
        }
        match table.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, sum)) => sum.add(counted),
            None => table.push((kind, counted)),
        }
    }
    println!(
        "{:<16} {:>5} {:>6} {:>8} {:>13} {:>14}",
        "differs", "pairs", "right", "verdict", "in interval", "same"
    );
    let mut all = Counted::default();
    for (kind, counted) in table {
        println!("{}", counted.line(&kind));
        all.add(counted);
    }
    println!("{}", all.line("all"));
    Ok(())
}

fn examined(rig: Rig) -> miette::Result<Report> {
    Ok(diagnosis::examine(Subject::choose(rig, None)?, &Settings::default())?)
}
