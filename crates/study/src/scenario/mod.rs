//! Scenario files: one study, one TOML file.
//!
//! The file is read faithfully into private wire types (`wire`), then converted once (`convert`) into a [`Scenario`],
//! which cannot be invalid: whoever holds one may run it. Every refusal names file, line, key, value and remedy.

mod border;
mod border_kind;
mod convert;
mod error;
mod expect;
mod foreign_method;
mod read;
mod take;
#[cfg(test)]
mod tests;
mod wire;

pub use error::ScenarioError;
pub use expect::Check;
pub use expect::Coverage;
pub use expect::Expect;
pub use expect::Width;
pub use foreign_method::ForeignMethod;
pub use foreign_method::Program;
pub(crate) use switchback_identify::Method;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use switchback_model::hysteresis::{Interval, SwitchedHysteresis};
use switchback_model::linear::LinearSystem;

/// A consistency study: which systems, borders, noise levels, record lengths and methods, and what must come out.
#[derive(Debug, Clone)]
pub struct Scenario {
    name: String,
    question: String,
    seed: u64,
    replication: Replication,
    coupling: Coupling,
    engine: Engine,
    labels: Labels,
    cases: Vec<Case>,
    sweep: Sweep,
    foreign: Vec<ForeignMethod>,
    source: serde_json::Value,
}

/// How many replicates each cell takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Replication {
    /// Replicates that every cell takes, at least 2.
    pub replicates: usize,
    /// When to go on beyond them; `None` stops there.
    pub stopping: Option<Stopping>,
}

/// The rule that lets cells take more replicates than the first batch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stopping {
    /// Stop when the Monte-Carlo standard error of every bias is at most this many standard deviations of its estimate.
    pub bias_mcse: Option<f64>,
    /// Stop when the Monte-Carlo standard error of every standard deviation is at most this share of it.
    pub sd_relative_mcse: Option<f64>,
    /// Stop at this many replicates even so.
    pub max_replicates: usize,
}

/// Whether the cells of a sweep see the same noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coupling {
    /// Replicate r of every cell sees the same unit noise (common random numbers).
    Shared,
    /// Every cell has its own noise.
    Independent,
}

/// How the replicates are computed; both engines see the same noise and give the same estimates to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// One pass over the noise of a replicate serves every cell: their sufficient statistics follow by superposition.
    Superposed,
    /// Every cell is simulated sample by sample and fitted from its record: slow, to check the other with. Pulse methods are solved by dense QR,
    /// `free` from the sums of its record.
    Direct,
}

impl Engine {
    /// Every engine, the default first.
    pub const ALL: [Self; 2] = [Self::Superposed, Self::Direct];

    /// The name used in scenario files, results and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Superposed => "superposed",
            Self::Direct => "direct",
        }
    }

    /// The engine of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.name() == name)
    }
}

/// What the axes are called: quantity and unit.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Labels {
    /// The input `v`.
    pub input: String,
    /// The output `y`.
    pub output: String,
}

/// One system under one set of assumptions, kept or broken.
#[derive(Debug, Clone)]
pub struct Case {
    /// Unique in the scenario.
    pub name: String,
    /// The true linear part; `b` in output units per unit of `u`.
    pub system: LinearSystem,
    /// The borders of the sweep on this case's interval, in the order of the sweep.
    pub borders: Vec<Border>,
    /// What disturbs the record.
    pub disturbance: Disturbance,
    /// The order the estimators assume.
    pub order: usize,
    /// Samples `s` between neighbouring visits of the descendant and ascendant experiments.
    pub spacing: usize,
    /// On which knots `free` estimates the borders.
    pub knots: Knots,
    /// What the fits of `free` make least.
    pub fit: Fit,
    /// What must come out of this case.
    pub expect: Expect,
}

/// On which knots the method `free` estimates the borders; it shows them at the `m` evenly spaced ones of the sweep in every case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knots {
    /// On those `m`, whatever the borders do between them.
    Given,
    /// On halvings of those, as fine as the record asks for: see [`switchback_identify::free::NestedRegressions`].
    Refined,
    /// An oracle: on the first of these grids that holds the true borders, so that the bias of the limit is below a third of the standard error, root mean square
    /// over coefficients and over points; on the last where none does.
    Known,
}

impl Knots {
    /// Every kind, the default first.
    pub(crate) const ALL: [Self; 3] = [Self::Given, Self::Refined, Self::Known];

    /// The name used in scenario files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Refined => "refined",
            Self::Known => "known",
        }
    }

    /// The kind of that name.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name() == name)
    }
}

/// What the fits of the method `free` make least.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fit {
    /// The equation error: consistent where that is white.
    Equation,
    /// The error of the free run: consistent whatever the noise.
    FreeRun,
    /// That error, filtered by a model of the noise: what `identify` does.
    Prewhitened,
}

impl Fit {
    /// Every kind, the default first.
    pub(crate) const ALL: [Self; 3] = [Self::Equation, Self::FreeRun, Self::Prewhitened];

    /// The name used in scenario files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Equation => "equation error",
            Self::FreeRun => "free run",
            Self::Prewhitened => "prewhitened",
        }
    }

    /// The kind of that name.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name() == name)
    }
}

/// A named hysteresis.
#[derive(Debug, Clone)]
pub struct Border {
    /// Unique in the scenario.
    pub name: String,
    /// The operator on the case's interval; Assumption 1 holds.
    pub hysteresis: Arc<SwitchedHysteresis>,
}

/// What disturbs the record. In every kind the sweep's noise level is the standard deviation of the white source.
#[derive(Debug, Clone, PartialEq)]
pub enum Disturbance {
    /// White equation error `ξ`: what the paper assumes.
    White,
    /// Equation error `ξ = M/D·w`: `D = 1 + d₁q⁻¹ + …` (`ar`, stable) and `M = 1 + m₁q⁻¹ + …` (`ma`), `w` white.
    Coloured {
        /// `d₁, d₂, …`
        ar: Vec<f64>,
        /// `m₁, m₂, …`
        ma: Vec<f64>,
    },
    /// White noise added to the measured output: equation error `A(q⁻¹) w`.
    Output,
}

/// The grid every case is run on.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// Standard deviations of the noise, output units; positive, distinct.
    pub noise: Vec<f64>,
    /// Regression samples `N` of each experiment; ascending, none shorter than a period of any case and `m`.
    pub samples: Vec<usize>,
    /// Numbers of points `m` visited on each border; positive, distinct.
    pub points: Vec<usize>,
    /// Methods of ours, distinct.
    pub methods: Vec<Method>,
    /// The least `N` of a fitted slope, one of `samples`.
    pub slope_from: usize,
}

impl Sweep {
    /// The numbers of samples that slopes are fitted over.
    pub(crate) fn slope_samples(&self) -> &[usize] {
        &self.samples[self.samples.partition_point(|n| *n < self.slope_from)..]
    }
}

impl Case {
    /// The period of the experiments with `m` points: `T = s(m + 3)` samples.
    pub(crate) fn period(&self, points: usize) -> usize {
        self.spacing * (points + 3)
    }

    /// The working interval, which all borders share.
    pub(crate) fn interval(&self) -> Interval {
        self.borders[0].hysteresis.interval()
    }
}

impl Scenario {
    /// The file's stem; names the report folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the study is to answer.
    pub(crate) fn question(&self) -> &str {
        &self.question
    }

    /// The seed of every random stream.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// How many replicates each cell takes.
    pub(crate) fn replication(&self) -> Replication {
        self.replication
    }

    /// Replicates that every cell takes; more where a precision is asked for.
    pub fn replicates(&self) -> usize {
        self.replication.replicates
    }

    /// Whether the cells share their noise.
    pub fn coupling(&self) -> Coupling {
        self.coupling
    }

    /// How the replicates are computed.
    pub fn engine(&self) -> Engine {
        self.engine
    }

    /// The same scenario on another engine.
    #[must_use]
    pub fn on(self, engine: Engine) -> Self {
        Self { engine, ..self }
    }

    /// What the axes are called.
    pub(crate) fn labels(&self) -> &Labels {
        &self.labels
    }

    /// At least one.
    pub fn cases(&self) -> &[Case] {
        &self.cases
    }

    /// The grid.
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// The methods of others.
    pub fn foreign(&self) -> &[ForeignMethod] {
        &self.foreign
    }

    /// The same scenario with more methods of others.
    #[must_use]
    pub fn with_methods(mut self, more: impl IntoIterator<Item = ForeignMethod>) -> Self {
        self.foreign.extend(more);
        self
    }

    /// The same scenario with these methods of others, and no other method.
    #[must_use]
    pub fn of_methods(mut self, methods: impl IntoIterator<Item = ForeignMethod>) -> Self {
        self.foreign = methods.into_iter().collect();
        self.sweep.methods.clear();
        self
    }

    /// The same scenario with other noise.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// The file's content as written, for the results to echo.
    pub(crate) fn source(&self) -> &serde_json::Value {
        &self.source
    }
}
