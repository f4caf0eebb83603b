//! What ran and how well.

use crate::identification::unit;
use crate::model::{ModelFile, Run};
use crate::rig::InputSeries;
use serde::Serialize;
use std::fmt::Write;

/// What ran, how well, and what to beware of.
#[derive(Serialize)]
pub(super) struct Page<'a> {
    schema: &'static str,
    model: &'a str,
    rig: &'a str,
    effects: Vec<&'a str>,
    /// First simulated sample, and samples from there on.
    start: usize,
    samples: usize,
    fit_percent: Option<f64>,
    /// Share of the measured outputs within the band.
    covered: Option<f64>,
    warnings: Vec<String>,
    notes: Vec<String>,
    version: &'static str,
}

impl<'a> Page<'a> {
    pub(super) fn of(file: &'a ModelFile, input: &InputSeries, run: &'a Run) -> Self {
        let header = &file.header;
        Self {
            schema: "switchback/simulate/1",
            model: &header.part,
            rig: &header.rig,
            effects: header.effects.iter().map(|added| added.effect.as_str()).collect(),
            start: run.start,
            samples: input.v.len() - run.start,
            fit_percent: run.fit_percent.filter(|fit| fit.is_finite()),
            covered: input.y.as_ref().and_then(|y| run.covered(y)),
            warnings: [
                input.warnings.clone(),
                header.identified_on.warnings(&input.v, header.sample_time, unit(&header.input)),
            ]
            .concat(),
            notes: [input.notes.as_slice(), &run.notes].concat(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    pub(super) fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers, strings and lists of them are JSON") + "\n"
    }

    pub(super) fn words(&self) -> String {
        let with = if self.effects.is_empty() {
            String::new()
        } else {
            format!(" with {}", self.effects.join(" and "))
        };
        let mut text =
            format!("{} model of {}{with}: {} samples simulated", self.model, self.rig, self.samples);
        if let Some(fit) = self.fit_percent {
            let _ = write!(text, ", fit {fit:.2} %");
        }
        if let Some(covered) = self.covered {
            let _ = write!(text, ", {:.1} % of the measured outputs within the 95 % band", 100.0 * covered);
        }
        text.push('\n');
        for warning in &self.warnings {
            let _ = writeln!(text, "warning: {warning}");
        }
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
        text
    }
}
