//! The gain of the linear part changes with time.
//!
//! ```text
//! A y = (1 + g(t))·B (u + u₀),   g = Σ cₖ sₖ(clock), polynomial or sinusoid
//! ```
//!
//! The output that a zero of `u` stands for is unknown, and borders are known up to a level only: `g` moves the output as a drift
//! does, by a share `u₀` that is estimated with it (polynomials) or taken as zero.
//!
//! A zero of the output more than [`FARTHEST`] ranges of `u` away makes the law a drift of the sensor, and is no gain drift.
//!
//! Parameters: coefficients; rate of the sinusoid. Clocks: samples of the campaign or of the record. Stage: dynamics. Outputs scale with time,
//! mid-line and loop alike. Confused with: border wear (the mid-line tells), sensor drift.

use super::{Variant, own};
use crate::assembly::{Clock, EquationColumn, Slow};
use crate::engine::Fit;

pub(super) fn variants() -> Vec<Variant> {
    let mut out = Vec::new();
    for clock in [Clock::Campaign, Clock::Record, Clock::Travel] {
        for degree in [1, 3] {
            let start: Vec<_> =
                (0..degree).map(|_| own("gain_change", "1", 0.0, (-1.0, 1.0), 0.001)).collect();
            for level in [false, true] {
                out.push(Variant::new(vec![start.clone()], move |p, assembly| {
                    assembly.gain = Some(Slow { clock, coefficients: p.to_vec(), wave: None });
                    for degree in (1..=degree).filter(|_| level) {
                        assembly.equation_columns.push(EquationColumn::Trend { clock, degree });
                    }
                }));
            }
        }
        let starts = [4.0, 9.0, 18.0]
            .iter()
            .map(|&rate| {
                vec![
                    own("sine", "1", 0.0, (-0.8, 0.8), 0.001),
                    own("cosine", "1", 0.0, (-0.8, 0.8), 0.001),
                    own("rate", "radians per clock", rate, (1.0, 60.0), 0.02),
                ]
            })
            .collect();
        out.push(Variant::new(starts, move |p, assembly| {
            assembly.gain = Some(Slow { clock, coefficients: Vec::new(), wave: Some((p[2], p[0], p[1])) });
        }));
    }
    out
}

/// Distance of the output's zero from the middle of the borders, in their range, at which a gain that changes is not told from a drift.
const FARTHEST: f64 = 3.0;

/// Whether the zero that the gain turns about is one that an output may have.
pub(super) fn is_sound(fit: &Fit) -> bool {
    let Some(Slow { coefficients, .. }) = &fit.assembly.gain else { return true };
    let trends = fit.assembly.equation_columns.iter().zip(&fit.linear.d);
    let trends: Vec<f64> =
        trends.filter(|(c, _)| matches!(c, EquationColumn::Trend { .. })).map(|(_, d)| *d).collect();
    if coefficients.is_empty() || trends.len() != coefficients.len() {
        return true;
    }
    // The change in powers of the clock, as the trends are: its basis is x + 1, x² − 1, x³ − x.
    let mut change = coefficients.clone();
    change[0] -= coefficients.get(2).copied().unwrap_or(0.0);
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let static_gain = fit.linear.b.iter().sum::<f64>();
    let zero = product(&change, &trends) / (product(&change, &change) * static_gain);
    let borders = &fit.linear.f[..fit.grid.len()];
    let low = borders.iter().copied().fold(f64::INFINITY, f64::min);
    let high = borders.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (zero + 0.5 * (low + high)).abs() <= FARTHEST * (high - low)
}
