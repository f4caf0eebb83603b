//! The methods by name, and what each asks for.

use super::data::{PulseData, StepMean};
use super::experiments::Experiments;
use super::fit::{PulseFit, PulseFitError};
use super::grouped::GroupedStatistics;
use super::instrumental::{FoldedSolution, KnownColour, instrumental};
use super::lanes::LaneControl;
use super::layout::Layout;
use super::score::{ErrorTerms, GroupSum};
use super::solution::{Level, Solution};
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
    /// Refined instrumental variables on the folds: consistent whatever the colour of the noise.
    Instrumental(&'a [&'a PulseData]),
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
    ///
    /// # Panics
    /// If no experiment is given.
    pub fn fit(self) -> Result<PulseFit, PulseFitError> {
        Ok(self.solve()?.fit())
    }

    /// The estimate and the covariance of its [parameters](PulseFit::parameters), row by row (delta method, white equation error but for
    /// [`Self::Instrumental`], which takes the noise's colour from the data).
    ///
    /// # Errors
    /// As [`Self::fit`].
    pub fn fit_with_covariance(self) -> Result<(PulseFit, Vec<Vec<f64>>), PulseFitError> {
        let solution = self.solve()?;
        Ok((solution.fit(), solution.covariance()))
    }

    pub(crate) fn solve(self) -> Result<Solved, PulseFitError> {
        let solution = match self {
            Self::Instrumental(experiments) => {
                return instrumental(experiments, None).map(|solution| Solved::Folds(Box::new(solution)));
            }
            Self::Efficient(experiments) => efficient::efficient(experiments),
            Self::Paper { experiment, step } => {
                self.regression(&[&experiment.about(step.mean)], Level::Step(step))
            }
            Self::Joint { .. } | Self::LinearArx(_) | Self::Memoryless(_) => {
                self.regression(&self.experiments(), Level::Constant)
            }
        };
        solution.map(|solution| Solved::Regression(Box::new(solution)))
    }

    fn regression(&self, data: &[&PulseData], level: Level) -> Result<Solution, PulseFitError> {
        let experiments = Experiments::new(data);
        Solution::of(&experiments, self.layout(&experiments), level)
    }

    /// The regression of the method; of one that iterates, the regression that it starts from.
    pub(super) fn layout(&self, experiments: &Experiments<'_>) -> Layout {
        match self {
            Self::Paper { .. } => paper::layout(experiments),
            Self::Joint { .. } | Self::Efficient(_) | Self::Instrumental(_) => joint::layout(experiments),
            Self::LinearArx(_) => linear_arx::layout(experiments),
            Self::Memoryless(_) => memoryless::layout(experiments),
        }
    }

    pub(super) fn experiments(&self) -> Vec<&PulseData> {
        match *self {
            Self::Paper { experiment, .. } => vec![experiment],
            Self::Joint { descendant, ascendant } => vec![descendant, ascendant],
            Self::Efficient(all) | Self::Instrumental(all) | Self::LinearArx(all) | Self::Memoryless(all) => {
                all.to_vec()
            }
        }
    }

    fn step(&self) -> Option<StepMean> {
        match *self {
            Self::Paper { step, .. } => Some(step),
            Self::Joint { .. }
            | Self::Efficient(_)
            | Self::Instrumental(_)
            | Self::LinearArx(_)
            | Self::Memoryless(_) => None,
        }
    }
}

/// A solved method: a regression over groups, or the folds.
#[derive(Debug, Clone)]
pub(crate) enum Solved {
    Regression(Box<Solution>),
    Folds(Box<FoldedSolution>),
}

impl Solved {
    /// The estimate with its standard errors.
    pub(crate) fn fit(&self) -> PulseFit {
        match self {
            Self::Regression(solution) => solution.fit(),
            Self::Folds(solution) => solution.fit(),
        }
    }

    fn covariance(&self) -> Vec<Vec<f64>> {
        match self {
            Self::Regression(solution) => solution.covariance(),
            Self::Folds(solution) => solution.covariance(),
        }
    }
}

/// How much of the second order of an estimate's error is worked out: see [`Limit`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondOrder {
    /// All of it. Its mean is known where the model holds ([`Limit::finite_sample`]).
    Whole,
    /// What the elimination of the free means makes. Its mean is known for any noise and model ([`Limit::mean_terms`]).
    Profile,
}

/// A method expanded about its limit: theory at a number of samples, and the control variate of a Monte-Carlo study.
///
/// Made from the expected statistics of records of `N` samples ([`crate::simulation::NoiseMoments::expected_over`]), where the method
/// returns what it converges to. For the statistics of such a record, [`Limit::terms`] are the leading terms of the estimate's error,
///
/// ```text
/// first             ∇g · M⁻¹s,         s = S_{Φy} − Sθ₀,   M = E[S]
/// second, whole     half the second derivative of the estimate along the deviation of the statistics from their means
/// second, profile   ∇g · M⁻¹(p − s),   p the profile score: s with every free mean eliminated by the record's own statistics
/// ```
///
/// All have means that are known exactly at every `N`. Taken out of the error with their means left in, they take the noise out of its
/// mean, the bias. Where the model holds and the equation error is white, the first has mean zero and the variance of
/// [`Limit::first_order_sd`], exactly; the mean of the whole second is [`FiniteSampleTheory::bias`](super::FiniteSampleTheory), and
/// after both the rest is `O(N^(−3/2))`.
///
/// Where the model does not hold, the mean of the whole second order would ask for fourth moments of coloured noise. After the first the
/// rest is then `O(1/N)`; what is largest in it grows with the number `Q` of free means as `√Q/N`: products `Σ_q K_q ē_q,i ξ̄_q` of the noise
/// of a group's mean output and of its mean equation error. These the profile score holds, and it is quadratic in the noise, so that its
/// mean is one of products of two group sums.
///
/// The free means are nuisance parameters, and the profile score has a mean because of them: McCullagh and Tibshirani, "A simple method for
/// the adjustment of profile likelihoods", Journal of the Royal Statistical Society B 52 (1990), 325–344, subtract it too.
/// [`PulseMethod::Instrumental`] is linear in the means over periods to first order, whose expectations are the noise-free response at every `N`: both
/// its first term and its mean, zero, are exact for noise of any colour; its second is left out.
///
/// Control variates: Glasserman, "Monte Carlo Methods in Financial Engineering" (2003), section 4.1.
#[derive(Debug, Clone)]
pub struct Limit {
    pub(super) solution: Solved,
    fit: PulseFit,
    /// What it was made from, about the solution's reference.
    expected: GroupedStatistics,
    pub(super) samples: f64,
}

impl Limit {
    /// Linearises a method at the statistics given.
    ///
    /// # Errors
    /// [`PulseFitError`] if they do not determine every parameter.
    pub fn of(expected: PulseMethod<'_>) -> Result<Self, PulseFitError> {
        let solution = expected.solve()?;
        let fit = solution.fit();
        let experiments = expected.experiments();
        let samples = experiments[0].statistics.samples();
        let (solution, expected) = match solution {
            Solved::Folds(solution) => {
                let none = GroupedStatistics::new(experiments[0].order(), 0);
                (Solved::Folds(Box::new(solution.with_responses())), none)
            }
            Solved::Regression(solution) => {
                let expected = solution.about_own(&experiments);
                (Solved::Regression(solution), expected)
            }
        };
        Ok(Self { solution, fit, expected, samples })
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

    /// [`Limit::of`] [`PulseMethod::Instrumental`] on these experiments, had it been reported the law of the output's noise, `sigma·C/D w` with `w` unit
    /// white; `ar` holds `d₁…` and `ma` holds `c₁…`.
    ///
    /// Its [theory](Limit::theory_se) is the Cramér–Rao bound of Gaussian noise whose colour is known, or unknown but nothing to do with the
    /// parameters: `(Σ_k ∂Z_k ∂Z_k* / S(ω_k))⁻¹`.
    ///
    /// # Errors
    /// As [`Limit::of`].
    pub fn of_known_colour(
        experiments: &[&PulseData],
        (ar, ma): (&[f64], &[f64]),
        sigma: f64,
    ) -> Result<Self, PulseFitError> {
        let solution = instrumental(experiments, Some(KnownColour { ar, ma, sigma }))?;
        let (fit, samples) = (solution.fit(), experiments[0].statistics.samples());
        let expected = GroupedStatistics::new(experiments[0].order(), 0);
        Ok(Self { solution: Solved::Folds(Box::new(solution.with_responses())), fit, expected, samples })
    }

    /// The exact standard deviations of the first term over records of `N` samples, given the covariance of two means over periods by their
    /// phases; `None` of a method that is not linear in these means.
    pub fn fold_sd(&self, covariance: impl Fn(usize, usize) -> f64) -> Option<Vec<f64>> {
        match &self.solution {
            Solved::Regression(_) => None,
            Solved::Folds(solution) => Some(solution.first_order_sd(covariance)),
        }
    }

    /// [`Limit::terms`] for eight replicates at a time.
    pub fn lanes(&self, second: SecondOrder) -> LaneControl {
        match (&self.solution, second) {
            (Solved::Regression(solution), SecondOrder::Whole) => {
                LaneControl::whole(solution, &self.expected)
            }
            (Solved::Regression(solution), SecondOrder::Profile) => LaneControl::profile(solution),
            (Solved::Folds(solution), _) => LaneControl::folds(solution.control()),
        }
    }

    /// The leading terms of the error of the same method's estimate from `sample`, a record of as many samples as the expected statistics.
    pub fn terms(&self, sample: &PulseMethod<'_>, second: SecondOrder) -> ErrorTerms {
        let whole = match second {
            SecondOrder::Whole => Some(&self.expected),
            SecondOrder::Profile => None,
        };
        match &self.solution {
            Solved::Regression(solution) => solution.terms(&sample.experiments(), sample.step(), whole),
            Solved::Folds(solution) => {
                let first = solution.first_order(&sample.experiments());
                ErrorTerms { second: vec![0.0; first.len()], first }
            }
        }
    }

    /// The exact means of [`Limit::terms`] with [`SecondOrder::Profile`] over all noise, Gaussian or not.
    ///
    /// `expected` holds the expectations of the statistics over as many samples as a record has
    /// ([`crate::simulation::NoiseMoments::expected_over`]), and `covariance` is that of two of their group sums
    /// ([`crate::simulation::SumCovariance`]).
    pub fn mean_terms(
        &self,
        expected: &PulseMethod<'_>,
        covariance: impl Fn(GroupSum, GroupSum) -> f64,
    ) -> ErrorTerms {
        match &self.solution {
            Solved::Regression(solution) => {
                solution.mean_terms(&expected.experiments(), expected.step(), &covariance)
            }
            Solved::Folds(_) => self.terms(expected, SecondOrder::Profile),
        }
    }
}
