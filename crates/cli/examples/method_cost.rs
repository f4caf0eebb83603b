//! What a method costs in the superposed engine beside `joint`, as ratios of processor time from runs that alternate on one thread.
//!
//! ```text
//! cargo run --release -p switchback --example method_cost [-- REPLICATES [METHOD]]
//! ```
//!
//! prints a table: `leafspring` is the grid of `scenarios/leafspring.toml` with that method only, noise included; `one period` the same with records of a
//! few periods, where nearly all that is left is the algebra of a cell. A ratio is the median over the rounds.

use std::error::Error;
use std::fs;
use switchback_study::consistency::{self, Progress};
use switchback_study::scenario::Scenario;

const SCENARIO: &str = include_str!("../../../scenarios/leafspring.toml");
/// Rounds; each runs both methods once.
const ROUNDS: usize = 5;
/// The records whose noise hardly counts, samples.
const SHORT: [i64; 5] = [200, 210, 220, 230, 240];

struct Silent;

impl Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut given = std::env::args().skip(1);
    let replicates: usize = given.next().map_or(Ok(4000), |x| x.parse())?;
    let method = given.next().unwrap_or_else(|| "instrumental".to_owned());
    println!("| records | joint, processor s | {method} | ratio |\n|---|---|---|---|");
    for (name, replicates, samples) in
        [("leafspring", replicates, None), ("one period", 4 * replicates, Some(SHORT))]
    {
        let [base, other] = ["joint", &method]
            .map(|method| scenario(method, replicates, samples.as_ref().map(<[i64; 5]>::as_slice)));
        let (base, other) = (base?, other?);
        let mut rounds = Vec::with_capacity(ROUNDS);
        for _ in 0..ROUNDS {
            rounds.push([seconds(&base)?, seconds(&other)?]);
        }
        let median = |figure: &dyn Fn(&[f64; 2]) -> f64| {
            let mut values: Vec<f64> = rounds.iter().map(figure).collect();
            values.sort_by(f64::total_cmp);
            values[ROUNDS / 2]
        };
        let (joint, alone, ratio) = (median(&|r| r[0]), median(&|r| r[1]), median(&|r| r[1] / r[0]));
        println!("| {name} | {joint:.2} | {alone:.2} | {ratio:.2} |");
    }
    Ok(())
}

/// The committed grid with this method only, promising nothing.
fn scenario(method: &str, replicates: usize, samples: Option<&[i64]>) -> Result<Scenario, Box<dyn Error>> {
    let mut table: toml::Table = SCENARIO.parse()?;
    table.remove("expect");
    table.insert("replicates".to_owned(), i64::try_from(replicates)?.into());
    table["sweep"]["methods"] = vec![method.to_owned()].into();
    if let Some(samples) = samples {
        table["sweep"]["samples"] = samples.to_vec().into();
    }
    Ok(Scenario::parse("leafspring.toml", &table.to_string())?)
}

/// Processor seconds of a study on one thread.
fn seconds(scenario: &Scenario) -> Result<f64, Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let before = processor_seconds();
    pool.install(|| consistency::run(scenario, String::new(), &Silent))?;
    Ok(processor_seconds() - before)
}

/// Processor time of this process so far, all threads; zero where the system does not show.
fn processor_seconds() -> f64 {
    /// Ticks a second of the times in `/proc`.
    const TICKS: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(2).filter_map(|t| t.parse::<f64>().ok()).sum::<f64>() / TICKS
}
