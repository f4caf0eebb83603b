//! Identification of a rig: which method, what it found, how well that simulates every record.

mod causal;
mod dispatch;
mod error;
mod errors_of_run;
mod examine;
mod flag;
mod free;
pub mod json;
mod method;
mod pulse;
mod request;
mod residuals;
mod simulate;
mod table;
mod yardstick;

pub use causal::CausalAlternative;
pub(crate) use causal::obstacles;
pub use dispatch::identify;
pub(crate) use dispatch::identify_watched;
pub use error::IdentificationError;
pub use examine::Examination;
#[cfg(test)]
pub(crate) use examine::examined;
pub use examine::examined_watched;
pub(crate) use flag::Flag;
pub use json::json;
pub use method::default_method;
pub use request::Request;
pub use simulate::EstimatedSystem;
pub use switchback_identify::Method;
pub use switchback_identify::free::fit_percent;
pub use table::table;
pub use yardstick::Yardstick;

use crate::model::{Curves, Points};
use switchback_identify::free::InputNoise;
use switchback_identify::{BorderDistance, Estimate, LevelErrors};
use switchback_model::rig::Rig;

/// A model by the kind of its method.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Of the methods for any record.
    Curves(Curves),
    /// Of the methods for pulse experiments.
    Points(Points),
}

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

    /// Whether both borders are the same curve, as in the yardsticks that know no hysteresis.
    pub fn has_one_curve(&self) -> bool {
        self.estimate.descending == self.estimate.ascending
    }
}

/// An identified system's simulation of one record, from the record's `v` alone once it has started.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeRun {
    /// One output a sample, output units; the measured ones before `start`.
    pub simulated: Vec<f64>,
    /// First sample that is simulated; those before it are the initial state.
    pub start: usize,
    /// [`fit_percent`] from `start` on.
    pub fit_percent: f64,
}

impl FreeRun {
    /// Judges a simulation against the measured output.
    pub(crate) fn new(measured: &[f64], simulated: Vec<f64>, start: usize) -> Self {
        let fit_percent = fit_percent(&measured[start..], &simulated[start..]);
        Self { simulated, start, fit_percent }
    }
}

/// The unit in a label, `N` in `force [N]`; empty where there is none.
pub fn unit(label: &str) -> &str {
    label.split_once('[').and_then(|(_, rest)| rest.split_once(']')).map_or("", |(unit, _)| unit.trim())
}

/// Whether nothing is held out, so that no fit figure proves anything.
fn lacks_holdout(rig: &Rig) -> bool {
    rig.holdout_records().next().is_none()
}

#[cfg(test)]
mod tests;
