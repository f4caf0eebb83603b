//! What a pair of pulse experiments will be worth, before they are taken.

use super::{NoiseMoments, PeriodicDesign, periodic_response, superpose};
use crate::excitation::PulseExperiment;
use crate::pulse::{Limit, PulseData, PulseFit, PulseFitError, PulseMethod};
use switchback_model::hysteresis::SwitchedHysteresis;
use switchback_model::linear::LinearSystem;

/// Samples that stand for endless data: terms of order `1/N` vanish beside 1e-9.
const ENDLESS: f64 = 1e12;

/// Standard errors of a method on a descendant and an ascendant experiment, from the asymptotic covariance:
///
/// ```text
/// se(θ) = √(∇g (σ²M⁻¹/N) ∇gᵀ),   M = E[ΦΦᵀ] of the stationary experiment on the system given
/// ```
///
/// `M` is exact: the noise-free part from the periodic response, the noise from its autocovariances. The equation error is white with
/// standard deviation `σ`, output units; `N` are the samples of each experiment that enter the regression. Parameters are in the
/// normalisation `u_M − u_m = 1`.
///
/// ```
/// use switchback_identify::excitation::Dataset;
/// use switchback_model::hysteresis::{Interval, LeafSpring, SwitchedHysteresis};
/// use switchback_model::linear::LinearSystem;
/// use switchback_identify::simulation::PlannedPrecision;
/// let interval = Interval::new(-1.0, 1.0)?;
/// let spring = SwitchedHysteresis::new(interval, Box::new(LeafSpring::constant(0.3, 0.2)?))?;
/// let system = LinearSystem::new(vec![-1.2, 0.5], vec![0.4, 0.2])?;
/// let plan = Dataset::new(interval, 2, 4, 50)?;
/// let precision = PlannedPrecision::efficient(&system, &spring, plan.pulses(), 0.1)?;
/// // Four times the samples halve every error.
/// let (short, long) = (precision.at(1e3).worst(), precision.at(4e3).worst());
/// assert!((short / long - 2.0).abs() < 1e-12);
/// assert!((precision.rows_for(short) - 1e3).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct PlannedPrecision {
    limit: Limit,
}

/// Predicted standard errors, laid out as the estimate will be.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedErrors {
    /// Of `a₁…aₙ`.
    pub a: Vec<f64>,
    /// Of `b₁…bₙ`, output units.
    pub b: Vec<f64>,
    /// Of the points of the descending border, in the order of their visits, as shares of `u_M − u_m`.
    pub descending: Vec<f64>,
    /// Of the points of the ascending border, likewise.
    pub ascending: Vec<f64>,
}

impl PredictedErrors {
    /// The largest of both borders' points.
    pub fn worst(&self) -> f64 {
        largest(&self.descending).max(largest(&self.ascending))
    }

    /// All of them in one fixed order: `a`, `b`, descending, ascending.
    pub fn all(&self) -> impl Iterator<Item = f64> + '_ {
        [&self.a, &self.b, &self.descending, &self.ascending].into_iter().flatten().copied()
    }
}

fn largest(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

impl PlannedPrecision {
    /// Of the efficient method, which reaches the Cramér–Rao bound.
    ///
    /// # Errors
    /// [`PulseFitError`] if the experiments do not excite every parameter.
    pub fn efficient(
        system: &LinearSystem,
        hysteresis: &SwitchedHysteresis,
        experiments: &[PulseExperiment; 2],
        sigma: f64,
    ) -> Result<Self, PulseFitError> {
        let [descendant, ascendant] = endless(system, hysteresis, experiments, sigma);
        Ok(Self { limit: Limit::of(PulseMethod::Efficient(&[&descendant, &ascendant]))? })
    }

    /// Of the joint method, over-parameterised.
    ///
    /// # Errors
    /// [`PulseFitError`] if the experiments do not excite every parameter.
    pub fn joint(
        system: &LinearSystem,
        hysteresis: &SwitchedHysteresis,
        experiments: &[PulseExperiment; 2],
        sigma: f64,
    ) -> Result<Self, PulseFitError> {
        let [descendant, ascendant] = endless(system, hysteresis, experiments, sigma);
        let method = PulseMethod::Joint { descendant: &descendant, ascendant: &ascendant };
        Ok(Self { limit: Limit::of(method)? })
    }

    /// What the method will converge to: the system planned for.
    pub fn fit(&self) -> &PulseFit {
        self.limit.fit()
    }

    /// The standard errors where `rows` samples of each experiment enter the regression.
    pub fn at(&self, rows: f64) -> PredictedErrors {
        let fit = self.limit.fit();
        let mut errors = self.limit.theory_se(rows).into_iter();
        let mut take = |count| errors.by_ref().take(count).collect();
        PredictedErrors {
            a: take(fit.a.len()),
            b: take(fit.b.len()),
            descending: take(fit.borders[0].len()),
            ascending: take(fit.borders[1].len()),
        }
    }

    /// The samples of each experiment at which the worst border point has the standard error `worst`.
    pub fn rows_for(&self, worst: f64) -> f64 {
        (self.at(1.0).worst() / worst).powi(2)
    }
}

/// The expected statistics of both experiments, about the mean of their noise-free outputs, to keep digits.
fn endless(
    system: &LinearSystem,
    hysteresis: &SwitchedHysteresis,
    experiments: &[PulseExperiment; 2],
    sigma: f64,
) -> [PulseData; 2] {
    let order = system.order();
    let designs = [0, 1].map(|k| PeriodicDesign::new(&experiments[k], hysteresis, order));
    let responses = [0, 1].map(|k: usize| periodic_response(system, &designs[k].u));
    let reference = system.static_gain() * (hysteresis.u_low() + hysteresis.u_high()) / 2.0;
    [0, 1].map(|k: usize| {
        let noise = NoiseMoments::expected(system.a(), &[], order, designs[k].period(), ENDLESS);
        let about: Vec<f64> = responses[k].iter().map(|z| z - reference).collect();
        let data = superpose(&designs[k], &about, sigma, &noise);
        PulseData { reference, ..data }
    })
}
