//! The commented rig file that says what was inferred.

use super::plan::Plan;
use std::fmt::Write;
use std::path::{Component, Path, PathBuf};
use switchback_table::signals::{Between, ColumnNames};

/// The rig file that gives the same rig as the files did, to be put into `folder` (none: the folder that the files are named from).
pub fn manifest(plan: &Plan, folder: Option<&Path>) -> String {
    let mut page = String::new();
    let quoted = |text: &str| toml::Value::from(text).to_string();
    let mut line = |text: String, comment: &str| {
        let _ = match comment {
            "" => writeln!(page, "{text}"),
            _ => writeln!(page, "{text:<44} # {comment}"),
        };
    };
    line(format!("name = {}", quoted(&plan.name)), "");
    if let Some(sample_time) = plan.sampling.sample_time {
        let rate = format!("{:.3e}", 1.0 / sample_time).parse::<f64>().unwrap_or_default();
        line(format!("sample_time = {}", toml::Value::from(sample_time)), &format!("s, {rate} Hz"));
    }
    line("# order = 2".to_owned(), "order of the linear part, if you know it; else chosen from the data");
    line("# interval = [-1.0, 1.0]".to_owned(), "where the input may go; else the range of the records");
    line(format!("input = {}", optional(plan.input_label.as_deref())), "label [unit], on every axis");
    line(format!("output = {}", optional(plan.output_label.as_deref())), "");
    line(format!("columns = {{ {} }}", columns(&plan.columns)), "");
    if let Some(between) = plan.sampling.resample {
        let (written, how) = match between {
            Between::Linear => {
                ("true".to_owned(), "uneven rows are interpolated linearly to the sample time")
            }
            Between::Hold => (quoted(between.name()), "of uneven rows the last is held at every sample time"),
        };
        line(format!("resample = {written}"), how);
    }
    for record in &plan.records {
        line("\n[[record]]".to_owned(), "");
        line(format!("file = {}", quoted(&relative(&record.path, folder))), "relative to this file");
        line(
            format!("role = {}", quoted(record.role.name())),
            "free | descendant | ascendant | step_high | step_low",
        );
        line(
            format!("use = {}", quoted(record.usage.name())),
            "fit | holdout: models are judged on it, never fitted to it",
        );
        if record.columns != ColumnNames::default() {
            line(
                format!("columns = {{ {} }}", columns(&record.columns)),
                "where they are called otherwise here",
            );
        }
        if let Some(share) = record.held_out {
            line(
                format!("holdout = {}", toml::Value::from(share)),
                "share of it, at its end, that is held out",
            );
        }
    }
    page
}

fn optional(label: Option<&str>) -> String {
    toml::Value::from(label.unwrap_or_default()).to_string()
}

fn columns(names: &ColumnNames) -> String {
    let keys = [("time", &names.time), ("input", &names.input), ("output", &names.output)];
    let written = keys
        .iter()
        .filter_map(|(key, name)| Some(format!("{key} = {}", toml::Value::from(name.as_deref()?))));
    written.collect::<Vec<_>>().join(", ")
}

/// The path as seen from the folder.
fn relative(path: &Path, folder: Option<&Path>) -> String {
    let Some(folder) = folder.filter(|folder| !folder.as_os_str().is_empty() && path.is_relative()) else {
        return path.display().to_string();
    };
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (whole(path), whole(folder));
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect::<PathBuf>().display().to_string()
}
