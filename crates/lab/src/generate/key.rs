//! What was put into a rig: the key that stays sealed until the diagnosis is done.

use crate::generate::law::{INTERVAL_WIDTHS, Nature, Stage};
use crate::generate::setting::Setting;
use switchback_model::hysteresis::Interval;

/// One effect that a rig was made with.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueEffect {
    /// Its name.
    pub effect: &'static str,
    /// Its law.
    pub law: &'static str,
    /// Whether this is the plain law (the first of the effect's).
    pub plain: bool,
    /// Where it acts.
    pub stage: Stage,
    /// Whether it moves the expected output.
    pub nature: Nature,
    /// Magnitude, in `unit`.
    pub magnitude: f64,
    /// What magnitude 1 means.
    pub unit: &'static str,
    /// What the magnitude is, where its unit does not say it.
    pub quantity: Option<&'static str>,
    /// Size that was asked for.
    pub wanted: f64,
    /// Size that it has by itself. In the laboratory what survives the best nominal re-fit, in noise sd; in the field what survives
    /// identification anew, over what the model of the machine without the effect leaves on held-out records ([`InjectedFault::size`]).
    ///
    /// [`InjectedFault::size`]: crate::generate::InjectedFault::size
    pub size: f64,
}

impl TrueEffect {
    /// The magnitude in input units, where it is a length along the input.
    pub fn length(&self, interval: Interval) -> Option<f64> {
        (self.unit == INTERVAL_WIDTHS).then(|| self.magnitude * interval.width())
    }
}

/// Everything withheld about a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// Seed that the rig came from.
    pub seed: u64,
    /// Order of the linear part.
    pub order: usize,
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// `b₁…bₙ`.
    pub b: Vec<f64>,
    /// Shape of the borders.
    pub borders: &'static str,
    /// Whether they are curved between the levels too.
    pub curved: bool,
    /// The working interval.
    pub interval: Interval,
    /// Standard deviation of the white equation error; where it is coloured, of its innovations.
    pub noise_sd: f64,
    /// Where the rig stands.
    pub setting: Setting,
    /// Names of the effects that the machine has by itself, before any is put in; empty in the laboratory. A diagnosis that names one of
    /// these is not wrong.
    pub base: Vec<&'static str>,
    /// The effects; none, one or more.
    pub effects: Vec<TrueEffect>,
    /// Size of all effects together, in the unit of [`TrueEffect::size`].
    pub size: f64,
}

/// What is true of one record, sample by sample: by this a diagnosis of *where* and *how far* is judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Name of the record.
    pub record: String,
    /// Output without noise, systematic effects included.
    pub repeating: Vec<f64>,
    /// What survives the best nominal re-fit, one step ahead: residual less the white equation error, in noise sd. In the field residual
    /// less that without the effects, in standard deviations of the latter. Zero before [`Truth::first`].
    pub surviving: Vec<f64>,
    /// First sample that the re-fit predicts.
    pub first: usize,
}
