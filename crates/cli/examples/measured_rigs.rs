//! Identifies measured rigs by `free` and by both baselines, writes how well each simulates the held-out record, and
//! diagnoses the gap.
//!
//! `cargo run --example measured_rigs -- ../shared/rigs`: the folder holds `mr-damper`, `pneumatic-seal` and `piezo-stage` (their public
//! sources are in the README). Writes `reports/measured-rigs`: `fits.csv`, and of each rig the verdict with the figures that hold no
//! sample of its records.

use std::path::Path;
use switchback_diagnose::Settings;
use switchback_io::diagnosis::{self, Subject};
use switchback_io::identification::{Method, identify};
use switchback_io::output::{Artefacts, OutputFolder};
use switchback_model::rig::Usage;
use switchback_report::plots;

const RIGS: [&str; 3] = ["mr-damper", "pneumatic-seal", "piezo-stage"];
const METHODS: [Method; 3] = [Method::Free, Method::Memoryless, Method::LinearArx];

/// Figures made of shares and probabilities, not of samples.
const FIGURES: [&str; 2] = ["where.svg", "candidates.svg"];

fn main() -> miette::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "../shared/rigs".to_owned());
    let mut artefacts = Artefacts::default();
    let mut table = String::from("rig,record,method,order,delay,border_points,fit_percent\n");
    for name in RIGS {
        let path = Path::new(&folder).join(name).join("rig.toml");
        if !path.is_file() {
            println!("skipped {name}: there is no {}", path.display());
            continue;
        }
        let rig = switchback_io::rig::read(&path)?;
        for method in METHODS {
            let found = identify(&rig, method)?;
            let estimate = &found.estimate;
            let points = estimate.descending.len() + estimate.ascending.len();
            for (record, run) in rig.records.iter().zip(&found.runs) {
                if let (Usage::Holdout, Some(run)) = (record.usage, run) {
                    let (order, delay, fit) = (estimate.a.len(), estimate.delay, run.fit_percent);
                    println!("{name} {method}: {fit:.1} %");
                    table.push_str(&format!(
                        "{name},{},{method},{order},{delay},{points},{fit:.1}\n",
                        record.name
                    ));
                }
            }
        }
        let report = diagnosis::examine(Subject::choose(rig, None)?, &Settings::default())
            .map_err(|e| e.in_file(&path))?;
        let words = switchback_report::diagnosis::words(&report, None);
        println!("{words}");
        artefacts.add(format!("gap-{name}.txt"), words);
        for figure in plots::gap::figures(&report).into_iter().filter(|f| FIGURES.contains(&f.name.as_str()))
        {
            artefacts.add(format!("gap-{name}-{}", figure.name), figure.svg);
        }
    }
    artefacts.add("fits.csv", table);
    OutputFolder::claim(Path::new("reports/measured-rigs"), false)?.commit(&artefacts)?;
    Ok(())
}
