//! Laws of the innovations other than one normal distribution.

use crate::assembly::{NoiseLaw, convolve};
use crate::design::{Design, Linear};

/// What a law of the innovations makes of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Weights {
    /// Factor on each innovation that makes them equally distributed; absent where all are 1.
    pub(crate) scale: Option<Vec<Vec<f64>>>,
    /// Samples left out.
    pub(crate) left_out: usize,
    /// Sum of the factors' logarithms.
    pub(crate) log_scale: f64,
    /// The deviance itself, where it does not follow from the weighted sum of squares.
    pub(crate) deviance: Option<f64>,
    /// The mixture found.
    pub(crate) mixture: Option<(f64, f64)>,
}

impl Weights {
    /// Signals on the counted samples times the factors, all tracks one after the other.
    pub(crate) fn applied(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        match &self.scale {
            None => signals.concat(),
            Some(scale) => signals.iter().flatten().zip(scale.iter().flatten()).map(|(w, s)| w * s).collect(),
        }
    }
}

/// Weighs the innovations by the law.
pub(crate) fn weigh(design: &Design, law: &NoiseLaw, p: &Linear, w: &[Vec<f64>]) -> Weights {
    if design.tracks.iter().any(|t| t.clipped.is_some()) {
        return without_clipped(design);
    }
    if let Some(ratios) = law.input_ratio {
        return input_noise(design, ratios, p);
    }
    if let Some(start) = law.mixture {
        return mixture(start, w);
    }
    Weights::default()
}

/// Clipped samples are left out.
fn without_clipped(design: &Design) -> Weights {
    let mut left_out = 0;
    let scale = design
        .tracks
        .iter()
        .map(|track| match &track.clipped {
            Some(clipped) => clipped
                .iter()
                .map(|c| {
                    left_out += usize::from(*c);
                    f64::from(u8::from(!*c))
                })
                .collect(),
            None => vec![1.0; track.x.len() - track.from],
        })
        .collect();
    Weights { scale: Some(scale), left_out, ..Weights::default() }
}

/// Input noise `n` moves `u` by `slope·n`: the innovation's variance grows by `Σ b̃ⱼ² slope(t−j)²·ratio`.
fn input_noise(design: &Design, ratios: [f64; 2], p: &Linear) -> Weights {
    let taps = convolve(&p.b, &design.taps);
    let mut log_scale = 0.0;
    let scale = design
        .tracks
        .iter()
        .map(|track| {
            let Some([moving, resting]) = &track.sensitivity else {
                return vec![1.0; track.x.len() - track.from];
            };
            let energy: Vec<f64> = (0..track.x.len())
                .map(|t| ratios[0] * moving.dot(t, &p.f).powi(2) + ratios[1] * resting.dot(t, &p.f).powi(2))
                .collect();
            (track.from..track.x.len())
                .map(|t| {
                    let excess: f64 = taps.iter().enumerate().map(|(j, b)| b * b * energy[t - j - 1]).sum();
                    let s = 1.0 / (1.0 + excess).sqrt();
                    log_scale += s.ln();
                    s
                })
                .collect()
        })
        .collect();
    Weights { scale: Some(scale), log_scale, ..Weights::default() }
}

/// `w ~ (1−ε)·N(0,σ²) + ε·N(0,κ²σ²)`, fitted by expectation–maximisation.
fn mixture((mut share, mut ratio): (f64, f64), w: &[Vec<f64>]) -> Weights {
    let all: Vec<f64> = w.iter().flatten().copied().collect();
    let n = all.len() as f64;
    let mut magnitudes: Vec<f64> = all.iter().map(|x| x.abs()).collect();
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    let mut variance = (*median / 0.6745).powi(2).max(1e-300);
    let mut wide = vec![0.0; all.len()];
    let mut deviance = 0.0;
    for _ in 0..25 {
        let (mut count, mut narrow_sum, mut wide_sum) = (0.0, 0.0, 0.0);
        let before = deviance;
        deviance = 0.0;
        let wide_variance = ratio * ratio * variance;
        for (x, tau) in all.iter().zip(&mut wide) {
            let narrow = (1.0 - share) * (-0.5 * x * x / variance).exp() / variance.sqrt();
            let broad = share * (-0.5 * x * x / wide_variance).exp() / wide_variance.sqrt();
            let both = (narrow + broad).max(1e-300);
            deviance -= 2.0 * both.ln();
            *tau = broad / both;
            count += *tau;
            narrow_sum += (1.0 - *tau) * x * x;
            wide_sum += *tau * x * x;
        }
        share = (count / n).clamp(1e-5, 0.3);
        variance = (narrow_sum / (n - count).max(1.0)).max(1e-300);
        ratio = (wide_sum / count.max(1e-9) / variance).sqrt().clamp(2.5, 1e3);
        if (deviance - before).abs() < 1e-3 {
            break;
        }
    }
    let mut rest = wide.iter();
    let scale = w
        .iter()
        .map(|w| {
            rest.by_ref().take(w.len()).map(|tau| ((1.0 - tau) + tau / (ratio * ratio)).sqrt()).collect()
        })
        .collect();
    // The concentrated normal deviance drops N(1 + ln 2π); the densities above already lack the √2π.
    Weights {
        scale: Some(scale),
        deviance: Some(deviance - n),
        mixture: Some((share, ratio)),
        ..Weights::default()
    }
}
