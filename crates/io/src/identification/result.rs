//! What a method made of a rig, and what other models and the residuals say of it.

use super::baseline::Baseline;
use super::flag::Flag;
use super::found::Found;
use super::free_run::FreeRun;
use switchback_identify::free::InputNoise;
use switchback_identify::statistics::Whiteness;
use switchback_identify::{BorderDistance, Estimate, LevelErrors, Method};

/// What a method made of a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// The method used.
    pub method: Method,
    /// The system it found.
    pub estimate: Estimate,
    /// Standard errors of the gain and the stationary outputs; none if a parameter has no information.
    pub level_errors: Option<LevelErrors>,
    /// Free-run simulation of every record, in the order of the rig; none where the record needs a border that the method
    /// does not see.
    pub runs: Vec<Option<FreeRun>>,
    /// How far the borders lie apart against their errors; none where the method does not see both.
    pub distance: Option<BorderDistance>,
    /// By how much noise on the input moves the estimate; none where none was found, or the method does not ask.
    pub input_noise: Option<InputNoise>,
    /// Why the model could not run in real time; empty if it could.
    pub obstacles: Vec<String>,
    /// What the reader must know before trusting the figures, weightiest first.
    pub flags: Vec<Flag>,
    /// What other models and the residuals say, once it was asked for.
    pub examination: Examination,
    /// The same system as a model that runs on its own; none where it cannot run.
    pub model: Option<Found>,
}

impl Identification {
    /// Whether the method found points of a border.
    pub fn has_borders(&self) -> bool {
        !(self.estimate.descending.is_empty() && self.estimate.ascending.is_empty())
    }

    /// Whether both borders are the same curve, as in the baselines that know no hysteresis.
    pub fn has_one_curve(&self) -> bool {
        self.estimate.descending == self.estimate.ascending
    }
}

/// What other models and the residuals say of an identification.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Examination {
    /// Simpler models on the held-out records.
    pub baselines: Vec<Baseline>,
    /// The best model that could run in real time, where this one could not and something is held out to compare them.
    pub causal: Option<CausalAlternative>,
    /// How white the innovations are over the fit records.
    pub innovations: Option<Whiteness>,
}

/// The best model that could run in real time, beside one that could not.
#[derive(Debug, Clone, PartialEq)]
pub struct CausalAlternative {
    /// The model, as `--causal` gives it.
    pub identification: Box<Identification>,
    /// How both simulate the held-out records; `None` if nothing is held out.
    pub held_out: Option<Baseline>,
}
