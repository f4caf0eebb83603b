//! A model run on an input: what comes out as a table, in words and as JSON.

mod error;
mod free_run;
mod misfit;
mod page;
mod request;
mod table;

pub use error::SimulateError;
pub use page::schema;
pub use request::Request;

use free_run::free_run;
use page::Page;
use std::path::Path;
use switchback_io::model::{ModelFile, Run};
use switchback_io::rig::InputSeries;

/// A model that ran on an input.
#[derive(Debug)]
pub struct Simulation {
    file: ModelFile,
    input: InputSeries,
    run: Run,
}

impl Simulation {
    /// Runs a model on an input, which messages call by its `place`.
    ///
    /// # Errors
    /// An input in other units, or one that runs along a border that the model does not know.
    pub fn new(file: ModelFile, input: InputSeries, place: &Path) -> Result<Self, SimulateError> {
        let labels = [input.input_label.as_str(), input.output_label.as_deref().unwrap_or_default()];
        file.header.check_units(labels, (place, "file"))?;
        match free_run(&file, &input) {
            Some(run) => Ok(Self { file, input, run }),
            None => Err(SimulateError::NoRun { input: place.display().to_string() }),
        }
    }

    /// The input, input units.
    pub fn input(&self) -> &[f64] {
        &self.input.v
    }

    /// The run.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// The columns `t,v,y,y_low,y_high`.
    pub fn csv(&self) -> String {
        table::table(&self.input, &self.run)
    }

    /// What ran and how well as one JSON object.
    pub fn json(&self) -> String {
        self.page().json()
    }

    /// The same in words.
    pub fn words(&self) -> String {
        self.page().words()
    }

    fn page(&self) -> Page<'_> {
        Page::of(&self.file, &self.input, &self.run)
    }
}
