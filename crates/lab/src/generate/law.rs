//! What a law of an effect is: hooks along the block diagram.

use crate::generate::dataset::Passage;
use crate::generate::machine::Machine;
use rand_chacha::ChaCha8Rng;
use schemars::JsonSchema;
use std::fmt::Debug;

/// The unit of lengths along the input: shares of the working interval.
pub(crate) const INTERVAL_WIDTHS: &str = "interval widths";

/// Where in the block diagram an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum Stage {
    /// Between the commanded input and the operator.
    Input,
    /// In the hysteresis.
    Operator,
    /// In the linear part.
    Dynamics,
    /// In what else drives the output.
    Disturbance,
    /// Between the output and the record.
    Sensor,
}

impl Stage {
    /// The stage's name as reports write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Operator => "operator",
            Self::Dynamics => "dynamics",
            Self::Disturbance => "disturbance",
            Self::Sensor => "sensor",
        }
    }
}

/// Whether an effect moves the expected output or only the noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Nature {
    /// It moves the output that repeats: a perfect model of it closes the simulation gap.
    Systematic,
    /// It changes noise only: no model of it moves the simulation error.
    Noise,
}

/// How a law comes into records that were measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Injection {
    /// [`Law::sensor`] acts on the measured output: exact.
    Reading,
    /// A gain that changes slowly against the dynamics scales the output as it scales `u`: [`Law::dynamics`] acts on the measured output.
    Gain,
    /// The record of the input changes ([`Law::recording`]), the machine does not: exact.
    Recording,
    /// The difference between two simulations of a model of the machine, with the law and without, is added to the measured output.
    Carried,
}

impl Injection {
    /// Whether no model takes part.
    pub fn is_exact(self) -> bool {
        self != Self::Carried
    }

    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reading => "reading",
            Self::Gain => "gain",
            Self::Recording => "recording",
            Self::Carried => "carried",
        }
    }
}

/// How much of an effect, and which of its shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amount {
    /// Magnitude, in the law's [`Law::unit`]; zero means that the effect is absent.
    pub magnitude: f64,
    /// Four numbers, uniform on `[0, 1)`, that a law maps to whatever else it needs (a frequency, an onset, a mix).
    pub shape: [f64; 4],
}

impl Amount {
    /// Maps the `i`-th shape number linearly to `[low, high)`.
    pub fn between(&self, i: usize, low: f64, high: f64) -> f64 {
        low + (high - low) * self.shape[i]
    }

    /// +1 or −1 by the `i`-th shape number.
    pub fn sign(&self, i: usize) -> f64 {
        if self.shape[i] < 0.5 { -1.0 } else { 1.0 }
    }
}

/// What a hook may look at while it acts on one passage of the dataset.
#[derive(Debug)]
pub struct Scene<'a> {
    /// The nominal system.
    pub machine: &'a Machine,
    /// The record running, with its lead-in.
    pub passage: &'a Passage,
    /// How much of the effect.
    pub amount: Amount,
    /// The effect's own randomness in this passage; the same for every magnitude.
    pub rng: ChaCha8Rng,
}

impl Scene<'_> {
    /// Magnitude of the magnitude.
    pub fn x(&self) -> f64 {
        self.amount.magnitude
    }
}

/// One law of an effect.
///
/// A law acts through any of its hooks, each given the passage's signals, lead-in included. **With magnitude zero
/// every hook leaves its signal exactly as it was.** Laws compose: operator hooks add their deviation to `u`.
pub trait Law: Debug + Send + Sync {
    /// Name of the effect, as in `gap --json`, or of one that no library knows.
    fn effect(&self) -> &'static str;

    /// Name of this law of the effect.
    fn name(&self) -> &'static str;

    /// Where it acts.
    fn stage(&self) -> Stage;

    /// Whether it moves the expected output.
    fn nature(&self) -> Nature {
        Nature::Systematic
    }

    /// What magnitude 1 means.
    fn unit(&self) -> &'static str;

    /// Whether the magnitude counts standard deviations of the white equation error, and so has no meaning of its own.
    fn counts_noise(&self) -> bool {
        self.unit() == "noise sd"
    }

    /// What the magnitude is, where its unit does not say it.
    fn quantity(&self) -> Option<&'static str> {
        None
    }

    /// Largest magnitude that makes sense.
    fn limit(&self) -> f64;

    /// Smallest magnitude worth its name; below it, the rig is rather made noisier.
    fn least(&self) -> f64 {
        0.0
    }

    /// Variance of the one-step prediction error of a model that knows the effect, over that of the white equation error.
    ///
    /// 1 unless the effect itself raises what nobody could predict.
    fn oracle_variance(&self, _machine: &Machine, _amount: &Amount) -> f64 {
        1.0
    }

    /// How it comes into measured records.
    fn injection(&self) -> Injection {
        match self.stage() {
            Stage::Sensor => Injection::Reading,
            Stage::Input | Stage::Operator | Stage::Dynamics | Stage::Disturbance => Injection::Carried,
        }
    }

    /// What the record of the input shows, given the input that acts, so that the machine seems to have the effect
    /// ([`Injection::Recording`]).
    fn recording(&self, _scene: &mut Scene<'_>, _v: &mut [f64]) {}

    /// Input stage: from the commanded input to the one that arrives.
    fn drive(&self, _scene: &mut Scene<'_>, _v: &mut [f64]) {}

    /// Operator stage: `u` from the arriving `v` and the `u` so far.
    fn operator(&self, _scene: &mut Scene<'_>, _v: &[f64], _u: &mut [f64]) {}

    /// Dynamics stage: what lies between `u` and `B/A`.
    fn dynamics(&self, _scene: &mut Scene<'_>, _u: &mut [f64]) {}

    /// Disturbance stage: the equation error, given `u`.
    fn equation_error(&self, _scene: &mut Scene<'_>, _u: &[f64], _xi: &mut [f64]) {}

    /// What the difference equation has besides, from the last output.
    fn feedback(&self, _scene: &Scene<'_>, _y_before: f64) -> f64 {
        0.0
    }

    /// Sensor stage: from the output to the recorded one.
    fn sensor(&self, _scene: &mut Scene<'_>, _y: &mut [f64]) {}
}
