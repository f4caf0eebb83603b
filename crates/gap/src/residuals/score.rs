//! Log predictive scores and residual pictures.

use std::f64::consts::PI;
use std::ops::Range;

use crate::diagnosis::ResidualPicture;
use crate::least_squares::normal::Normal;
use crate::least_squares::sums::energy;
use crate::likelihood::design::{Design, DesignTrack, Whitener};
use crate::likelihood::engine::Fit;
use crate::likelihood::weights::weigh;
use crate::records::campaign::{Campaign, Track};
use crate::simulation::beginnings::with_beginnings;

/// Innovations of a fitted model on the chosen tracks.
pub(crate) fn innovations(campaign: &Campaign, fit: &Fit, chosen: impl Fn(&Track) -> bool) -> Vec<Vec<f64>> {
    let design = Design::new(campaign, &fit.grid, &fit.assembly, chosen);
    design.innovations(&fit.linear, &design.whitener(&fit.assembly.noise, &fit.linear.a))
}

/// Mean log predictive density a sample on the hold-out records, dimensionless output.
pub(crate) fn heldout_log_score(campaign: &Campaign, fit: &Fit) -> Option<f64> {
    let scores = heldout_log_scores(campaign, fit);
    let counted = || scores.iter().flatten().filter(|x| !x.is_nan());
    (scores.iter().any(|record| !record.is_empty()))
        .then(|| counted().sum::<f64>() / (counted().count() as f64).max(1.0))
}

/// Log predictive density of every counted sample of each hold-out record, dimensionless output; NaN where a sample has no say. What
/// died away when a record began is no fault of the model: it is taken out.
pub(crate) fn heldout_log_scores(campaign: &Campaign, fit: &Fit) -> Vec<Vec<f64>> {
    let (assembly, starts) = with_beginnings(campaign, &fit.assembly);
    let design = Design::new(campaign, &fit.grid, &assembly, |t| !t.is_fit());
    let whitener = design.whitener(&fit.assembly.noise, &fit.linear.a);
    let p = fit.linear.padded(fit.grid.len(), &assembly);
    let w = without(design.innovations(&p, &whitener), &design, &whitener, starts);
    let variance = fit.variance;
    let density = |x: f64, v: f64| (-0.5 * x * x / v).exp() / (2.0 * PI * v).sqrt();
    if let Some((share, ratio)) = fit.assembly.noise.mixture {
        let wide = variance * ratio * ratio;
        let mixed = |x: f64| (1.0 - share) * density(x, variance) + share * density(x, wide);
        return w.iter().map(|w| w.iter().map(|x| mixed(*x).max(1e-300).ln()).collect()).collect();
    }
    let weights = weigh(&design, &fit.assembly.noise, &fit.linear, &w);
    let weighed = weights.by_track(&w);
    let of_track = |(number, part): (usize, &DesignTrack)| {
        let w = &weighed[number];
        let counted = (0..w.len()).filter(|&k| weights.counts(number, k)).count();
        let slope = part.log_slope / counted.max(1) as f64;
        let score = |(k, x): (usize, &f64)| {
            let s = weights.scale.as_ref().map_or(1.0, |s| s[number][k]);
            let normal = -0.5 * (2.0 * PI * variance).ln() - 0.5 * x * x / variance;
            if s > 0.0 { normal + s.ln() + slope } else { f64::NAN }
        };
        w.iter().enumerate().map(score).collect()
    };
    design.tracks.iter().enumerate().map(of_track).collect()
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
        let own: Vec<&Vec<f64>> =
            columns.iter().map(|column| &column[number]).filter(|column| energy(column) > 0.0).collect();
        let mut normal = Normal::new(own.len());
        let row = |t: usize| own.iter().map(|column| column[t]).collect::<Vec<f64>>();
        (0..w.len()).for_each(|t| normal.add(&row(t), w[t]));
        let Some(factor) = normal.factor(1e-9).filter(|_| !own.is_empty()) else { continue };
        let taken = factor.solve(&normal.gradient);
        for (column, d) in own.iter().zip(taken) {
            w.iter_mut().zip(*column).for_each(|(w, x)| *w -= d * x);
        }
    }
    innovations
}

/// Autocorrelation and averaged spectrum of the innovations, physical units.
pub(crate) fn picture(campaign: &Campaign, w: &[Vec<f64>]) -> ResidualPicture {
    const LAGS: usize = 40;
    const SEGMENT: usize = 256;
    let count: usize = w.iter().map(Vec::len).sum();
    let mut spectrum = vec![0.0; SEGMENT / 2 + 1];
    let mut segments = 0.0;
    for segment in w.iter().flat_map(|w| w.chunks_exact(SEGMENT)) {
        for (s, p) in spectrum.iter_mut().zip(crate::residuals::spectrum::power(segment, SEGMENT)) {
            *s += p / SEGMENT as f64 * campaign.y_scale * campaign.y_scale;
        }
        segments += 1.0;
    }
    spectrum.iter_mut().for_each(|s| *s /= f64::max(segments, 1.0));
    ResidualPicture {
        autocorrelation: crate::residuals::spectrum::autocorrelation(w, LAGS),
        frequency: (0..=SEGMENT / 2).map(|k| k as f64 / SEGMENT as f64).collect(),
        spectrum: if segments > 0.0 { spectrum } else { Vec::new() },
        band: 1.96 / (count.max(1) as f64).sqrt(),
    }
}
