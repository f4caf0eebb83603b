//! The gain of the linear part changes with time.
//!
//! ```text
//! A y = (1 + g(t))·B (u + u₀),   g = Σ cₖ sₖ(clock), polynomial or sinusoid
//! ```
//!
//! The output that a zero of `u` stands for is unknown, and borders are known up to a level only: `g` moves the output as a drift
//! does, by a share `u₀` that is estimated with it (polynomials) or taken as zero.
//!
//! Parameters: coefficients; rate of the sinusoid. Clocks: samples of the campaign or of the record. Stage: dynamics. Outputs scale with time,
//! mid-line and loop alike. Confused with: border wear (the mid-line tells), sensor drift.

use super::{Variant, own};
use crate::assembly::{Clock, EquationColumn, Slow};

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
