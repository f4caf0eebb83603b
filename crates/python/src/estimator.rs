//! The fit behind `SwitchedHysteresis`: the method for any record, with order, knots and delay as they are given.

use crate::call::{Call, Heard};
use crate::numbers::numbers;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use switchback_identify::free::{InputMap, Settings, identify_watched};
use switchback_io::model::{Curves, Domain, Header, ModelFile, System};
use switchback_io::threads::Threads;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// What the caller fixes; the rest is chosen by cross-validation within the records.
#[derive(Debug, Clone, Copy, FromPyObject)]
pub(crate) struct Fixed {
    #[pyo3(item)]
    order: Option<usize>,
    #[pyo3(item)]
    points: Option<usize>,
    #[pyo3(item)]
    delay: Option<isize>,
    #[pyo3(item)]
    causal: bool,
    #[pyo3(item)]
    sample_time: f64,
    #[pyo3(item)]
    threads: Option<u16>,
}

/// Fits pieces of records, inputs and outputs, and gives the model as the text of a model file.
#[pyfunction]
#[pyo3(signature = (pieces, fixed, heard=None))]
pub(crate) fn fit(
    py: Python<'_>,
    pieces: Vec<(Bound<'_, PyBytes>, Bound<'_, PyBytes>)>,
    fixed: Fixed,
    heard: Heard<'_>,
) -> PyResult<String> {
    let pieces: Vec<(Vec<f64>, Vec<f64>)> = pieces
        .iter()
        .map(|(v, y)| Ok((numbers(v.as_bytes())?, numbers(y.as_bytes())?)))
        .collect::<PyResult<_>>()?;
    Call::run(py, &heard, move |call| {
        let records = pieces.into_iter().map(|(v, y)| Record::new(v, y)).collect::<Result<Vec<_>, _>>();
        let records = records.map_err(Refusal::new)?;
        let settings = Settings {
            order: fixed.order,
            knots: fixed.points,
            delay: fixed.delay,
            causal: fixed.causal,
            // Standard errors are not asked for here.
            undersmooth: false,
            input_noise: false,
            ..Settings::new(InputMap::Borders)
        };
        let threads = Threads(fixed.threads);
        let identified = threads.install(|| {
            let records: Vec<&Record> = records.iter().collect();
            identify_watched(&records, &settings, &*call)
        })?;
        let curves = Curves::of(&identified.map_err(Refusal::new)?);
        Ok(file(rig(records, fixed.sample_time), curves).text())
    })
}

fn rig(records: Vec<Record>, sample_time: f64) -> Rig {
    let record = |(k, record)| RigRecord {
        name: format!("piece {}", k + 1),
        role: Role::Free,
        usage: Usage::Fit,
        record,
        predicted: None,
    };
    Rig {
        name: "SwitchedHysteresis".to_owned(),
        sample_time,
        order: None,
        interval: None,
        input_label: "input v".to_owned(),
        output_label: "output y".to_owned(),
        records: records.into_iter().enumerate().map(record).collect(),
    }
}

fn file(rig: Rig, curves: Curves) -> ModelFile {
    let header = Header {
        part: "identified".to_owned(),
        identified_on: Domain::of(&rig, curves.reversal_threshold()),
        rig: rig.name,
        method: Some("free".to_owned()),
        input: rig.input_label,
        output: rig.output_label,
        sample_time: rig.sample_time,
        effects: Vec::new(),
    };
    ModelFile { header, system: System::Curves(curves) }
}
