//! A rig in memory, however it was read.

use crate::call::{Call, Heard};
use crate::numbers::{bytes, numbers};
use crate::options::Options;
use crate::refusal::Refusal;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use switchback_io::rig::{
    self, Between, Cells, ColumnNames, Frame, InputForm, Loaded, Plan, PlannedRecord, RigError, RigProblem,
    Sampling,
};
use switchback_io::values::positive;
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// The records of a rig, and what was inferred when they were read.
#[pyclass(frozen, module = "switchback._native")]
pub(crate) struct Records {
    pub(crate) rig: Arc<Rig>,
    pub(crate) about: About,
}

/// What is known beside the records.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct About {
    /// What messages call all of it.
    pub(crate) place: PathBuf,
    /// What was inferred, as the command line shows it.
    reported: String,
    /// Values that cannot have been measured.
    pub(crate) warnings: Vec<String>,
    /// The rig file that says so.
    manifest: String,
    /// Files that were read.
    pub(crate) inputs: Vec<PathBuf>,
}

/// A rig without its numbers.
#[derive(Debug, Serialize, Deserialize)]
struct Outline {
    name: String,
    sample_time: f64,
    order: Option<usize>,
    interval: Option<[f64; 2]>,
    input: String,
    output: String,
    /// Name, role, use.
    records: Vec<[String; 3]>,
}

/// A frame as Python hands it over.
#[derive(Debug, Deserialize)]
struct Described {
    name: String,
    order: Option<i64>,
    interval: Option<[f64; 2]>,
    input: Option<String>,
    output: Option<String>,
    time: Option<String>,
    sample_time: Option<f64>,
    /// `linear` or `hold`.
    resample: Option<String>,
    /// The share of every record that is held out, at its end.
    share: Option<f64>,
    /// Records that are held out whole.
    held_out: Vec<String>,
    /// Name and role of each record.
    records: Vec<[String; 2]>,
}

/// A column: its label, and its numbers as bytes or its cells as texts.
type Column<'py> = (String, Option<Bound<'py, PyBytes>>, Option<Vec<String>>);

/// Inputs, outputs and predictions of a record.
type Arrays<'py> = (Bound<'py, PyBytes>, Bound<'py, PyBytes>, Option<Bound<'py, PyBytes>>);

#[pymethods]
impl Records {
    /// Reads files, or a rig file, as the command line does.
    #[staticmethod]
    #[pyo3(signature = (data, options, heard=None))]
    fn read(py: Python<'_>, data: Vec<PathBuf>, mut options: Options, heard: Heard<'_>) -> PyResult<Self> {
        Call::run(py, &heard, move |_| {
            let request = rig::Request {
                data,
                columns: ColumnNames {
                    time: options.text("--time <COLUMN>")?,
                    input: options.text("--input <COLUMN>")?,
                    output: options.text("--output <COLUMN>")?,
                },
                sample_time: options.value("--sample-time <SECONDS>", positive)?,
                rate: options.value("--rate <HZ>", positive)?,
                holdout: options.text("--holdout <SHARE|FILE>")?,
                resample: options.name("--resample <HOW>", &Between::ALL, |between| between.name())?,
            };
            options.finish()?;
            let loaded = request.load("gap")?;
            let inputs = request.inputs(&loaded.plan).into_iter().map(Path::to_owned).collect();
            Ok(Self::of(loaded, request.place().to_owned(), inputs))
        })
    }

    /// Takes the columns of frames, one a record.
    #[staticmethod]
    #[pyo3(signature = (described, frames))]
    fn from_frames(py: Python<'_>, described: &str, frames: Vec<Vec<Column<'_>>>) -> PyResult<Self> {
        let described: Described =
            serde_json::from_str(described).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let frames = frames.into_iter().map(columns).collect::<PyResult<Vec<_>>>()?;
        let read = move || {
            let plan = plan(&described)?;
            let named = plan.records.iter().zip(frames);
            let frames = named
                .map(|(record, columns)| Frame::new(&record.named, columns))
                .collect::<Result<_, _>>()?;
            let loaded = rig::load_frames(&plan, frames)?;
            Ok::<_, Refusal>(Self::of(loaded, PathBuf::from(&described.name), Vec::new()))
        };
        Ok(py.detach(read)?)
    }

    /// A rig that was taken apart before.
    #[staticmethod]
    fn from_parts(outline: &str, about: &str, arrays: Vec<Arrays<'_>>) -> PyResult<Self> {
        let refuse = |what: &str| PyValueError::new_err(format!("these are no parts of a rig: {what}"));
        let outline: Outline = serde_json::from_str(outline).map_err(|error| refuse(&error.to_string()))?;
        let about: About = serde_json::from_str(about).map_err(|error| refuse(&error.to_string()))?;
        if outline.records.len() != arrays.len() {
            return Err(refuse("another number of records than of arrays"));
        }
        let record = |([name, role, usage], (v, y, predicted)): (&[String; 3], Arrays<'_>)| {
            let record = Record::new(numbers(v.as_bytes())?, numbers(y.as_bytes())?)
                .map_err(|error| refuse(&error.to_string()))?;
            let predicted = predicted.map(|predicted| numbers(predicted.as_bytes())).transpose()?;
            if predicted.as_ref().is_some_and(|predicted| predicted.len() != record.len()) {
                return Err(refuse("a prediction of another length than its record"));
            }
            Ok(RigRecord {
                name: name.clone(),
                role: role_of(role).ok_or_else(|| refuse("an unknown role"))?,
                usage: if usage == Usage::Fit.name() { Usage::Fit } else { Usage::Holdout },
                record,
                predicted,
            })
        };
        let records = outline.records.iter().zip(arrays).map(record).collect::<PyResult<Vec<_>>>()?;
        let interval = outline.interval.map(|[low, high]| Interval::new(low, high));
        let rig = Rig {
            name: outline.name,
            sample_time: outline.sample_time,
            order: outline.order,
            interval: interval.transpose().map_err(|error| refuse(&error.to_string()))?,
            input_label: outline.input,
            output_label: outline.output,
            records,
        };
        Ok(Self { rig: Arc::new(rig), about })
    }

    /// Name, sample time, order, interval, labels, and name, role and use of every record, as JSON.
    #[getter]
    fn outline(&self) -> String {
        let rig = &self.rig;
        let record =
            |record: &RigRecord| [&record.name, record.role.name(), record.usage.name()].map(str::to_owned);
        let outline = Outline {
            name: rig.name.clone(),
            sample_time: rig.sample_time,
            order: rig.order,
            interval: rig.interval.map(|interval| [interval.low(), interval.high()]),
            input: rig.input_label.clone(),
            output: rig.output_label.clone(),
            records: rig.records.iter().map(record).collect(),
        };
        serde_json::to_string(&outline).expect("strings and finite numbers are JSON")
    }

    /// Inputs, outputs and predictions of every record.
    fn arrays<'py>(&self, py: Python<'py>) -> Vec<[Option<Bound<'py, PyBytes>>; 3]> {
        let record = |record: &RigRecord| {
            let [v, y] = [record.record.v(), record.record.y()].map(|values| Some(bytes(py, values)));
            [v, y, record.predicted.as_deref().map(|predicted| bytes(py, predicted))]
        };
        self.rig.records.iter().map(record).collect()
    }

    /// The same records with predictions of another simulator, one a record, none where there is none.
    fn with_predictions(&self, predictions: Vec<Option<Bound<'_, PyBytes>>>) -> PyResult<Self> {
        let mut rig = Rig::clone(&self.rig);
        for (record, predicted) in rig.records.iter_mut().zip(predictions) {
            record.predicted = predicted.map(|predicted| numbers(predicted.as_bytes())).transpose()?;
        }
        Ok(Self { rig: Arc::new(rig), about: self.about.clone() })
    }

    /// What was inferred, as the command line shows it.
    #[getter]
    fn reported(&self) -> &str {
        &self.about.reported
    }

    /// Values that cannot have been measured.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.about.warnings.clone()
    }

    /// The rig file that says what was inferred.
    #[getter]
    fn manifest(&self) -> &str {
        &self.about.manifest
    }

    /// What messages call all of it.
    #[getter]
    fn place(&self) -> String {
        self.about.place.display().to_string()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let about =
            serde_json::to_string(&self.about).map_err(|error| PyValueError::new_err(error.to_string()))?;
        let arrays: Vec<_> = self.arrays(py).into_iter().map(|[v, y, predicted]| (v, y, predicted)).collect();
        let parts = (self.outline(), about, arrays).into_pyobject(py)?;
        Ok((py.get_type::<Self>().getattr("from_parts")?, parts))
    }
}

impl Records {
    fn of(loaded: Loaded, place: PathBuf, inputs: Vec<PathBuf>) -> Self {
        let manifest = rig::manifest(&loaded.plan, None);
        let Loaded { rig, reported, .. } = loaded;
        let about =
            About { place, reported: reported.to_string(), warnings: reported.warnings, manifest, inputs };
        Self { rig: Arc::new(rig), about }
    }

    /// A rig that was made here.
    pub(crate) fn made(rig: Rig, place: &str) -> Self {
        Self { rig: Arc::new(rig), about: About { place: place.into(), ..About::default() } }
    }
}

fn columns(frame: Vec<Column<'_>>) -> PyResult<Vec<(String, Cells)>> {
    let column = |(label, values, texts): Column<'_>| {
        let cells = match (values, texts) {
            (Some(values), _) => Cells::Numbers(numbers(values.as_bytes())?),
            (None, texts) => Cells::Texts(texts.unwrap_or_default()),
        };
        Ok((label, cells))
    };
    frame.into_iter().map(column).collect()
}

/// The roles by their names.
fn role_of(name: &str) -> Option<Role> {
    let roles = [Role::StepHigh, Role::StepLow, Role::Descendant, Role::Ascendant, Role::Free];
    roles.into_iter().find(|role| role.name() == name)
}

fn asked(message: String, remedy: &str) -> RigError {
    RigProblem::Asked { message, remedy: remedy.to_owned() }.into()
}

/// What to make of the frames.
fn plan(described: &Described) -> Result<Plan, RigError> {
    if let Some(share) = described.share.filter(|share| !(*share > 0.0 && *share < 1.0)) {
        return Err(asked(
            format!("holdout={share} is no share of a record"),
            "give a number between 0 and 1, the share of every record that is held out, or the name of a record",
        ));
    }
    if let Some(sample_time) = described.sample_time.filter(|time| !(time.is_finite() && *time > 0.0)) {
        return Err(asked(format!("sample_time={sample_time} is no time"), "give positive seconds"));
    }
    let order =
        described.order.map(|order| usize::try_from(order).ok().filter(|order| (1..=20).contains(order)));
    if order == Some(None) {
        return Err(asked(
            format!("order={} is no order of a system", described.order.unwrap_or_default()),
            "give a whole number from 1 to 20, or leave it out to have it chosen from the data",
        ));
    }
    let interval =
        described.interval.map(|[low, high]| Interval::new(low, high)).transpose().map_err(|error| {
            asked(
                format!("interval={:?}: {error}", described.interval.unwrap_or_default()),
                "give both ends, the lower one first",
            )
        })?;
    let is_held = |name: &String| described.held_out.contains(name);
    if described.records.iter().all(|[name, _]| is_held(name)) {
        return Err(asked(
            "all is held out, so there is nothing to identify from".to_owned(),
            "give more records, or hold out a share, for instance `holdout=0.3`",
        ));
    }
    let record = |[name, role]: &[String; 2]| {
        let role = role_of(role).ok_or_else(|| {
            asked(
                format!("`{role}` is no role of a record"),
                "the roles are free, descendant, ascendant, step_high and step_low",
            )
        })?;
        Ok(PlannedRecord {
            path: PathBuf::from(name),
            named: name.clone(),
            columns: ColumnNames::default(),
            role,
            usage: if is_held(name) { Usage::Holdout } else { Usage::Fit },
            held_out: described.share,
        })
    };
    Ok(Plan {
        name: described.name.clone(),
        columns: ColumnNames {
            time: described.time.clone(),
            input: described.input.clone(),
            output: described.output.clone(),
        },
        sampling: Sampling {
            sample_time: described.sample_time,
            resample: described.resample.as_deref().and_then(Between::named),
        },
        order: order.flatten(),
        interval,
        input_label: None,
        output_label: None,
        records: described.records.iter().map(record).collect::<Result<_, RigError>>()?,
        input_form: InputForm::Arguments,
    })
}
