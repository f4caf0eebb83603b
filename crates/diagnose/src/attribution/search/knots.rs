//! Border knots of a candidate placed anew, and everything fitted together on them.

use super::finish;
use crate::attribution::explain::{EffectTerm, Hypothesis, assembled};
use crate::likelihood::engine::{Build, Fit};
use crate::nominal::knots::{evenly, replace, smoothly};
use crate::records::dataset::Dataset;

impl Hypothesis {
    /// The same candidate and refinements of the borders beside it: knots placed anew are a part of their own.
    pub(crate) fn with_refinement(self, dataset: &Dataset) -> Self {
        let mut detailed = self.with_knots_refined(dataset);
        detailed.effect_terms.push(EffectTerm::refinement());
        detailed
    }

    /// The same candidate with border knots placed anew, where that is better.
    pub(crate) fn with_knots_refined(self, dataset: &Dataset) -> Self {
        let refined = self.on_knots(dataset, |free, build| Some(replace(dataset, free, build)));
        match refined {
            Some(refined) if refined.bic() < self.bic() => refined,
            _ => self,
        }
    }

    /// The same candidate without the knots that follow refinements of the borders here and there.
    pub(crate) fn on_an_even_grid(&self, dataset: &Dataset) -> Option<Self> {
        self.on_knots(dataset, |free, build| evenly(dataset, free, build))
    }

    /// The same, on a grid that follows no refinement all along the borders either.
    pub(crate) fn on_a_smooth_grid(&self, dataset: &Dataset) -> Option<Self> {
        self.on_knots(dataset, |free, build| smoothly(dataset, free, build))
    }

    /// The same candidate on other knots: the nonlinear parameters stay while the knots move, then everything is fitted together.
    /// Parameters with corners stay where their profile put them.
    fn on_knots(&self, dataset: &Dataset, place: impl Fn(&Fit, &Build<'_>) -> Option<Fit>) -> Option<Self> {
        let nonlinear = self.fit.nonlinear.clone();
        let values: Vec<f64> = nonlinear.iter().map(|o| o.value).collect();
        let mut free = self.fit.clone();
        free.nonlinear.clear();
        free.nonlinear_se.clear();
        free.parameters -= nonlinear.len() as f64;
        let augmented = assembled(&self.effect_terms, &values);
        let mut fit = place(&free, &|_| augmented.clone())?;
        fit.parameters += nonlinear.len() as f64;
        fit.nonlinear = nonlinear;
        fit.nonlinear_se.clone_from(&self.fit.nonlinear_se);
        let placed = Self { fit, ..self.clone() };
        Some(if placed.fit.nonlinear.is_empty() { placed } else { finish(dataset, 0, &placed) })
    }
}
