//! `switchback design`

use crate::answer::{Answer, Page};
use crate::call::{Call, Heard};
use crate::options::Options;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::path::PathBuf;
use switchback_io::output::Artefacts;
use switchback_io::values::{interval, pair, positive, share, whole};
use switchback_study::design::{Draft, Options as Wanted, PlanMethod, Report, artefacts, json, words};

/// Plans experiments. `rig` is a rig file to plan from, `out` the folder that they are meant for.
#[pyfunction]
#[pyo3(signature = (options, rig=None, out=None, heard=None))]
pub(crate) fn design(
    py: Python<'_>,
    mut options: Options,
    rig: Option<PathBuf>,
    out: Option<PathBuf>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    Call::run(py, &heard, move |_| {
        let asked = asked(&mut options, rig)?;
        options.finish()?;
        Ok(Answer::new(Designed(Draft::new(asked, out.as_deref())?.plan()?)))
    })
}

/// The experiments that are asked for.
fn asked(options: &mut Options, from: Option<PathBuf>) -> Result<Wanted, Refusal> {
    let plain = Wanted::default();
    let method = options.name("--method <METHOD>", &PlanMethod::ALL, |method| method.name())?;
    Ok(Wanted {
        order: options.value("--order <N>", whole(Wanted::ORDERS))?,
        points: options.value("--points <M>", whole(Wanted::LEVELS))?,
        interval: options.value("--interval <LO,HI>", interval)?,
        rate: options.value("--rate <HZ>", positive)?,
        from,
        precision: options.value("--precision <P>", share)?,
        method: method.unwrap_or(plain.method),
        periods: options.value("--periods <K>", whole(1..=u32::MAX.into()))?,
        duration: options.value("--duration <S>", positive)?,
        amplitude: options.value("--amplitude <MIN,MAX>", pair)?,
        max_speed: options.value("--max-speed <SPEED>", positive)?,
        free_only: options.switch("--free-only")?,
        seed: options.value("--seed <SEED>", whole(0..=u64::MAX))?.unwrap_or(plain.seed),
        input: options.text("--input <LABEL>")?,
        output: options.text("--output <LABEL>")?,
        name: options.text("--name <NAME>")?,
    })
}

#[derive(Debug)]
struct Designed(Report);

impl Page for Designed {
    fn json(&self) -> String {
        json(&self.0)
    }

    fn words(&self) -> String {
        words(&self.0)
    }

    fn files(&self) -> Result<Artefacts, Refusal> {
        Ok(artefacts(&self.0.plan))
    }
}
