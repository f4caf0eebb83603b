//! The small study that several checks run: a leaf spring, its designed experiments, one record length.

use miette::{IntoDiagnostic, miette};
use switchback_study::consistency::{Progress, run};
use switchback_study::results::Results;
use switchback_study::scenario::{Engine, Scenario};

/// What differs from check to check.
#[derive(Debug, Clone, Copy)]
pub(super) struct SmallStudy<'a> {
    /// Of its noise.
    pub(super) seed: u64,
    pub(super) replicates: usize,
    /// `N`.
    pub(super) samples: usize,
    pub(super) methods: &'a [&'a str],
    pub(super) engine: Engine,
}

/// Nobody watches.
struct Silent;

impl Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}

impl SmallStudy<'_> {
    /// Runs it.
    ///
    /// # Errors
    /// If the program refuses its own study.
    pub(super) fn run(&self) -> miette::Result<Results> {
        let Self { seed, replicates, samples, methods, engine } = self;
        let text = format!(
            r#"
study = "consistency"
question = "Does this machine compute what it should?"
seed = {seed}
replicates = {replicates}

[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-40.0, 40.0]
input = "deflection [mm]"
output = "load [kN]"

[[border]]
name = "hardening stiffness"
kind = "leaf_spring"
stiffness = 0.12
hardening = 6e-5
friction = 2.0

[sweep]
noise = [0.2]
samples = [{samples}]
points = [4]
methods = {methods:?}
"#
        );
        let scenario = Scenario::parse("selftest.toml", &text)?.on(*engine);
        let results = run(&scenario, "switchback selftest".to_owned(), &Silent).into_diagnostic()?;
        let failed: usize = results.cells.iter().map(|cell| cell.failures.count).sum();
        if failed > 0 {
            return Err(miette!("{failed} replicates of a well-posed study gave no estimate"));
        }
        Ok(results)
    }
}
