//! Standard errors against the length of a dataset.

use super::{DesignError, Truth};
use schemars::JsonSchema;
use switchback_identify::excitation::PulseExperiment;
use switchback_identify::simulation::{PlannedPrecision, PredictedErrors};

/// Fewest periods planned for a precision. On the machines of the example `design_precision`, achieved over predicted errors (root mean
/// square over parameters) are off by up to 8 % at three periods and by less than 5 % from ten on. The free records of a shorter dataset
/// would also be too short to be of use.
pub(crate) const RELIABLE_PERIODS: usize = 10;

/// The method that will identify from the planned experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema)]
#[schemars(rename_all = "kebab-case")]
pub enum PlanMethod {
    /// What `identify` takes where both experiments are there; it reaches the Cramér–Rao bound.
    Efficient,
    /// The over-parameterised regression on both experiments.
    Joint,
}

impl PlanMethod {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Efficient, Self::Joint];

    /// The method of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Its name, as `identify --method` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Efficient => "efficient",
            Self::Joint => "joint",
        }
    }
}

/// The precision of a pair of pulse experiments as a function of their length.
#[derive(Debug, Clone)]
pub struct Forecast {
    precision: PlannedPrecision,
    method: PlanMethod,
    order: usize,
    pulses: [PulseExperiment; 2],
}

/// What is predicted for one length.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Periods of each pulse experiment.
    pub periods: usize,
    /// `N`, samples of each.
    pub samples: usize,
    /// The standard errors.
    pub errors: PredictedErrors,
}

impl Forecast {
    /// Predicts for the experiments given, on the system identified.
    ///
    /// # Errors
    /// [`DesignError::NotExcited`] if they cannot identify it.
    pub fn new(
        truth: &Truth,
        pulses: &[PulseExperiment; 2],
        method: PlanMethod,
    ) -> Result<Self, DesignError> {
        let predict = match method {
            PlanMethod::Efficient => PlannedPrecision::efficient,
            PlanMethod::Joint => PlannedPrecision::joint,
        };
        let precision = predict(&truth.system, &truth.hysteresis, pulses, truth.noise_sd)
            .map_err(|source| DesignError::NotExcited { method: method.name(), source })?;
        Ok(Self { precision, method, order: truth.system.order(), pulses: pulses.clone() })
    }

    /// The method predicted for.
    pub(crate) fn method(&self) -> PlanMethod {
        self.method
    }

    /// The system planned for, in the normalisation `u_M − u_m = 1`: `a`, `b` and the borders' points.
    pub(crate) fn planned(&self) -> &switchback_identify::pulse::PulseFit {
        self.precision.fit()
    }

    /// The levels of the descendant and of the ascendant experiment, in the order of the predicted errors.
    pub(crate) fn levels(&self) -> [&[f64]; 2] {
        [self.pulses[0].levels(), self.pulses[1].levels()]
    }

    /// The prediction for experiments of some periods. A regression on `n` lags starts `n` samples late.
    pub fn at(&self, periods: usize) -> Prediction {
        let samples = periods * self.pulses[0].period();
        Prediction { periods, samples, errors: self.precision.at((samples - self.order) as f64) }
    }

    /// The fewest periods, [`RELIABLE_PERIODS`] at least, with which no border point's standard error exceeds `worst`, a share of
    /// `u_M − u_m`.
    pub fn periods_for(&self, worst: f64) -> usize {
        let rows = self.precision.rows_for(worst);
        // What does not fit into the type is refused later, as too long.
        let periods = ((rows + self.order as f64) / self.pulses[0].period() as f64).ceil() as usize;
        periods.max(RELIABLE_PERIODS)
    }
}
