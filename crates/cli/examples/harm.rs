//! What a diagnosis does to held-out records: the verdict on every rig of some folders, and of each held-out record the free run's fit
//! before and after, and the mean square error it saves with a 95 % interval.
//!
//! `cargo run --example harm -- ../shared/rigs ../shared/rigs/field`. The interval is made here, of the simulated series alone, by whole
//! blocks of time drawn anew: an oracle of what the diagnosis itself refuses by.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::path::{Path, PathBuf};
use std::time::Instant;
use switchback_diagnose::{Effect, HoldoutSeries, Settings};
use switchback_io::diagnosis::{self, Report, Subject};

/// Blocks that a record is cut into: each is long against the memory of its errors, unless these last through the record.
const BLOCKS: usize = 15;
/// Records drawn anew.
const DRAWS: usize = 2000;

fn main() -> miette::Result<()> {
    let mut folders: Vec<String> = std::env::args().skip(1).collect();
    if folders.is_empty() {
        folders = ["../shared/rigs", "../shared/rigs/field"].map(str::to_owned).to_vec();
    }
    let mut harmed = 0;
    for path in folders.iter().flat_map(|folder| rigs(Path::new(folder))) {
        let began = Instant::now();
        let name = path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy().into_owned();
        let rig = match switchback_io::rig::read(&path) {
            Ok(rig) => rig,
            Err(error) => {
                println!("{name}: {error}");
                continue;
            }
        };
        match diagnosis::examine(Subject::choose(rig, None)?, &Settings::default()) {
            Ok(report) => harmed += reported(&name, &report, began.elapsed().as_secs_f64()),
            Err(error) => println!("{name}: {error}"),
        }
    }
    println!("held-out records harmed beyond their error by a cause that was reported: {harmed}");
    Ok(())
}

/// The manifests in the folders of a folder, by name.
fn rigs(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> =
        entries.map(|e| e.path().join("rig.toml")).filter(|p| p.is_file()).collect();
    found.sort();
    found
}

/// Prints one diagnosis; how many held-out records a cause that it shows harms.
fn reported(name: &str, report: &Report, seconds: f64) -> usize {
    let verdict = &report.diagnosis.verdict;
    let names = |effects: &[Effect]| effects.iter().map(|e| e.name()).collect::<Vec<_>>().join("+");
    println!(
        "{name}: {} [{}{}] {:.2}, {:+.4} nats, {seconds:.0} s",
        verdict.status.name(),
        names(&verdict.effects),
        names(&verdict.class),
        verdict.probability,
        report.diagnosis.gap.predictive_gain
    );
    let shows = !(verdict.effects.is_empty() && verdict.class.is_empty());
    let mut harmed = 0;
    for (series, record) in report.diagnosis.series.iter().zip(&report.diagnosis.gap.per_record) {
        let [low, mean, high] = saved(series);
        let is_harmed = shows && high < 0.0;
        harmed += usize::from(is_harmed);
        println!(
            "    {:<24} fit {:6.1} → {:6.1} %, saves {mean:+.2e} [{low:+.2e}, {high:+.2e}] of the variance{}",
            record.record,
            record.fit_before,
            record.fit_after,
            if is_harmed { "  HARMED" } else { "" }
        );
    }
    harmed
}

/// Mean square error saved over the variance of the output, between the ends of its 95 % interval.
fn saved(series: &HoldoutSeries) -> [f64; 3] {
    let n = series.measured.len();
    let mean = series.measured.iter().sum::<f64>() / n as f64;
    let variance = series.measured.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / n as f64;
    let error = |k: usize| {
        let square = |run: &[f64]| (series.measured[k] - run[k]).powi(2) / variance;
        square(&series.nominal) - square(&series.augmented)
    };
    let blocks: Vec<f64> =
        (0..BLOCKS).map(|b| (b * n / BLOCKS..(b + 1) * n / BLOCKS).map(error).sum::<f64>()).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut drawn: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let sum: f64 = (0..BLOCKS).map(|_| blocks[rng.next_u64() as usize % BLOCKS]).sum();
            sum / n as f64
        })
        .collect();
    drawn.sort_by(f64::total_cmp);
    [drawn[DRAWS / 40], blocks.iter().sum::<f64>() / n as f64, drawn[DRAWS - 1 - DRAWS / 40]]
}
