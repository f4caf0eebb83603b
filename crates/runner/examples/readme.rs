//! Copies the figures that the README quotes out of `reports/`, between its markers.
//!
//! `cargo run --example readme` rewrites the README; with `-- --check` it only says whether it is up to date (exit code 1 if not).
//!
//! ```text
//! <!-- begin leafspring -->
//! …
//! <!-- end leafspring -->
//! ```

use clap::Parser;
use miette::{IntoDiagnostic, WrapErr, miette};
use std::fmt::Write;
use std::path::Path;
use switchback::cmd::data_args::DataArgs;
use switchback::options::Quiet;
use switchback::{report, results};

const README: &str = "README.md";

fn main() -> miette::Result<()> {
    let old =
        std::fs::read_to_string(README).into_diagnostic().wrap_err("run this in the workspace's root")?;
    let mut new = old.clone();
    for (name, section) in sections()? {
        new = spliced(&new, name, &section)?;
    }
    if std::env::args().any(|a| a == "--check") {
        if new != old {
            return Err(miette!("README.md differs from reports/; run `cargo run --example readme`"));
        }
    } else if new != old {
        std::fs::write(README, new).into_diagnostic()?;
    }
    Ok(())
}

/// Every section with its text.
fn sections() -> miette::Result<Vec<(&'static str, String)>> {
    Ok(vec![
        ("inferred", inferred("scenarios/data/bench.csv")?),
        ("bench", verdict(Path::new("reports/bench/verdict.txt"))?),
        ("leafspring", study("leafspring")?),
        ("assumptions-broken", study("assumptions-broken")?),
        ("measured-rigs", fits(Path::new("reports/measured-rigs/fits.csv"))?),
        ("gap", verdict(Path::new("reports/gap-leaf-spring-with-backlash/verdict.txt"))?),
        ("gap-piezo-stage", verdict(Path::new("reports/measured-rigs/gap-piezo-stage.txt"))?),
        ("gap-mr-damper", verdict(Path::new("reports/measured-rigs/gap-mr-damper.txt"))?),
        ("blind", format!("```text\n{}```\n", text(Path::new("reports/blind-sample/summary.txt"))?)),
        ("speed", text(Path::new("reports/speed/table.md"))?),
    ])
}

/// What the program says that it took from a file of measurements.
fn inferred(file: &str) -> miette::Result<String> {
    /// The command line of a verb that reads measurements.
    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        data: DataArgs,
    }
    let loaded = Line::parse_from(["switchback", file]).data.load("gap", Quiet { quiet: true })?;
    Ok(format!("```text\n{}```\n", loaded.told))
}

/// The rows of a study's table, without the lines on expectations.
fn study(name: &str) -> miette::Result<String> {
    let results = results::read(&Path::new("reports").join(name))?;
    let table = report::table(&results);
    let rows: Vec<&str> =
        table.lines().filter(|l| !l.starts_with("as expected:") && !l.starts_with("NOT expected:")).collect();
    Ok(format!("```text\n{}\n```\n", rows.join("\n")))
}

/// What a diagnosis says, down to its first table.
fn verdict(path: &Path) -> miette::Result<String> {
    let text = text(path)?;
    let words = text.split("explanation ").next().unwrap_or_default();
    Ok(format!("```text\n{}\n```\n", words.trim_end()))
}

fn text(path: &Path) -> miette::Result<String> {
    std::fs::read_to_string(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
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

fn spliced(text: &str, name: &str, section: &str) -> miette::Result<String> {
    let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
    let missing = || miette!("README.md has no section between {} and {end}", begin.trim_end());
    let from = text.find(&begin).ok_or_else(missing)? + begin.len();
    let to = from + text[from..].find(&end).ok_or_else(missing)?;
    Ok(format!("{}{section}{}", &text[..from], &text[to..]))
}
