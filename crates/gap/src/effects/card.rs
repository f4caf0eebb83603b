//! The card of an effect: what the diagnosis knows about it beside its laws.

use super::{Scene, Variant};
use crate::diagnosis::FittedParameter;
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::Fit;
use crate::records::campaign::Campaign;

/// Everything about one effect. A card says what is special about its effect; [`Card::of`] has the rest.
///
/// What a flag changes in a diagnosis stands beside it, with the module that asks.
pub(crate) struct Card {
    /// Where in the block diagram it sits.
    pub(crate) stage: Stage,
    /// The laws that make sense on a scene's records, each with its starts and bounds; none where the records rule the effect out.
    pub(crate) laws: fn(&Scene<'_>) -> Vec<Variant>,
    /// The effects that leave nearly the same trace in ordinary records: no second beside it, told with it as one class
    /// (`attribution`, `verdict`).
    pub(crate) twins: &'static [Effect],

    /// It changes only what is random: it moves no simulation error, and no candidate of a simulator (`attribution`, `diagnose`, `verdict`).
    pub(crate) noise: bool,
    /// It gives the noise a spectrum of any shape: behind it may hide whatever else rules the dynamics, and where it leaves something it stands
    /// in for another cause (`attribution::pairs`, `diagnose`, `verdict::odds`).
    pub(crate) colours_noise: bool,
    /// It makes rare large errors: they take what any inexact law misses now and then, and are a cause only where they come at no
    /// particular place of the input (`attribution::pairs`, `diagnose`).
    pub(crate) heavy_tails: bool,
    /// The errors that it makes last in the output, and a simulation by the right model keeps them: it need not close a gap on held-out
    /// records (`diagnose::held_out`).
    pub(crate) errors_last: bool,
    /// The sensor makes it of an output that is right: its laws are never exact, so a second effect beside it must show on held-out records
    /// (`diagnose::harm`).
    pub(crate) misreads: bool,
    /// The sensor rounds: to what else there is the tests are blind where steps are coarse, and a simulation is as good without it (`diagnose`).
    pub(crate) rounds: bool,
    /// It follows a clock or has a phase of its own in every record: what was fitted need not hold in other records (`diagnose`, `verdict::odds`).
    pub(crate) of_its_record: bool,

    /// Its laws are supple enough to imitate others but for a little (`verdict::odds`).
    pub(crate) supple: bool,
    /// It may leave nothing of what the dynamics are identified from, so that they are identified anew with it
    /// (`attribution::successive_halving`).
    pub(crate) dominates_dynamics: bool,
    /// It takes what an inexact law of another effect leaves: small beside that one, it is a correction and no cause
    /// (`attribution::pairs`).
    pub(crate) follows: Option<Follows>,
    /// It takes what any inexact law leaves: it is not looked for as a second effect like others (`attribution::pairs`).
    pub(crate) stopgap: bool,
    /// It is the border grid itself: knots placed from the data are its law, and where it is no candidate none follow details
    /// (`attribution`, `diagnose::nominal`).
    pub(crate) lies_in_the_grid: bool,
    /// Which larger nominal model has room for it: told, that one is tried before the effect is believed (`diagnose::refit`).
    pub(crate) room: Option<Room>,
    /// Fraction of the gap, one step ahead, that it leaves at most where it is the cause, whatever rivals are behind it. Fitted to made rigs with
    /// known causes, law mismatch included (`verdict::odds`).
    pub(crate) most_left: f64,

    /// Whether a fit of it is but the colour of the noise under another name (`attribution::explain`).
    pub(crate) is_noise_in_disguise: fn(&Fit) -> bool,
    /// A law with more freedom, from where a fit by one of [`Self::laws`] ended (`attribution::search`).
    pub(crate) freed: fn(&Campaign, &Fit) -> Option<Variant>,

    /// Nonlinear parameters that a user is told by another name, that of the law and the one told (`diagnose::parameters`).
    pub(crate) renamed: &'static [(&'static str, &'static str)],
    /// What a user would measure, told before the parameters that were searched for: read off the data or the fit, or
    /// derived from them (`diagnose::parameters`).
    pub(crate) told_first: fn(&Reading<'_>) -> Vec<FittedParameter>,
}

/// What an effect takes beside an inexact law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Follows {
    /// Whatever that misses.
    Anything,
    /// The steps of a rounding so coarse that the tests are blind. On sixty made rigs that only round, these effects gain up to 0.7 of deviance
    /// a sample, all others 0.013 at most.
    Steps,
}

/// What of a nominal model would be larger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Room {
    /// Its order.
    Order,
    /// Its delay.
    Delay,
}

/// Fraction of the gap that causes in general leave at most.
const MOST_LEFT: f64 = 0.45;

impl Card {
    /// The card of an effect about which nothing is special.
    pub(super) const fn of(stage: Stage, laws: fn(&Scene<'_>) -> Vec<Variant>) -> Self {
        Self {
            stage,
            laws,
            twins: &[],
            noise: false,
            colours_noise: false,
            heavy_tails: false,
            errors_last: false,
            misreads: false,
            rounds: false,
            of_its_record: false,
            supple: false,
            dominates_dynamics: false,
            follows: None,
            stopgap: false,
            lies_in_the_grid: false,
            room: None,
            most_left: MOST_LEFT,
            is_noise_in_disguise: |_| false,
            freed: |_, _| None,
            renamed: &[],
            told_first: |_| Vec::new(),
        }
    }
}

/// What an effect's parameters are read off.
pub(crate) struct Reading<'a> {
    pub(crate) campaign: &'a Campaign,
    pub(crate) fit: &'a Fit,
    /// The effect's nonlinear parameters as they were searched for.
    pub(crate) searched: &'a [FittedParameter],
}

impl Reading<'_> {
    /// A level of the output.
    pub(super) fn level(&self, name: &'static str, y: f64) -> FittedParameter {
        known(name, "output units", self.campaign.y_mean + self.campaign.y_scale * y)
    }

    /// A difference of two outputs.
    pub(super) fn step(&self, name: &'static str, y: f64) -> FittedParameter {
        known(name, "output units", self.campaign.y_scale * y)
    }
}

/// A parameter that nothing searches for: it has no interval.
pub(super) fn known(name: &'static str, unit: &'static str, value: f64) -> FittedParameter {
    FittedParameter { name, unit, value, ci90: [f64::NAN; 2] }
}
