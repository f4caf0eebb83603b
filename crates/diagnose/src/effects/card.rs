//! The card of an effect: what the diagnosis knows about it beside its laws.

use super::{Scene, Variant};
use crate::effect::{Effect, Stage};
use crate::fitted_parameter::FittedParameter;
use crate::likelihood::engine::Fit;
use crate::records::dataset::Dataset;

/// Everything about one effect. A card says what is special about its effect; [`Card::of`] has the rest.
///
/// What a flag changes in a diagnosis stands beside it, with the module that asks.
pub(crate) struct Card {
    /// Where in the block diagram it sits.
    pub(crate) stage: Stage,
    /// The laws that make sense on a scene's records, each with its starts and bounds; none where the records rule the effect out.
    pub(crate) laws: fn(&Scene<'_>) -> Vec<Variant>,
    /// The effects that leave nearly the same trace in ordinary records. They are never looked for beside it, and the verdict names them
    /// together with it, as one class (`attribution`, `verdict`).
    pub(crate) confounded_effects: &'static [Effect],

    /// It changes the noise only, and so no simulation; where models are compared by their simulations it is no candidate (`attribution`,
    /// `diagnose`, `verdict`).
    pub(crate) noise: bool,
    /// It gives the noise a spectrum of any shape. Another effect of the dynamics may hide behind such noise; where a gap remains with it,
    /// another cause is likely (`attribution::pairs`, `diagnose`).
    pub(crate) colours_noise: bool,
    /// It makes rare large errors. Such errors also describe what any inexact law misses occasionally, so that they are a cause only where they
    /// do not depend on the input (`attribution::pairs`, `diagnose`).
    pub(crate) heavy_tails: bool,
    /// Its errors pass through the dynamics and last. Even the simulation of the right model then misses the output, so that the effect need
    /// not close the gap on held-out records (`diagnose::held_out`).
    pub(crate) errors_last: bool,
    /// The sensor distorts an output that the model has right. No law of a sensor is exact, so that a second effect beside it must improve
    /// held-out records (`diagnose::degradation`).
    pub(crate) misreads: bool,
    /// The sensor rounds. Where its steps are coarse the tests see nothing else, and simulations are as good without it (`diagnose`).
    pub(crate) rounds: bool,
    /// It depends on time, or on a phase that differs from record to record: its fitted parameters need not hold in other records (`diagnose`).
    pub(crate) of_its_record: bool,

    /// It may hide the dynamics altogether, so that they are identified anew together with it (`attribution::successive_halving`).
    pub(crate) dominates_dynamics: bool,
    /// It may describe the remaining error of another effect whose law is inexact. Where it gains little beside that effect it is a correction
    /// and no cause (`attribution::pairs`).
    pub(crate) follows: Option<Follows>,
    /// It describes the remaining error of any inexact law, so that it is not looked for as a second effect (`attribution::pairs`).
    pub(crate) catch_all: bool,
    /// It is a property of the border grid: its law is to place knots from the data. Where it is no candidate no knots are placed
    /// (`attribution`, `diagnose::nominal`).
    pub(crate) lies_in_the_grid: bool,
    /// Which larger nominal model can describe it. That model is tried before the effect is named (`diagnose::refit`).
    pub(crate) room: Option<Room>,

    /// Whether a fit of it describes coloured noise and nothing else (`attribution::explain`).
    pub(crate) is_noise_in_disguise: fn(&Fit) -> bool,
    /// A law with more freedom, from where a fit by one of [`Self::laws`] ended (`attribution::search`).
    pub(crate) freed: fn(&Dataset, &Fit) -> Option<Variant>,

    /// Nonlinear parameters that reports call otherwise: their name in the law, and in reports (`diagnose::parameters`).
    pub(crate) renamed: &'static [(&'static str, &'static str)],
    /// Quantities that a user would measure, reported before the fitted parameters: taken from the data or the fit, or derived from the
    /// parameters (`diagnose::parameters`).
    pub(crate) reported_first: fn(&Reading<'_>) -> Vec<FittedParameter>,
}

/// Which remaining error of another effect an effect may describe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Follows {
    /// That of any law.
    Anything,
    /// The steps of a sensor that rounds so coarsely that the tests see nothing else. On sixty simulated rigs that only round, these effects gain
    /// up to 0.7 of deviance a sample, all others 0.013 at most.
    Steps,
}

/// In what a larger nominal model is larger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Room {
    /// Its order.
    Order,
    /// Its delay.
    Delay,
}

impl Card {
    /// The card of an effect about which nothing is special.
    pub(super) const fn of(stage: Stage, laws: fn(&Scene<'_>) -> Vec<Variant>) -> Self {
        Self {
            stage,
            laws,
            confounded_effects: &[],
            noise: false,
            colours_noise: false,
            heavy_tails: false,
            errors_last: false,
            misreads: false,
            rounds: false,
            of_its_record: false,
            dominates_dynamics: false,
            follows: None,
            catch_all: false,
            lies_in_the_grid: false,
            room: None,
            is_noise_in_disguise: |_| false,
            freed: |_, _| None,
            renamed: &[],
            reported_first: |_| Vec::new(),
        }
    }
}

/// What an effect's parameters are read off.
pub(crate) struct Reading<'a> {
    pub(crate) dataset: &'a Dataset,
    pub(crate) fit: &'a Fit,
    /// The effect's nonlinear parameters as they were searched for.
    pub(crate) searched: &'a [FittedParameter],
}

impl Reading<'_> {
    /// A level of the output.
    pub(super) fn level(&self, name: &'static str, y: f64) -> FittedParameter {
        known(name, "output units", self.dataset.y_mean + self.dataset.y_scale * y)
    }

    /// A difference of two outputs.
    pub(super) fn step(&self, name: &'static str, y: f64) -> FittedParameter {
        known(name, "output units", self.dataset.y_scale * y)
    }
}

/// A parameter that nothing searches for: it has no interval.
pub(super) fn known(name: &'static str, unit: &'static str, value: f64) -> FittedParameter {
    FittedParameter { name, unit, value, ci90: [f64::NAN; 2] }
}
