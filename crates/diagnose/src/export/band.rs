//! How far the parameters' errors move a free run.

use switchback_identify::statistics::propagated;

use super::portable::Wire;
use crate::model::linear::Linear;

/// Variance of every sample of a free run that the errors of the parameters make; nothing where these are unknown.
///
/// `run` gives the output for linear parameters; `moved` the run under the moved augmented model of each nonlinear parameter, whose difference
/// quotient is its derivative.
pub(super) fn variances(
    model: &Wire,
    linear: &Linear,
    run: impl Fn(&Linear) -> Vec<f64>,
    moved: impl Fn(usize) -> Vec<f64>,
) -> Option<Vec<f64>> {
    let rows = model.covariance.as_ref()?;
    let fitted = run(linear);
    let slopes: Vec<Vec<f64>> = (0..model.moved.len())
        .map(|j| moved(j).iter().zip(&fitted).map(|(m, y)| (m - y) / model.moved[j].step).collect())
        .collect();
    Some(propagated(rows, |step| {
        let (by, nonlinear) = step.split_at(linear.len());
        let mut x = run(&linear.moved(by, 1.0));
        for (by, slope) in nonlinear.iter().zip(&slopes) {
            x.iter_mut().zip(slope).for_each(|(x, s)| *x += by * s);
        }
        x
    }))
}
