//! A function in Python as the estimator of a study.

use crate::numbers::{bytes, numbers};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};
use switchback_identify::excitation::Direction;
use switchback_study::foreign::{
    Design, DesignExperiment, Estimates, ForeignError, ForeignEstimator, Records, checked,
};

/// What `_methods.Adaptor` is around a function: `design(…)` once a cell, then a call a replicate.
#[derive(Debug)]
pub(crate) struct Function {
    adaptor: Py<PyAny>,
    /// Cells whose design it knows.
    known: Mutex<HashSet<usize>>,
}

/// Estimates and standard errors as bytes, or why there are none.
type Found<'py> = (Option<Bound<'py, PyBytes>>, Option<Bound<'py, PyBytes>>, Option<String>);

impl Function {
    pub(crate) fn new(adaptor: Py<PyAny>) -> Self {
        Self { adaptor, known: Mutex::default() }
    }

    /// Has it know a design.
    fn introduce(&self, py: Python<'_>, design: &Design) -> PyResult<()> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if !known.insert(design.cell) {
            return Ok(());
        }
        let Design { cell, order, points, samples, interval, parameters, experiments } = design;
        let experiment = |e: &DesignExperiment| {
            let name = if e.direction == Direction::Descendant { "descendant" } else { "ascendant" };
            (name, bytes(py, &e.levels), e.satellite, e.lead, bytes(py, &e.v))
        };
        let [first, second] = experiments.each_ref().map(experiment);
        let whole =
            (*cell, *order, *points, *samples, (interval[0], interval[1]), parameters, (first, second));
        self.adaptor.call_method1(py, "design", whole).map(drop)
    }

    fn called(&self, py: Python<'_>, design: &Design, records: &Records<'_>) -> Result<Estimates, String> {
        let Records { replicate, antithetic, y } = records;
        let [first, second] = y.map(|y| bytes(py, y));
        let given = (design.cell, *replicate, *antithetic, first, second);
        let words = |error: PyErr| error.to_string();
        let found = self.adaptor.call1(py, given).map_err(words)?;
        let (estimate, se, failed): Found<'_> = found.extract(py).map_err(words)?;
        let read = |found: &Bound<'_, PyBytes>| -> Result<Vec<Option<f64>>, String> {
            Ok(numbers(found.as_bytes()).map_err(words)?.into_iter().map(Some).collect())
        };
        match (estimate, failed) {
            (Some(estimate), None) => {
                let se = se.as_ref().map(read).transpose()?;
                checked(design, &read(&estimate)?, se.as_deref())
            }
            (_, failed) => Err(failed.unwrap_or_else(|| "it gave no estimate".to_owned())),
        }
    }
}

impl ForeignEstimator for Function {
    fn begin(&self) -> Result<String, ForeignError> {
        Ok(String::new())
    }

    /// The interpreter's lock is held for these records only.
    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>> {
        Python::attach(|py| match self.introduce(py, design) {
            Ok(()) => records.iter().map(|records| self.called(py, design, records)).collect(),
            Err(error) => records.iter().map(|_| Err(error.to_string())).collect(),
        })
    }
}
