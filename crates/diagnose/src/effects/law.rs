//! A law of an effect: a function from its nonlinear parameters to changes of an augmented model, and how it is searched.

use std::sync::Arc;

use crate::effect::Effect;
use crate::likelihood::engine::{Fit, NonlinearParameter};
use crate::model::augmented::AugmentedModel;
use crate::model::borders::Grid;
use crate::records::dataset::Dataset;

/// How the nonlinear parameters are searched after the starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Search {
    /// Gauss–Newton together with everything else.
    Smooth,
    /// The starts are compared with their nonlinear parameters held, which is a nearly linear problem; then as `Smooth`.
    Conditional,
    /// A profile refined around its best point: the likelihood has corners.
    Profile,
    /// The same where the nonlinear parameters only weigh the samples: the rest hardly moves with them, and is fitted afterwards.
    Weights,
}

/// The change an effect makes to an augmented model, given its nonlinear parameters.
pub(crate) type Apply = Arc<dyn Fn(&[f64], &mut AugmentedModel) + Send + Sync>;

/// Whether a law, given its fitted nonlinear parameters, is still a law of its effect, not the limit at which it is another one.
pub(crate) type Sound = fn(&[f64], &Fit) -> bool;

/// The effect that a law is one of, given its fitted nonlinear parameters: where a coefficient may have either sign, a name includes it.
pub(crate) type Naming = fn(&[f64], &Fit) -> Effect;

/// One law of an effect.
pub(crate) struct Variant {
    /// Points the search starts from; all hold the same parameters.
    pub(crate) starts: Vec<Vec<NonlinearParameter>>,
    /// Further points where everything is identified anew: at a start where the law changes nothing that identifies what is known.
    pub(crate) afresh: Vec<Vec<NonlinearParameter>>,
    pub(crate) search: Search,
    /// Starts from which everything is fitted together, where the nonlinear parameters are conditions of the rest.
    pub(crate) climbs: usize,
    /// Near which local minimum a start lies, where only the likeliest start of each is refined.
    pub(crate) valley: Option<fn(&[NonlinearParameter]) -> i64>,
    pub(crate) apply: Apply,
    pub(crate) sound: Sound,
    /// Which effect a fit is one of, where that depends on its signs.
    pub(crate) naming: Option<Naming>,
    /// A finer border grid that comes with the law.
    pub(crate) grid: Option<Grid>,
    /// Added to the deviance: evidence that the innovations do not show, or a penalty.
    pub(crate) size_penalty: f64,
}

/// Refines a law whose starts lie along one valley of the likelihood.
const CLIMBS: usize = 3;

impl Search {
    /// Whether nonlinear parameters are moved one by one, without derivatives.
    pub(crate) fn is_by_pattern(self) -> bool {
        matches!(self, Self::Profile | Self::Weights)
    }
}

impl Variant {
    pub(super) fn new(
        starts: Vec<Vec<NonlinearParameter>>,
        apply: impl Fn(&[f64], &mut AugmentedModel) + Send + Sync + 'static,
    ) -> Self {
        Self {
            starts,
            afresh: Vec::new(),
            search: Search::Smooth,
            climbs: CLIMBS,
            valley: None,
            apply: Arc::new(apply),
            sound: |_, _| true,
            naming: None,
            grid: None,
            size_penalty: 0.0,
        }
    }

    pub(super) fn conditional(
        starts: Vec<Vec<NonlinearParameter>>,
        apply: impl Fn(&[f64], &mut AugmentedModel) + Send + Sync + 'static,
    ) -> Self {
        Self { search: Search::Conditional, ..Self::new(starts, apply) }
    }

    /// The same law, of its effect only where a fit is sound.
    pub(super) fn sound_if(self, sound: Sound) -> Self {
        Self { sound, ..self }
    }

    /// The same law, of another effect where its signs say so.
    pub(super) fn named_by(self, naming: Naming) -> Self {
        Self { naming: Some(naming), ..self }
    }
}

/// What an effect may look at when it proposes its variants.
pub(crate) struct Scene<'a> {
    pub(crate) dataset: &'a Dataset,
    /// The best model so far.
    pub(crate) fit: &'a Fit,
    /// Its innovations on the fit records.
    pub(crate) innovations: &'a [Vec<f64>],
}
