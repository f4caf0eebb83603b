//! Values on a quantisation grid: a sensor that rounds shows it whatever else is the matter.

use crate::likelihood::engine::Fit;
use crate::records::dataset::Dataset;

/// Deviance a sample that a quantisation grid is worth. Chance leaves none, so it could be any number: large enough that no curve through the
/// few values there are competes.
const WORTH: f64 = 0.6;
/// Least share of the innovations' variance that rounding must make to matter.
const MATERIAL: f64 = 0.05;

/// The step of the quantisation grid that all outputs of the fit records lie on.
pub(crate) fn quantisation_step(dataset: &Dataset) -> Option<f64> {
    let mut values: Vec<f64> = dataset.fit().flat_map(|t| t.y.iter().copied()).collect();
    let count = values.len();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    if values.len() * 3 > count * 2 || values.len() < 3 {
        return None;
    }
    let step = values.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let origin = values[0];
    let fits = values
        .iter()
        .filter(|v| {
            let k = (*v - origin) / step;
            (k - k.round()).abs() < 0.05
        })
        .count();
    (fits * 100 >= values.len() * 98).then_some(step)
}

/// Deviance that a quantisation grid is worth in so many samples.
pub(crate) fn worth(samples: usize) -> f64 {
    WORTH * samples as f64
}

/// Whether rounding to `step` makes a share of the innovations that matters.
pub(crate) fn is_material(step: f64, fit: &Fit) -> bool {
    let a_energy = 1.0 + fit.linear.a.iter().map(|a| a * a).sum::<f64>();
    step * step / 12.0 * a_energy > MATERIAL * fit.variance
}
