//! How well everything that a fit estimates is known together.

use crate::likelihood::engine::{Build, Fit, FitContext, derivatives, evaluate, priors};
use crate::likelihood::jacobian::normal_equations;
use crate::model::augmented::AugmentedModel;

/// Relative damping of the normal equations: that of a fit's last steps.
const DAMPING: f64 = 1e-9;

/// The covariance of a fit's parameters, and what moves the model where these are no linear ones.
#[derive(Debug, Clone)]
pub(crate) struct Uncertainty {
    /// Covariance of `a`, `b`, `f`, `d` and the nonlinear parameters, a row each.
    pub(crate) covariance: Vec<Vec<f64>>,
    /// For each nonlinear parameter a step, and the augmented model that far from the fitted one.
    pub(crate) moved: Vec<(f64, AugmentedModel)>,
}

/// `σ²(JᵀWJ + prior)⁻¹/share` at a fit, `build` that of its candidate; nothing where the normal equations have no solution.
///
/// The direction along which `b` and `f` trade their scale is held: no output depends on it.
pub(crate) fn uncertainty(context: FitContext<'_>, build: &Build<'_>, fit: &Fit) -> Option<Uncertainty> {
    let (design, p) = (&*fit.design(), &fit.linear);
    let state = evaluate(design, fit.augmented.clone(), p)?;
    let extra = derivatives(&context, build, &fit.nonlinear, design, &state, p);
    let w = state.weights.applied(&state.innovations);
    let mut normal = normal_equations(design, p, &state.whitener, &state.weights, (&w, &extra));
    priors(&mut normal, context.grid, p, &fit.augmented);
    let factor = normal.factor(DAMPING)?;
    let scale = state.variance / design.criterion.share();
    let column = |i: usize| {
        let unit: Vec<f64> = (0..normal.size).map(|j| f64::from(u8::from(i == j))).collect();
        factor.solve(&unit).into_iter().map(|x| scale * x).collect::<Vec<f64>>()
    };
    let covariance: Vec<Vec<f64>> = (0..normal.size).map(column).collect();
    let is_finite = covariance.iter().flatten().all(|x| x.is_finite());
    let moved = (0..fit.nonlinear.len()).map(|j| {
        let mut values: Vec<f64> = fit.nonlinear.iter().map(|o| o.value).collect();
        let step = fit.nonlinear[j].inward_step();
        values[j] += step;
        (step, build(&values))
    });
    is_finite.then(|| Uncertainty { covariance, moved: moved.collect() })
}
