//! `switchback SCENARIO.toml`

use super::options;
use crate::answer::{Answer, Page};
use crate::call::{Call, Heard, Stoppable};
use crate::refusal::Refusal;
use clap::Args;
use miette::miette;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use switchback::cmd::study::{EngineArgs, refuse_all_but_consistency};
use switchback::options::{Quiet, Threads, Yes};
use switchback_io::output::Artefacts;
use switchback_report::study as report;
use switchback_study::consistency::{Ended, Progress, Study, least_seconds};
use switchback_study::results::{Results, to_json};
use switchback_study::scenario::Scenario;

/// Runs the consistency study of a scenario file.
#[pyfunction]
#[pyo3(signature = (file, words, heard=None))]
pub(crate) fn study(
    py: Python<'_>,
    file: PathBuf,
    words: Vec<OsString>,
    heard: Heard<'_>,
) -> PyResult<Answer> {
    Call::run(py, &heard, move |call| {
        refuse_all_but_consistency(&file)?;
        let scenario = Scenario::read(&file)?;
        studied(scenario, (&file, words), call)
    })
}

/// The same of a scenario as JSON; `file` is what messages call it.
#[pyfunction]
#[pyo3(signature = (file, json, words, heard=None))]
pub(crate) fn study_of_json(
    py: Python<'_>,
    file: PathBuf,
    json: String,
    words: Vec<OsString>,
    heard: Heard<'_>,
) -> PyResult<(Answer, String)> {
    Call::run(py, &heard, move |call| {
        let value: toml::Value = serde_json::from_str(&json).map_err(|error| miette!("{error}"))?;
        let text = toml::to_string_pretty(&value).map_err(|error| miette!("{error}"))?;
        let scenario = Scenario::parse(&file.display().to_string(), &text)?;
        Ok((studied(scenario, (&file, words), call)?, text))
    })
}

/// What a study takes.
#[derive(Debug, Args)]
struct StudyOptions {
    #[command(flatten)]
    engine: EngineArgs,

    #[command(flatten)]
    threads: Threads,

    #[command(flatten)]
    yes: Yes,
}

fn studied(
    scenario: Scenario,
    (file, words): (&Path, Vec<OsString>),
    call: Arc<Call>,
) -> Result<Answer, Refusal> {
    let StudyOptions { engine, threads, yes } = options(words)?;
    let scenario = &engine.of(scenario);
    yes.permit(least_seconds(scenario), threads, Quiet { quiet: true })?;
    let results = threads.install(|| {
        let study = Study::plan(scenario).map_err(|error| miette!("{error}"))?;
        let mut run_state = study.begin();
        Progress::planned(&*call, study.forecast().max(run_state.target()) as u64);
        match study.run(&mut run_state, &*call, &mut Stoppable(Arc::clone(&call))) {
            Ended::Finished => Ok(study.results(&run_state, engine.command(file))),
            // Whoever stopped it does not wait for what it amounts to.
            Ended::Stopped => Err(miette!("stopped")),
        }
    })??;
    Ok(Answer::new(Studied { results, threads, file: file.to_owned() }))
}

#[derive(Debug)]
struct Studied {
    results: Results,
    threads: Threads,
    file: PathBuf,
}

impl Page for Studied {
    fn json(&self) -> String {
        to_json(&self.results)
    }

    fn words(&self) -> String {
        report::table(&self.results)
    }

    fn files(&self) -> miette::Result<Artefacts> {
        Ok(self.threads.install(|| report::artefacts(&self.results))??)
    }

    fn inputs(&self) -> &[PathBuf] {
        std::slice::from_ref(&self.file)
    }
}
