//! `switchback plant`

use super::Model;
use crate::answer::{Answer, Stored};
use crate::call::{Call, Heard};
use crate::options::{Options, required};
use crate::records::Records;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::sync::Arc;
use switchback_io::diagnosis::Units;
use switchback_io::values::{number, whole};
use switchback_io::{model, rig};
use switchback_lab::plant as fault;
use switchback_lab::plant::Request;

/// Puts a known fault into records; gives what was put in, and the records with it.
#[pyfunction]
#[pyo3(signature = (records, options, model=None, heard=None))]
pub(crate) fn plant(
    py: Python<'_>,
    records: &Records,
    mut options: Options,
    model: Option<Model>,
    heard: Heard<'_>,
) -> PyResult<(Answer, Records)> {
    let (rig, about) = (Arc::clone(&records.rig), records.about.clone());
    Call::run(py, &heard, move |_| {
        let plain = Request::default();
        let request = Request {
            effect: required("--effect <EFFECT>", options.text("--effect <EFFECT>")?)?,
            law: options.value("--law <LAW>", whole(0..=u32::MAX.into()))?.unwrap_or(plain.law),
            size: options.value("--size <SIZE>", number)?.unwrap_or(plain.size),
            seed: options.value("--seed <SEED>", whole(0..=u64::MAX))?.unwrap_or(plain.seed),
        };
        options.finish()?;
        let host_model =
            model.map(|(path, text)| Ok::<_, Refusal>((model::of_text(&path, &text)?, path))).transpose()?;
        let host_model = host_model.as_ref().map(|(file, path)| (file, path.as_path()));
        let injected = fault::plant(&rig, &request, (&about.place, host_model))?;
        let words = fault::words(&injected.fault, &Units::of(&injected.rig).output);
        let (json, files) = (fault::json(&injected.fault), rig::artefacts(&injected.rig));
        let name = injected.rig.name.clone();
        let answer = Answer::new(Stored::new(json, words, files).reading(about.inputs));
        Ok((answer, Records::made(injected.rig, &name)))
    })
}
