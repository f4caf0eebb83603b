//! Diagnoses simulated machines of known truth, recorded as a bench engineer would record them: one record, no order, no interval.
//!
//! `cargo run --example machine -- --seeds 20 --play 1`: leaf springs that drive a second-order resonance, with a play of 1 mm (full
//! width) before them. `--first N` is the first seed (1000), `--between` lets the drive go on between the samples, `--words` prints each
//! diagnosis. Prints one line a machine and what was reported how often.
//!
//! `--csv` prints the first machine's record instead, as its recorder would save it: `scenarios/data/bench.csv` is
//! `cargo run --example machine -- --first 1004 --play 1 --csv`.

mod simulated;

use simulated::Machine;
use std::fs;
use std::time::Instant;
use switchback_diagnose::{Effect, Settings, Status};
use switchback_io::diagnosis::{self, Report, Subject};

fn main() -> miette::Result<()> {
    let wishes: Vec<String> = std::env::args().collect();
    let of = |name: &str, otherwise: f64| -> f64 {
        let at = wishes.iter().position(|w| w == name);
        at.and_then(|k| wishes.get(k + 1)).and_then(|w| w.parse().ok()).unwrap_or(otherwise)
    };
    let (first, seeds, play) = (of("--first", 1000.0) as u64, of("--seeds", 20.0) as u64, of("--play", 1.0));
    let wishes_for = |name: &str| wishes.iter().any(|w| w == name);
    let (in_full, holds) = (wishes_for("--words"), !wishes_for("--between"));
    if wishes_for("--csv") {
        print!("{}", Machine::draw(first, play, holds).csv(first));
        return Ok(());
    }
    let mut counted = Counted::default();
    for seed in first..first + seeds {
        let machine = Machine::draw(seed, play, holds);
        let (began, used) = (Instant::now(), processor_seconds());
        let report = diagnosis::examine(Subject::choose(machine.rig(seed), None)?, &Settings::default())?;
        let reported = reported(&report, play);
        counted.add(reported);
        println!(
            "{seed} {machine}: {:<9} {} | {:.1} s, {:.1} processor s",
            reported.name(),
            line(&report),
            began.elapsed().as_secs_f64(),
            processor_seconds() - used
        );
        if in_full {
            println!("{}", switchback_report::diagnosis::words(&report, None));
        }
    }
    println!(
        "play {play} mm, {seeds} machines from seed {first}: {counted:?}, {:.0} processor s",
        processor_seconds()
    );
    Ok(())
}

/// What a verdict is worth.
#[derive(Debug, Clone, Copy)]
enum Reported {
    /// What was put in: play or its twin, or nothing but noise.
    Right,
    /// Neither this nor a cause that was not put in.
    Undecided,
    /// A cause that was not put in.
    Wrong,
}

impl Reported {
    fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Undecided => "undecided",
            Self::Wrong => "WRONG",
        }
    }
}

/// How often.
#[derive(Debug, Default)]
#[allow(dead_code, reason = "printed by its derived form")]
struct Counted {
    right: usize,
    undecided: usize,
    wrong: usize,
}

impl Counted {
    fn add(&mut self, reported: Reported) {
        match reported {
            Reported::Right => self.right += 1,
            Reported::Undecided => self.undecided += 1,
            Reported::Wrong => self.wrong += 1,
        }
    }
}

fn reported(report: &Report, play: f64) -> Reported {
    let verdict = &report.diagnosis.verdict;
    let operator = [Effect::Backlash, Effect::GradualTransition];
    let noise = [Effect::OutputNoise, Effect::ColouredNoise];
    let put_in = |e: &Effect| noise.contains(e) || play > 0.0 && operator.contains(e);
    let reported = || verdict.effects.iter().chain(&verdict.class);
    match verdict.status {
        Status::None if play == 0.0 => Reported::Right,
        Status::Named | Status::Class | Status::Ambiguous if !reported().all(put_in) => {
            match verdict.status {
                // Rivals that hold the cause name no wrong one.
                Status::Ambiguous => Reported::Undecided,
                _ => Reported::Wrong,
            }
        }
        Status::Named | Status::Class if play == 0.0 || reported().any(|e| operator.contains(e)) => {
            Reported::Right
        }
        _ => Reported::Undecided,
    }
}

/// The verdict and the fit of the held-out record in one line.
fn line(report: &Report) -> String {
    let verdict = &report.diagnosis.verdict;
    let names = |effects: &[Effect]| effects.iter().map(|e| e.name()).collect::<Vec<_>>().join("+");
    let corrected = verdict.corrected_by.map_or_else(String::new, |e| format!(" (corrected by {e})"));
    let fits =
        report.diagnosis.gap.per_record.iter().map(|r| format!("{:.1}→{:.1} %", r.fit_before, r.fit_after));
    let structure = report.diagnosis.limitations.iter().find(|l| l.contains("declares no order"));
    let structure = structure.and_then(|l| l.split("order: ").nth(1)).and_then(|l| l.split(" was").next());
    format!(
        "{} [{}{}]{corrected} {:.2}, fit {}, {}",
        verdict.status.name(),
        names(&verdict.effects),
        names(&verdict.class),
        verdict.probability,
        fits.collect::<Vec<_>>().join(" "),
        structure.unwrap_or_default()
    )
}

/// Processor time of this process so far, all threads; zero where the system does not show.
fn processor_seconds() -> f64 {
    /// Ticks a second of the times in `/proc`.
    const TICKS: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(2).filter_map(|t| t.parse::<f64>().ok()).sum::<f64>() / TICKS
}
