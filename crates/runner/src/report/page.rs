//! `report.md`: the study on one page.

use super::table;
use crate::plots::Figure;
use crate::results::Results;
use std::fmt::Write;

/// The page: question, command, table, figures.
pub(super) fn page(results: &Results, figures: &[Figure]) -> String {
    let mut text = format!("# {}\n\n{}\n\n", results.name, results.question);
    let _ = writeln!(
        text,
        "Made by `{}` with Switchback {}, seed {}.\n\n```text\n{}```",
        results.command,
        results.version,
        results.seed,
        table(results)
    );
    for figure in figures {
        let _ = writeln!(text, "\n![{0}]({0})", figure.name);
    }
    text
}
