//! Log predictive scores and residual pictures.

use std::f64::consts::PI;
use std::ops::Range;

use crate::diagnosis::ResidualPicture;
use crate::least_squares::normal::Normal;
use crate::likelihood::design::{Design, DesignScaled, Whitener};
use crate::likelihood::engine::Fit;
use crate::likelihood::weights::weigh;
use crate::records::dataset::{Dataset, ScaledRecord};
use crate::simulation::initial_conditions::{with_drift_paths, with_initial_conditions};
use switchback_model::sums::energy;

/// Innovations of a fitted model on the chosen records.
pub(crate) fn innovations(
    dataset: &Dataset,
    fit: &Fit,
    chosen: impl Fn(&ScaledRecord) -> bool,
) -> Vec<Vec<f64>> {
    let design = Design::new(dataset, &fit.grid, &fit.augmented, chosen);
    design.innovations(&fit.linear, &design.whitener(&fit.augmented.noise, &fit.linear.a))
}

/// Mean log predictive density a sample on the hold-out records, dimensionless output.
pub(crate) fn heldout_log_score(dataset: &Dataset, fit: &Fit) -> Option<f64> {
    let scores = heldout_log_scores(dataset, fit);
    let counted = || scores.iter().flatten().filter(|x| !x.is_nan());
    (scores.iter().any(|record| !record.is_empty()))
        .then(|| counted().sum::<f64>() / (counted().count() as f64).max(1.0))
}

/// Log predictive density of every counted sample of each hold-out record, dimensionless output; NaN where a sample has no say.
///
/// What died away when a record began is no fault of the model, nor is the phase of a wave or the path of a zero that is free from
/// record to record: these are taken out. A drift path or a wave of `k` coefficients follows the noise of `N` samples as well; what that gains,
/// `k/N` a sample, is paid back (H. Akaike, "Information theory and an extension of the maximum likelihood principle", 1973).
pub(crate) fn heldout_log_scores(dataset: &Dataset, fit: &Fit) -> Vec<Vec<f64>> {
    let (augmented, starts) = with_initial_conditions(dataset, &fit.augmented);
    let (augmented, paths) = with_drift_paths(dataset, &augmented);
    let design = Design::new(dataset, &fit.grid, &augmented, |t| !t.is_fit());
    let whitener = design.whitener(&fit.augmented.noise, &fit.linear.a);
    let p = fit.linear.padded(fit.grid.len(), &augmented);
    let w = without(design.innovations(&p, &whitener), &design, &whitener, starts.start..paths.end);
    let free = |effect_term: &DesignScaled| {
        effect_term.columns.numbers.iter().filter(|&j| paths.contains(j)).count()
    };
    let variance = fit.variance;
    let density = |x: f64, v: f64| (-0.5 * x * x / v).exp() / (2.0 * PI * v).sqrt();
    if let Some((share, ratio)) = fit.augmented.noise.mixture {
        let wide = variance * ratio * ratio;
        let mixed = |x: f64| (1.0 - share) * density(x, variance) + share * density(x, wide);
        let of_scaled = |(effect_term, w): (&DesignScaled, &Vec<f64>)| {
            let cost = free(effect_term) as f64 / w.len().max(1) as f64;
            w.iter().map(|x| mixed(*x).max(1e-300).ln() - cost).collect()
        };
        return design.scaled_records.iter().zip(&w).map(of_scaled).collect();
    }
    let weights = weigh(&design, &fit.augmented.noise, &fit.linear, &w);
    let weighed = weights.by_scaled(&w);
    let of_scaled = |(number, effect_term): (usize, &DesignScaled)| {
        let w = &weighed[number];
        let counted = (0..w.len()).filter(|&k| weights.counts(number, k)).count();
        let slope = (effect_term.log_slope - free(effect_term) as f64) / counted.max(1) as f64;
        let score = |(k, x): (usize, &f64)| {
            let s = weights.scale.as_ref().map_or(1.0, |s| s[number][k]);
            let normal = -0.5 * (2.0 * PI * variance).ln() - 0.5 * x * x / variance;
            if s > 0.0 { normal + s.ln() + slope } else { f64::NAN }
        };
        w.iter().enumerate().map(score).collect()
    };
    design.scaled_records.iter().enumerate().map(of_scaled).collect()
}

/// Innovations without what columns of the equation whose coefficients are unknown take of them, by least squares.
fn without(
    mut innovations: Vec<Vec<f64>>,
    design: &Design,
    whitener: &Whitener,
    columns: Range<usize>,
) -> Vec<Vec<f64>> {
    let columns: Vec<Vec<Vec<f64>>> = columns.map(|j| design.disturbance(j, whitener)).collect();
    for (number, w) in innovations.iter_mut().enumerate() {
        let of_record: Vec<&Vec<f64>> =
            columns.iter().map(|column| &column[number]).filter(|column| energy(column) > 0.0).collect();
        let mut normal = Normal::new(of_record.len());
        let row = |t: usize| of_record.iter().map(|column| column[t]).collect::<Vec<f64>>();
        (0..w.len()).for_each(|t| normal.add(&row(t), w[t]));
        let Some(factor) = normal.factor(1e-9).filter(|_| !of_record.is_empty()) else { continue };
        let taken = factor.solve(&normal.gradient);
        for (column, d) in of_record.iter().zip(taken) {
            w.iter_mut().zip(*column).for_each(|(w, x)| *w -= d * x);
        }
    }
    innovations
}

/// Autocorrelation and averaged spectrum of the innovations, physical units.
pub(crate) fn picture(dataset: &Dataset, w: &[Vec<f64>]) -> ResidualPicture {
    const LAGS: usize = 40;
    const SEGMENT: usize = 256;
    let count: usize = w.iter().map(Vec::len).sum();
    let mut spectrum = vec![0.0; SEGMENT / 2 + 1];
    let mut segments = 0.0;
    for segment in w.iter().flat_map(|w| w.chunks_exact(SEGMENT)) {
        for (s, p) in spectrum.iter_mut().zip(switchback_model::spectrum::power(segment, SEGMENT)) {
            *s += p / SEGMENT as f64 * dataset.y_scale * dataset.y_scale;
        }
        segments += 1.0;
    }
    spectrum.iter_mut().for_each(|s| *s /= f64::max(segments, 1.0));
    ResidualPicture {
        autocorrelation: switchback_model::spectrum::autocorrelation(w, LAGS),
        frequency: (0..=SEGMENT / 2).map(|k| k as f64 / SEGMENT as f64).collect(),
        spectrum: if segments > 0.0 { spectrum } else { Vec::new() },
        band: 1.96 / (count.max(1) as f64).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::engine::{FitContext, fit};
    use crate::model::augmented::{AugmentedModel, EquationColumn};
    use crate::model::linear::Linear;
    use crate::testing::{noise_free, small_dataset, small_model, white};
    use switchback_model::rig::Usage;

    /// The oracle: the entropy of the equation errors, which no model predicts better.
    #[test]
    fn the_phase_of_a_wave_in_a_held_out_record_is_no_fault_of_the_model() {
        let sd = 0.01;
        let lines = [false, true].map(|sine| EquationColumn::Line { frequency: 0.9, scaled: Some(0), sine });
        let augmented = AugmentedModel { equation_columns: lines.to_vec(), ..AugmentedModel::default() };
        let mut noise = white();
        let mut record = |phase: [f64; 2]| {
            let (dataset, grid) = small_dataset();
            let truth = Linear { d: phase.to_vec(), ..small_model(&grid) };
            let mut scaled = noise_free(dataset, &grid, &augmented, &truth).scaled_records.remove(0);
            let mut past = [0.0; 2];
            for y in &mut scaled.y {
                let now = sd * noise() - truth.a[0] * past[0] - truth.a[1] * past[1];
                past = [now, past[0]];
                *y += now;
            }
            scaled
        };
        let (mut dataset, grid) = small_dataset();
        dataset.scaled_records = vec![record([0.3, 0.1]), record([-0.2, 0.25])];
        dataset.scaled_records[1].usage = Usage::Holdout;
        let start = Linear { d: vec![0.0; 2], ..small_model(&grid) };
        let context = FitContext { dataset: &dataset, grid: &grid, known: None };
        let found = fit(context, &|_| augmented.clone(), &[], &start, 30).expect("a fit");
        let score = heldout_log_score(&dataset, &found).expect("a held-out record");
        let best = -0.5 * (2.0 * PI * sd * sd).ln() - 0.5;
        assert!((score - best).abs() < 0.2, "{score} {best}");
    }
}
