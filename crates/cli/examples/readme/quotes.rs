//! What pages may quote: sections of several lines, and values within a sentence.

#[path = "../../../identify/examples/corrections.rs"]
#[allow(unreachable_pub, reason = "an example of its own")]
mod corrections;

use miette::{IntoDiagnostic, WrapErr, miette};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use switchback_io::rig::Request;
use switchback_report::study as report;
use switchback_study::results;
use switchback_study::results::Results;

pub(crate) type Quotes = BTreeMap<String, String>;

/// Every section with its text.
pub(crate) fn sections() -> miette::Result<Quotes> {
    let leafspring = study("leafspring")?;
    let blind = text("reports/blind-sample/summary.txt")?;
    let [measures, rules] = blind.splitn(2, "\n\n").collect::<Vec<_>>()[..] else {
        return Err(miette!("reports/blind-sample/summary.txt holds no two tables"));
    };
    let quotes = [
        ("inferred", inferred("scenarios/data/bench.csv")?),
        ("bench", verdict("reports/bench/verdict.txt")?),
        ("corrections", corrections::table().map_err(|error| miette!("{error}"))?),
        ("leafspring-short", block(&rows(&leafspring, &["sd slope", " descending "])?)),
        ("leafspring", block(&leafspring)),
        ("assumptions-broken", block(&study("assumptions-broken")?)),
        ("estimators", block(&rows(&study("estimators")?, &["sd slope", " a    ", " descending "])?)),
        ("measured-rigs", fits(Path::new("reports/measured-rigs/fits.csv"))?),
        ("gap", verdict("reports/gap-leaf-spring-with-backlash/verdict.txt")?),
        ("gap-piezo-stage", verdict("reports/measured-rigs/gap-piezo-stage.txt")?),
        ("gap-mr-damper", verdict("reports/measured-rigs/gap-mr-damper.txt")?),
        ("blind-short", block(&rows(measures, &BLIND_SHORT)?)),
        ("blind", block(&format!("{measures}\n\n{}", rules.trim_end()))),
        ("differences", differences("pairs")?),
        ("joints", differences("joints")?),
        ("field", field(&text("reports/field-slice/summary.md")?)),
        ("repeatability", block(text("reports/repeatability/summary.txt")?.trim_end())),
        ("bouc-wen", benchmark("bouc-wen")?),
        ("cascaded-tanks", benchmark("cascaded-tanks")?),
        ("speed-short", ratios()?),
        ("speed", without_title(&text("reports/speed/table.md")?).to_owned()),
    ];
    Ok(quotes.map(|(name, text)| (name.to_owned(), text)).into())
}

/// The table of simulators beside machines, without the list of single ones.
fn differences(name: &str) -> miette::Result<String> {
    let all = text(&format!("reports/differences/{name}.txt"))?;
    Ok(block(all.find("differs ").map_or("", |at| &all[at..])))
}

/// The measures of a field examination, which come first in its summary.
fn field(summary: &str) -> String {
    let measures = summary.split("```text\n").nth(1).and_then(|rest| rest.split("```").next());
    block(measures.unwrap_or_default().trim_end())
}

/// The table of a public benchmark, without the diagnosis below it.
fn benchmark(name: &str) -> miette::Result<String> {
    let all = text(&format!("reports/benchmarks/{name}.txt"))?;
    Ok(block(all.split("\n\ndiagnosis").next().unwrap_or_default()))
}

/// The rows of the blind examination that the README shows.
const BLIND_SHORT: [&str; 7] = [
    "must reach",
    "exact effect named",
    "under law mismatch",
    "a cause named where there is none",
    "of the causes named",
    "effect outside the library",
    "coverage of the 90 % closure interval",
];

/// Every value with its text.
pub(crate) fn values() -> miette::Result<Quotes> {
    let leafspring = read_study("leafspring")?;
    if !leafspring.as_expected() {
        return Err(miette!(
            "reports/leafspring is not what its scenario expects, and the README says it is"
        ));
    }
    let paper = |s: &&results::Summary| s.series.method.to_string().starts_with("paper-");
    let over_bound = leafspring.summaries.iter().filter(paper).filter_map(|s| s.variance_over_bound);
    let worst = over_bound.map(|ratio| ratio.value()).fold(0.0, f64::max);
    let blind = json("reports/blind-sample/results.json")?;
    let rigs: u64 = blind["rigs"].as_object().into_iter().flatten().filter_map(|(_, n)| n.as_u64()).sum();
    let measure = |key: &str| {
        let found = blind["measures"].as_array().into_iter().flatten().find(|m| m["key"] == key);
        found.and_then(|m| m["reached"].as_f64()).ok_or_else(|| miette!("blind-sample measures no `{key}`"))
    };
    let speed = json("reports/speed/results.json")?;
    let seconds = speed["tools"][0]["switchback_seconds_a_replicate"].as_f64().unwrap_or(f64::NAN);
    let values = [
        ("leafspring.cells", leafspring.cells.len().to_string()),
        ("leafspring.paper_over_bound", format!("{worst:.1}")),
        ("blind.rigs", rigs.to_string()),
        ("blind.outside_named", format!("{:.0} %", 100.0 * measure("outside_named")?)),
        ("blind.pairs_exact", format!("{:.0} %", 100.0 * measure("pairs_exact")?)),
        ("speed.replicate", format!("{:.2} ms", 1e3 * seconds)),
    ];
    Ok(values.map(|(name, text)| (name.to_owned(), text)).into())
}

/// What the program says that it took from a file of measurements.
fn inferred(file: &str) -> miette::Result<String> {
    let loaded = Request { data: vec![file.into()], ..Request::default() }.load("gap")?;
    Ok(block(&loaded.reported.to_string()))
}

fn read_study(name: &str) -> miette::Result<Results> {
    Ok(results::read(&Path::new("reports").join(name))?)
}

/// The rows of a study's table, without the lines on expectations.
fn study(name: &str) -> miette::Result<String> {
    let table = report::table(&read_study(name)?);
    let is_row = |line: &&str| !line.starts_with("as expected:") && !line.starts_with("NOT expected:");
    Ok(table.lines().filter(is_row).collect::<Vec<_>>().join("\n"))
}

/// The rows of a table that hold one of these words; each must be in one.
fn rows(table: &str, wanted: &[&str]) -> miette::Result<String> {
    if let Some(missing) = wanted.iter().find(|words| !table.contains(**words)) {
        return Err(miette!("no row of the table says `{}`", missing.trim()));
    }
    let rows: Vec<&str> =
        table.lines().filter(|row| wanted.iter().any(|words| row.contains(words))).collect();
    Ok(rows.join("\n"))
}

/// What a diagnosis says, down to its first table.
fn verdict(path: &str) -> miette::Result<String> {
    Ok(block(text(path)?.split("\ncandidate ").next().unwrap_or_default()))
}

fn block(text: &str) -> String {
    format!("```text\n{}\n```\n", text.trim_end())
}

fn text(path: &str) -> miette::Result<String> {
    std::fs::read_to_string(path).into_diagnostic().wrap_err_with(|| format!("cannot read {path}"))
}

fn json(path: &str) -> miette::Result<Value> {
    serde_json::from_str(&text(path)?).into_diagnostic().wrap_err_with(|| format!("cannot read {path}"))
}

/// A page of Markdown below its title.
fn without_title(page: &str) -> &str {
    page.split_once("\n\n").map_or(page, |(_, rest)| rest)
}

/// How many times longer other tools take than Switchback: a row a tool.
fn ratios() -> miette::Result<String> {
    let speed = json("reports/speed/results.json")?;
    let mut text = "| tool | times as long |\n|---|--:|\n".to_owned();
    for tool in speed["tools"].as_array().into_iter().flatten() {
        let (Some(name), Some(ratio)) = (tool["name"].as_str(), tool["ratio"].as_f64()) else {
            return Err(miette!("a tool of reports/speed/results.json has no name or ratio"));
        };
        let _ = writeln!(text, "| {name} | {} |", thousands(ratio.round() as u64));
    }
    Ok(text)
}

/// `12345` as `12,345`.
fn thousands(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", thousands(number / 1000), number % 1000),
    }
}

/// Fit percentages as a table: a row a rig, a column a method.
fn fits(path: &Path) -> miette::Result<String> {
    let mut reader = csv::Reader::from_path(path).into_diagnostic()?;
    let mut rigs: Vec<(String, Vec<(String, String)>)> = Vec::new();
    for row in reader.records() {
        let row = row.into_diagnostic()?;
        let fit = (row[2].to_owned(), format!("{} % (n = {})", &row[6], &row[3]));
        match rigs.iter_mut().find(|(rig, _)| *rig == row[0]) {
            Some((_, fits)) => fits.push(fit),
            None => rigs.push((row[0].to_owned(), vec![fit])),
        }
    }
    let mut text = String::new();
    let methods: Vec<&str> =
        rigs.first().map(|(_, fits)| fits.iter().map(|f| f.0.as_str()).collect()).unwrap_or_default();
    let _ = writeln!(text, "| rig | {} |", methods.join(" | "));
    let _ = writeln!(text, "|---|{}", "---|".repeat(methods.len()));
    for (rig, fits) in &rigs {
        let cells: Vec<&str> = fits.iter().map(|f| f.1.as_str()).collect();
        let _ = writeln!(text, "| {rig} | {} |", cells.join(" | "));
    }
    Ok(text)
}
