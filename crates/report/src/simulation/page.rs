//! What ran and how well.

use super::misfit::outside_the_band;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::fmt::Write;
use switchback_diagnose::Effect;
use switchback_io::identification::unit;
use switchback_io::model::{Header, ModelFile, Run};
use switchback_io::output::{stamped, stamped_schema};
use switchback_io::rig::InputSeries;

/// Name and version of the layout of a run.
const SCHEMA: &str = "switchback/simulate/1";

/// A run of a model: `simulate --json`.
#[derive(Serialize, JsonSchema)]
pub(super) struct Page<'a> {
    /// The model's part.
    #[schemars(extend("enum" = Header::PARTS))]
    model: &'a str,
    /// The model's rig.
    rig: &'a str,
    /// Effects in the model.
    #[schemars(with = "Vec<Effect>")]
    effects: Vec<&'a str>,
    /// First simulated sample.
    start: usize,
    /// Samples simulated.
    samples: usize,
    /// Fit to the measured output, where there is one.
    fit_percent: Option<f64>,
    /// Share of the measured outputs within the 95 % band.
    #[schemars(range(min = 0, max = 1))]
    covered: Option<f64>,
    /// Where the input leaves what the model was identified on.
    warnings: Vec<String>,
    /// How the input was read.
    notes: Vec<String>,
    /// Version of Switchback that wrote it.
    version: &'static str,
}

/// The JSON Schema of what `--json` prints.
pub fn schema() -> Schema {
    stamped_schema::<Page<'_>>(SCHEMA)
}

impl<'a> Page<'a> {
    pub(super) fn of(file: &'a ModelFile, input: &InputSeries, run: &'a Run) -> Self {
        let header = &file.header;
        Self {
            model: &header.part,
            rig: &header.rig,
            effects: header.effects.iter().map(|added| added.effect.as_str()).collect(),
            start: run.start,
            samples: input.v.len() - run.start,
            fit_percent: run.fit_percent.filter(|fit| fit.is_finite()),
            covered: input.y.as_ref().and_then(|y| run.covered(y)),
            warnings: [
                input.warnings.clone(),
                input.y.as_ref().and_then(|y| outside_the_band(file, y, run)).into_iter().collect(),
                header.identified_on.warnings(&input.v, header.sample_time, unit(&header.input)),
            ]
            .concat(),
            notes: [input.notes.as_slice(), &run.notes].concat(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    pub(super) fn json(&self) -> String {
        stamped(SCHEMA, self)
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
