//! `switchback simulate`

use super::Model;
use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use crate::numbers::{bytes, numbers};
use crate::options::Options;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::{Path, PathBuf};
use switchback_io::model;
use switchback_io::output::Artefacts;
use switchback_io::rig::{Between, ColumnNames, InputSeries};
use switchback_report::simulation::{Request, Simulation};

/// A free run: the answer, then the outputs, both ends of the band, and the first simulated sample.
type Simulated<'py> = (Answer, [Bound<'py, PyBytes>; 4], usize);

/// Runs a model on an input, from measured outputs on if there are some.
#[pyfunction]
#[pyo3(signature = (model, v, y=None, heard=None))]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    model: Model,
    v: Bound<'py, PyBytes>,
    y: Option<Bound<'py, PyBytes>>,
    heard: Heard<'py>,
) -> PyResult<Simulated<'py>> {
    let v = numbers(v.as_bytes())?;
    let y = y.map(|y| numbers(y.as_bytes())).transpose()?;
    let run = Call::run(py, &heard, move |_| {
        let (path, text) = model;
        let file = model::of_text(&path, &text)?;
        let header = &file.header;
        let input = InputSeries {
            sample_time: header.sample_time,
            start: 0.0,
            v,
            times: None,
            time_unit: None,
            input_label: header.input.clone(),
            output_label: y.as_ref().map(|_| header.output.clone()),
            y,
            warnings: Vec::new(),
            notes: Vec::new(),
        };
        Ok(Simulation::new(file, input, Path::new("v"))?)
    })?;
    Ok(simulated(py, run))
}

/// The same on an input in a file.
#[pyfunction]
#[pyo3(signature = (model, file, options, heard=None))]
pub(crate) fn simulate_file<'py>(
    py: Python<'py>,
    model: Model,
    file: PathBuf,
    mut options: Options,
    heard: Heard<'py>,
) -> PyResult<Simulated<'py>> {
    let run = Call::run(py, &heard, move |_| {
        let (path, text) = model;
        let request = Request {
            file,
            columns: ColumnNames {
                time: options.text("--time <COLUMN>")?,
                input: options.text("--input <COLUMN>")?,
                output: options.text("--output <COLUMN>")?,
            },
            resample: options.name("--resample <HOW>", &Between::ALL, |between| between.name())?,
        };
        options.finish()?;
        let file = model::of_text(&path, &text)?;
        let input = request.read((&file, &path))?;
        Ok(Simulation::new(file, input, &request.file)?)
    })?;
    Ok(simulated(py, run))
}

fn simulated(py: Python<'_>, simulation: Simulation) -> Simulated<'_> {
    let run = simulation.run();
    let arrays = [simulation.input(), &run.y, &run.low, &run.high].map(|values| bytes(py, values));
    let start = run.start;
    (Answer::new(Ran(simulation)), arrays, start)
}

#[derive(Debug)]
struct Ran(Simulation);

impl Page for Ran {
    fn json(&self) -> String {
        self.0.json()
    }

    fn words(&self) -> String {
        self.0.words()
    }

    fn files(&self) -> Result<Artefacts, Refusal> {
        let mut files = Artefacts::default();
        files.add("simulated.csv", self.0.csv());
        Ok(files)
    }
}
