//! The methods by name, and what each asks for.

use super::data::{PulseData, StepMean};
use super::fit::{PulseFit, PulseFitError};
use super::lanes::LaneControl;
use super::profile::{ErrorTerms, GroupSum};
use super::solution::Solution;
use super::{efficient, joint, linear_arx, memoryless, paper};

/// A method for pulse experiments, with its input.
#[derive(Debug, Clone, Copy)]
pub enum PulseMethod<'a> {
    /// The paper's estimator: one experiment and the step experiment at its satellite.
    Paper {
        /// The descendant or the ascendant experiment.
        experiment: &'a PulseData,
        /// Mean output held at its satellite.
        step: StepMean,
    },
    /// Both experiments, over-parameterised, with a constant column.
    Joint {
        /// The descendant experiment.
        descendant: &'a PulseData,
        /// The ascendant experiment.
        ascendant: &'a PulseData,
    },
    /// Rank-one constrained, at the Cramér–Rao bound.
    Efficient(&'a [&'a PulseData]),
    /// A linear ARX model.
    LinearArx(&'a [&'a PulseData]),
    /// A Hammerstein model with one static curve.
    Memoryless(&'a [&'a PulseData]),
}

impl PulseMethod<'_> {
    /// The estimate.
    ///
    /// # Errors
    /// [`PulseFitError`] if the experiments do not excite every parameter.
    pub fn fit(self) -> Result<PulseFit, PulseFitError> {
        Ok(self.solve()?.fit())
    }

    pub(crate) fn solve(self) -> Result<Solution, PulseFitError> {
        match self {
            Self::Paper { experiment, step } => paper::paper(experiment, step),
            Self::Joint { descendant, ascendant } => joint::joint(descendant, ascendant),
            Self::Efficient(experiments) => efficient::efficient(experiments),
            Self::LinearArx(experiments) => linear_arx::linear_arx(experiments),
            Self::Memoryless(experiments) => memoryless::memoryless(experiments),
        }
    }

    pub(super) fn experiments(&self) -> Vec<&PulseData> {
        match *self {
            Self::Paper { experiment, .. } => vec![experiment],
            Self::Joint { descendant, ascendant } => vec![descendant, ascendant],
            Self::Efficient(all) | Self::LinearArx(all) | Self::Memoryless(all) => all.to_vec(),
        }
    }

    fn step(&self) -> Option<StepMean> {
        match *self {
            Self::Paper { step, .. } => Some(step),
            _ => None,
        }
    }
}

/// A method linearised at its limit: the asymptotic theory, and the control variate of a Monte-Carlo study.
///
/// Made from expected statistics ([`crate::simulation::NoiseMoments::expected`]), where the method returns what it converges to. For a
/// record's statistics, [`Limit::first_order`] is
///
/// ```text
/// ∇g · M⁻¹s,   s = S_{Φy} − Sθ₀,   M = E[S]
/// ```
///
/// which has mean zero exactly, and differs from the estimate's error by `O(1/N)`: subtracted, it takes the noise out of a bias. Where the
/// equation error is white its variance is [`Limit::theory_se`] squared, exactly.
#[derive(Debug, Clone)]
pub struct Limit {
    solution: Solution,
    fit: PulseFit,
    samples: f64,
}

impl Limit {
    /// Linearises a method at the statistics given.
    ///
    /// # Errors
    /// [`PulseFitError`] if they do not determine every parameter.
    pub fn of(expected: PulseMethod<'_>) -> Result<Self, PulseFitError> {
        let solution = expected.solve()?;
        let fit = solution.fit();
        let samples = expected.experiments()[0].statistics.samples();
        Ok(Self { solution, fit, samples })
    }

    /// What the method converges to; standard errors are for as many samples as the expected statistics had.
    pub fn fit(&self) -> &PulseFit {
        &self.fit
    }

    /// Asymptotic standard errors of `a`, `b`, then the points of each border, for `samples` samples of each experiment:
    /// the square roots of `∇g (σ²M⁻¹/N) ∇gᵀ`. `O(1/S)` off for expected statistics of `S` samples, so take `S` large.
    pub fn theory_se(&self, samples: f64) -> Vec<f64> {
        let scale = (self.samples / samples).sqrt();
        self.fit.parameters().map(|x| x.se * scale).collect()
    }

    /// [`Limit::first_order`] for eight replicates at a time.
    pub fn lanes(&self) -> LaneControl {
        self.solution.control(self.samples)
    }

    /// The first-order part of the error of the same method's estimate from `sample`: `a`, `b`, then the points of each border.
    pub fn first_order(&self, sample: &PulseMethod<'_>) -> Vec<f64> {
        let experiments = sample.experiments();
        self.solution.first_order(&experiments, sample.step(), self.scale(&experiments))
    }

    /// The part of the second order that the profile score holds, in the same order.
    pub fn second_order(&self, sample: &PulseMethod<'_>) -> Vec<f64> {
        let experiments = sample.experiments();
        self.solution.second_order(&experiments, self.scale(&experiments))
    }

    /// The exact means of both over all noise, to be subtracted from them.
    ///
    /// `expected` holds the expectations of the statistics over as many samples as a record has
    /// ([`crate::simulation::NoiseMoments::expected_over`]), and `covariance` is that of two of their group sums
    /// ([`crate::simulation::SumCovariance`]).
    pub fn mean_terms(
        &self,
        expected: &PulseMethod<'_>,
        covariance: impl Fn(GroupSum, GroupSum) -> f64,
    ) -> ErrorTerms {
        let experiments = expected.experiments();
        self.solution.mean_terms(&experiments, expected.step(), self.scale(&experiments), &covariance)
    }

    /// How many of these records the expected statistics hold.
    fn scale(&self, experiments: &[&PulseData]) -> f64 {
        self.samples / experiments[0].statistics.samples()
    }
}
