//! `switchback SCENARIO.toml`

use crate::answer::{Answer, Page};
use crate::call::{Call, Heard, Stoppable};
use crate::method::Function;
use crate::options::Options;
use crate::refusal::Refusal;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use switchback_io::output::Artefacts;
use switchback_io::output::path_in_shell;
use switchback_io::threads::Threads;
use switchback_lab::examination::design_of;
use switchback_report::study as report;
use switchback_study::consistency::{Ended, Progress, Study, least_seconds};
use switchback_study::estimate::permit;
use switchback_study::foreign::ForeignEstimator;
use switchback_study::results::{Results, to_json};
use switchback_study::scenario::{Engine, ForeignMethod, Scenario};
use switchback_study::{ForeignName, Request, refuse_other_kinds};

/// Runs the consistency study of a scenario file.
#[pyfunction]
#[pyo3(signature = (file, options, heard=None, methods=Vec::new()))]
pub(crate) fn study(
    py: Python<'_>,
    file: PathBuf,
    options: Options,
    heard: Heard<'_>,
    methods: Functions,
) -> PyResult<Answer> {
    Call::run(py, &heard, move |call| {
        refuse_other_kinds(&file)?;
        refuse_examinations(&file)?;
        let scenario = Scenario::read(&file)?;
        studied(scenario, (&file, options), methods, call)
    })
}

/// The same of a scenario as JSON; `file` is what messages call it.
#[pyfunction]
#[pyo3(signature = (file, json, options, heard=None, methods=Vec::new()))]
pub(crate) fn study_of_json(
    py: Python<'_>,
    file: PathBuf,
    json: String,
    options: Options,
    heard: Heard<'_>,
    methods: Functions,
) -> PyResult<(Answer, String)> {
    Call::run(py, &heard, move |call| {
        let value: toml::Value = serde_json::from_str(&json).map_err(Refusal::new)?;
        let text = toml::to_string_pretty(&value).map_err(Refusal::new)?;
        let scenario = Scenario::parse(&file.display().to_string(), &text)?;
        Ok((studied(scenario, (&file, options), methods, call)?, text))
    })
}

/// Examinations keep their rigs sealed in a folder.
fn refuse_examinations(file: &Path) -> Result<(), Refusal> {
    let Some(design) = design_of(file) else { return Ok(()) };
    let kind = design.article_and_name();
    let path = file.display().to_string();
    Err(Refusal::new(format!(
        "{path}: this is {kind}, which only the command line runs\nhelp: it seals its rigs in a folder: run it with `switchback {}`",
        path_in_shell(file)
    )))
}

/// Functions as estimators, by the names of their methods.
type Functions = Vec<(String, Py<PyAny>)>;

/// The scenario with functions as methods of others; a command would need the program.
fn with_functions(
    scenario: Scenario,
    functions: Functions,
) -> Result<(Scenario, Vec<Arc<dyn ForeignEstimator>>), Refusal> {
    if let Some(method) = scenario.foreign().first() {
        return Err(Refusal::new(format!(
            "method `{}` is a command, which only the command line runs\nhelp: leave [[method]] out and give a function, as in study(…, methods={{\"{0}\": function}})",
            method.name.as_str()
        )));
    }
    let (mut methods, mut estimators) = (Vec::<ForeignMethod>::new(), Vec::new());
    for (name, adaptor) in functions {
        let is_taken = |other: &ForeignMethod| other.name.as_str().eq_ignore_ascii_case(&name);
        let known = ForeignName::new(&name).filter(|_| !methods.iter().any(is_taken));
        let refusal = || {
            Refusal::new(format!(
                "`{name}` cannot be the name of a method\nhelp: write {}",
                ForeignName::RULE
            ))
        };
        methods.push(ForeignMethod::function(known.ok_or_else(refusal)?));
        estimators.push(Arc::new(Function::new(adaptor)) as Arc<dyn ForeignEstimator>);
    }
    Ok((scenario.with_methods(methods), estimators))
}

fn studied(
    scenario: Scenario,
    (file, mut options): (&Path, Options),
    functions: Functions,
    call: Arc<Call>,
) -> Result<Answer, Refusal> {
    let request =
        Request { engine: options.name("--engine <ENGINE>", &Engine::ALL, |engine| engine.name())? };
    let (threads, is_allowed) = (options.threads()?, options.switch("--yes")?);
    options.finish()?;
    let (scenario, estimators) = with_functions(request.of(scenario), functions)?;
    let scenario = &scenario;
    permit(least_seconds(scenario), threads, is_allowed)?;
    let results = threads.install(|| {
        let study = Study::plan_with(scenario, estimators).map_err(Refusal::new)?;
        study.begin_methods().map_err(Refusal::new)?;
        let mut run_state = study.begin();
        Progress::planned(&*call, study.forecast().max(run_state.target()) as u64);
        match study.run(&mut run_state, &*call, &mut Stoppable(Arc::clone(&call))) {
            Ended::Finished => Ok(study.results(&run_state, request.command(file))),
            // Whoever stopped it does not wait for what it amounts to.
            Ended::Stopped => Err(Refusal::new("stopped")),
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

    fn files(&self) -> Result<Artefacts, Refusal> {
        Ok(self.threads.install(|| report::artefacts(&self.results))??)
    }

    fn inputs(&self) -> &[PathBuf] {
        std::slice::from_ref(&self.file)
    }
}
