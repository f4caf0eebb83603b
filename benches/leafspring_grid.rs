//! The grid of `scenarios/leafspring.toml` with one method on one thread, timed, for comparison with other tools.
//!
//! ```text
//! cargo run --release -p switchback-benches --bin leafspring_grid -- REPLICATES [--method NAME] [--records DIR] [--noise-times K] [--borders-times K]
//! ```
//!
//! prints one JSON object: `seconds` for all replicates of all cells, and `cells`, the estimates of replicate 0 (`a`, `b`, then the
//! border points; `b` in output units a span `u_M − u_m`, border points in spans). `--records` writes replicate 0 sample by
//! sample too, so that another tool can be given the same data: `DIR/index.json` and one file `*.f64` (little-endian doubles) a record,
//! `y(t)` from `t = −n` on; the cell with `N` samples uses the first `n + N` of them. `--noise-times` and `--borders-times` put K
//! slightly different ones in place of each noise level and border: to see what more of them cost.

use serde_json::{Value, json};
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use switchback_study::consistency::{self, Progress};
use switchback_study::scenario::Scenario;

const SCENARIO: &str = include_str!("../scenarios/leafspring.toml");

const USAGE: &str =
    "usage: leafspring_grid REPLICATES [--method NAME] [--records DIR] [--noise-times K] [--borders-times K]";

struct Silent;

impl Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}

struct Arguments {
    replicates: usize,
    method: String,
    records: Option<String>,
    noise_times: u32,
    borders_times: u32,
}

impl Arguments {
    fn read(mut given: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let replicates = given.next().ok_or(USAGE)?.parse()?;
        let mut arguments = Self {
            replicates,
            method: "paper-descendant".to_owned(),
            records: None,
            noise_times: 1,
            borders_times: 1,
        };
        while let Some(option) = given.next() {
            let value = given.next().ok_or(USAGE)?;
            match option.as_str() {
                "--method" => arguments.method = value,
                "--records" => arguments.records = Some(value),
                "--noise-times" => arguments.noise_times = value.parse()?,
                "--borders-times" => arguments.borders_times = value.parse()?,
                _ => return Err(USAGE.into()),
            }
        }
        Ok(arguments)
    }

    /// The committed scenario with these replicates and this method only, promising nothing.
    fn scenario(&self) -> Result<Scenario, Box<dyn Error>> {
        let mut table: toml::Table = SCENARIO.parse()?;
        table.remove("expect");
        table.insert("replicates".to_owned(), i64::try_from(self.replicates)?.into());
        table["sweep"]["methods"] = vec![self.method.clone()].into();
        let noise: Vec<f64> =
            table["sweep"]["noise"].as_array().into_iter().flatten().filter_map(|x| x.as_float()).collect();
        table["sweep"]["noise"] = several(&noise, self.noise_times, |x, k| x * (1.0 + 0.01 * k)).into();
        let borders: Vec<toml::Value> = table["border"].as_array().into_iter().flatten().cloned().collect();
        table["border"] = several(&borders, self.borders_times, border).into();
        Ok(Scenario::parse("leafspring.toml", &toml::to_string(&table)?)?)
    }
}

/// `times` of each, made different by their number from 0 on.
fn several<T>(all: &[T], times: u32, vary: impl Fn(&T, f64) -> T) -> Vec<T> {
    let vary = &vary;
    all.iter().flat_map(|x| (0..times).map(move |k| vary(x, f64::from(k)))).collect()
}

/// The border with its number in the name and a little more friction.
fn border(border: &toml::Value, k: f64) -> toml::Value {
    let mut border = border.clone();
    let name = border["name"].as_str().unwrap_or_default().to_owned();
    if k > 0.0 {
        border["name"] = format!("{name} {k}").into();
        border["friction"] = (border["friction"].as_float().unwrap_or_default() * (1.0 + 0.01 * k)).into();
    }
    border
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::read(std::env::args().skip(1))?;
    let scenario = arguments.scenario()?;
    let thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let start = Instant::now();
    let results = thread.install(|| consistency::run(&scenario, String::new(), &Silent))?;
    let seconds = start.elapsed().as_secs_f64();
    if let Some(folder) = &arguments.records {
        write_records(&scenario, Path::new(folder))?;
    }
    let output = json!({
        "method": arguments.method,
        "replicates": arguments.replicates,
        "threads": 1,
        "seconds": seconds,
        "seconds_per_replicate": seconds / arguments.replicates as f64,
        "cell_count": results.cells.len(),
        "cells": estimates(&scenario)?,
    });
    println!("{}", serde_json::to_string_pretty(&output)?);
    Ok(())
}

/// Replicate 0 in every cell.
fn estimates(scenario: &Scenario) -> Result<Vec<Value>, Box<dyn Error>> {
    let order = scenario.cases()[0].order;
    consistency::replay(scenario, 0)?
        .into_iter()
        .map(|cell| {
            let estimates = cell.estimates?;
            Ok(json!({
                "border": cell.series.border,
                "points": cell.series.points,
                "noise": cell.series.noise,
                "samples": cell.samples,
                "a": estimates[..order],
                "b": estimates[order..2 * order],
                "borders": estimates[2 * order..],
            }))
        })
        .collect()
}

/// Replicate 0 sample by sample.
fn write_records(scenario: &Scenario, folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut index = Vec::new();
    for (k, setting) in consistency::records(scenario, 0)?.iter().enumerate() {
        for experiment in &setting.experiments {
            let name = format!("{k:02}-{}", experiment.direction);
            let doubles = |x: &[f64]| x.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
            std::fs::write(folder.join(format!("{name}-y.f64")), doubles(&experiment.y))?;
            std::fs::write(folder.join(format!("{name}-v.f64")), doubles(&experiment.v))?;
            index.push(json!({
                "y": format!("{name}-y.f64"),
                "v": format!("{name}-v.f64"),
                "experiment": experiment.direction.to_string(),
                "border": setting.border,
                "points": setting.points,
                "noise": setting.noise,
                "span": setting.span,
                "lead": experiment.lead,
                "satellite": experiment.satellite,
                "levels": experiment.levels,
                "samples": scenario.sweep().samples,
                "step_means": experiment.step_means,
            }));
        }
    }
    std::fs::write(folder.join("index.json"), serde_json::to_string_pretty(&index)?)?;
    Ok(())
}
