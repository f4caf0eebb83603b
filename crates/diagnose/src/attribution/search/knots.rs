//! Border knots of an explanation placed anew, and everything fitted together on them.

use super::finish;
use crate::attribution::explain::{Explanation, Part, assembled};
use crate::likelihood::engine::{Build, Fit};
use crate::nominal::knots::{evenly, replace, smoothly};
use crate::records::campaign::Campaign;

impl Explanation {
    /// The same explanation and details of the borders beside it: knots placed anew are a part of their own.
    pub(crate) fn with_details(self, campaign: &Campaign) -> Self {
        let mut detailed = self.with_knots_refined(campaign);
        detailed.parts.push(Part::details());
        detailed
    }

    /// The same explanation with border knots placed anew, where that is better.
    pub(crate) fn with_knots_refined(self, campaign: &Campaign) -> Self {
        let refined = self.on_knots(campaign, |free, build| Some(replace(campaign, free, build)));
        match refined {
            Some(refined) if refined.bic() < self.bic() => refined,
            _ => self,
        }
    }

    /// The same explanation without the knots that follow details of the borders here and there.
    pub(crate) fn on_an_even_grid(&self, campaign: &Campaign) -> Option<Self> {
        self.on_knots(campaign, |free, build| evenly(campaign, free, build))
    }

    /// The same, on a grid that follows no detail all along the borders either.
    pub(crate) fn on_a_smooth_grid(&self, campaign: &Campaign) -> Option<Self> {
        self.on_knots(campaign, |free, build| smoothly(campaign, free, build))
    }

    /// The same explanation on other knots: the nonlinear parameters stay while the knots move, then everything is fitted together.
    /// Parameters with corners stay where their profile put them.
    fn on_knots(&self, campaign: &Campaign, place: impl Fn(&Fit, &Build<'_>) -> Option<Fit>) -> Option<Self> {
        let nonlinear = self.fit.nonlinear.clone();
        let values: Vec<f64> = nonlinear.iter().map(|o| o.value).collect();
        let mut free = self.fit.clone();
        free.nonlinear.clear();
        free.nonlinear_se.clear();
        free.parameters -= nonlinear.len() as f64;
        let assembly = assembled(&self.parts, &values);
        let mut fit = place(&free, &|_| assembly.clone())?;
        fit.parameters += nonlinear.len() as f64;
        fit.nonlinear = nonlinear;
        fit.nonlinear_se.clone_from(&self.fit.nonlinear_se);
        let placed = Self { fit, ..self.clone() };
        Some(if placed.fit.nonlinear.is_empty() { placed } else { finish(campaign, 0, &placed) })
    }
}
