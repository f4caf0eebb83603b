//! Whom to ask, and what they estimate from the records of a scenario.

use super::own::OwnMethod;
use miette::Diagnostic;
use std::sync::Arc;
use switchback_identify::Method;
use switchback_study::ForeignName;
use switchback_study::consistency::{CellErrors, Progress, StudyError, method_errors};
use switchback_study::foreign::{ForeignError, ForeignEstimator, Processes};
use switchback_study::results::Group;
use switchback_study::scenario::{Case, Coupling, ForeignMethod, Scenario};
use thiserror::Error;

/// Two versions of an estimator, and the scenario whose records both estimate from.
#[derive(Debug)]
pub struct Versions {
    scenario: Scenario,
    names: [String; 2],
    estimators: Vec<Arc<dyn ForeignEstimator>>,
}

/// Who estimates.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Version {
    /// The name of the method.
    pub name: String,
    /// What it says its version is.
    pub version: String,
}

/// Why two versions cannot be compared.
#[derive(Debug, Error, Diagnostic)]
pub enum BenchError {
    /// A name is that of no method.
    #[error("`{name}` is no method that can be compared in {scenario}")]
    #[diagnostic(help("the methods are {known}; add another as a [[method]]"))]
    NoMethod {
        /// The name.
        name: String,
        /// The scenario's name.
        scenario: String,
        /// The names that there are.
        known: String,
    },
    /// Both names are the same.
    #[error("`{0}` would be compared with itself, which differs by nothing")]
    #[diagnostic(help("name two methods; two versions of a program are two [[method]] with a command each"))]
    Itself(
        /// The name.
        String,
    ),
    /// The versions have no parameter in common.
    #[error("`{0}` and `{1}` estimate no parameter that the other does")]
    #[diagnostic(help("name a common group in `parameters` of both"))]
    NothingInCommon(
        /// The baseline's name.
        String,
        /// The new version's.
        String,
    ),
    /// The scenario gives every cell its own noise.
    #[error("in {0} every cell has noise of its own, and versions are compared on the same noise")]
    #[diagnostic(help("leave out coupling = \"independent\""))]
    Independent(
        /// The scenario's name.
        String,
    ),
    /// There are too many numbers to hold.
    #[error("{replicates} replicates of {estimates} estimates are more numbers than are held at once")]
    #[diagnostic(help("at most {most} replicates; or sweep less"))]
    TooMuch {
        /// Replicates asked for.
        replicates: u32,
        /// Estimates in a replicate.
        estimates: usize,
        /// Replicates that are possible.
        most: usize,
    },
    /// The study cannot be run.
    #[error(transparent)]
    #[diagnostic(help("what the scenario asks for does not exist: change what is named"))]
    Study(#[from] StudyError),
    /// A method cannot be asked.
    #[error(transparent)]
    #[diagnostic(help("start its command by hand in this folder"))]
    Method(#[from] ForeignError),
}

/// Most numbers that are held at once: 1 GiB.
const MOST_NUMBERS: usize = 1 << 27;

impl Versions {
    /// The baseline and the new version by the names that they have in the scenario.
    ///
    /// # Errors
    /// [`BenchError`] if one of them is no method of the scenario, and none of ours that needs records alone; or they cannot be compared.
    pub fn of(scenario: Scenario, names: [&str; 2]) -> Result<Self, BenchError> {
        if names[0] == names[1] {
            return Err(BenchError::Itself(names[0].to_owned()));
        }
        let [baseline, new] = names.map(|name| found(&scenario, name));
        Self::with(scenario, names, [baseline?, new?])
    }

    fn with(scenario: Scenario, names: [&str; 2], sides: [Side; 2]) -> Result<Self, BenchError> {
        let name = scenario.name().to_owned();
        if scenario.coupling() == Coupling::Independent {
            return Err(BenchError::Independent(name));
        }
        let [(mut baseline, old), (mut new, young)] = sides;
        let common = |group: &Group| baseline.groups.contains(group) && new.groups.contains(group);
        let groups: Vec<Group> = Group::ALL.into_iter().filter(common).collect();
        if groups.is_empty() {
            let [baseline, new] = names.map(str::to_owned);
            return Err(BenchError::NothingInCommon(baseline, new));
        }
        // Partners help where both have them.
        let antithetic = baseline.antithetic && new.antithetic;
        (baseline.antithetic, new.antithetic) = (antithetic, antithetic);
        let names = names.map(str::to_owned);
        Ok(Self { scenario: scenario.of_methods([baseline, new]), names, estimators: vec![old, young] })
    }

    /// The scenario's name.
    pub fn scenario(&self) -> &str {
        self.scenario.name()
    }

    /// The seed of all noise.
    pub fn seed(&self) -> u64 {
        self.scenario.seed()
    }

    /// The replicates that the scenario asks for.
    pub fn replicates(&self) -> u32 {
        u32::try_from(self.scenario.replicates()).unwrap_or(u32::MAX)
    }

    /// Makes sure that both can be asked, and says who they are.
    ///
    /// # Errors
    /// [`BenchError`] if one of them cannot.
    pub fn begin(&self) -> Result<[Version; 2], BenchError> {
        let begun = |k: usize| -> Result<Version, BenchError> {
            Ok(Version { name: self.names[k].clone(), version: self.estimators[k].begin()? })
        };
        Ok([begun(0)?, begun(1)?])
    }

    /// The errors of the baseline and of the new version, cell by cell, in so many replicates.
    ///
    /// # Errors
    /// [`BenchError`] if an experiment does not exist, or there would be too many numbers.
    pub fn errors(
        &self,
        replicates: u32,
        progress: &dyn Progress,
    ) -> Result<[Vec<CellErrors>; 2], BenchError> {
        let estimates = self.estimates();
        let most = MOST_NUMBERS / estimates.max(1);
        if replicates as usize > most {
            return Err(BenchError::TooMuch { replicates, estimates, most });
        }
        let cells = method_errors(&self.scenario, &self.estimators, replicates, progress)?;
        // The methods of a setting follow each other.
        let (mut sides, mut of_new) = ([Vec::new(), Vec::new()], false);
        for cell in cells {
            sides[usize::from(of_new)].push(cell);
            of_new = !of_new;
        }
        Ok(sides)
    }

    /// Estimates in a replicate of all cells of both versions, with those of partners.
    fn estimates(&self) -> usize {
        let sweep = self.scenario.sweep();
        let settings = |borders: usize, parameters: usize| {
            2 * 2 * borders * sweep.noise.len() * sweep.samples.len() * parameters
        };
        let of_case = |case: &Case| -> usize {
            sweep.points.iter().map(|points| settings(case.borders.len(), 2 * (case.order + points))).sum()
        };
        self.scenario.cases().iter().map(of_case).sum()
    }

    /// Lets go of whoever estimates.
    pub fn end(&self) {
        self.estimators.iter().for_each(|estimator| estimator.end());
    }
}

/// A method, and who estimates for it.
type Side = (ForeignMethod, Arc<dyn ForeignEstimator>);

/// The name that a version has inside, where our own methods stand for themselves as those of others do.
fn inner(name: &str) -> ForeignName {
    ForeignName::new(name)
        .or_else(|| ForeignName::new(&format!("own-{name}")))
        .or_else(|| ForeignName::new("version"))
        .expect("a sound name")
}

fn found(scenario: &Scenario, name: &str) -> Result<Side, BenchError> {
    if let Some(method) = scenario.foreign().iter().find(|method| method.name.as_str() == name)
        && let Some(processes) = Processes::of(method)
    {
        return Ok((method.clone(), Arc::new(processes)));
    }
    if let Some(own) = Method::from_name(name).and_then(OwnMethod::new) {
        return Ok((ForeignMethod::function(inner(name)), Arc::new(own)));
    }
    let foreign = scenario.foreign().iter().map(|method| method.name.as_str().to_owned());
    let known: Vec<String> =
        OwnMethod::ALL.map(|method| method.name().to_owned()).into_iter().chain(foreign).collect();
    Err(BenchError::NoMethod {
        name: name.to_owned(),
        scenario: scenario.name().to_owned(),
        known: known.join(", "),
    })
}
