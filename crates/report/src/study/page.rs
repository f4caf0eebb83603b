//! `report.md`: the study on one page.

use super::table;
use crate::plots::Figure;
use std::fmt::Write;
use switchback_io::output::{markdown, markdown_code, markdown_text};
use switchback_study::results::Results;
use switchback_study::scenario::Coupling;

/// The page: question, command, table, figures.
pub(super) fn page(results: &Results, figures: &[Figure]) -> String {
    let mut text = format!("# {}\n\n{}\n\n", markdown(&results.name), markdown_text(&results.question));
    let _ = writeln!(
        text,
        "Made by {} with Switchback {}, seed {}; {} engine, {}.\n\n```text\n{}```",
        markdown_code(&results.command),
        results.version,
        results.seed,
        results.engine.name(),
        match results.coupling {
            Coupling::Shared => "cells share their noise",
            Coupling::Independent => "every cell has its own noise",
        },
        table(results)
    );
    if let Some(rounding) = results.rounding() {
        let _ = writeln!(text, "\n{}", markdown_text(&rounding));
    }
    for figure in figures {
        let _ = writeln!(text, "\n![{0}]({0})", figure.name);
    }
    text
}
