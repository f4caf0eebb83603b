//! The gain of the linear part changes with time.
//!
//! ```text
//! A y = (1 + g(t))·B (u + u₀),   g = Σ cₖ sₖ(clock), polynomial or sinusoid, or straight between knots
//! ```
//!
//! The output that a zero of `u` stands for is unknown, and borders are known up to a level only: `g` moves the output as a drift
//! does, by a share `u₀` that is estimated with it.
//!
//! A zero of the output more than [`FARTHEST`] ranges of `u` away makes the law a drift of the sensor, and is no gain drift.
//!
//! Nobody records how long the pauses between records are, and a gain may wander: where a law with a clock leaves something, the
//! gain is straight between knots in each record, from where that law ended.
//!
//! Parameters: coefficients; rate of the sinusoid. Clocks: samples of the dataset or of the record. Stage: dynamics. Outputs scale with time,
//! mid-line and loop alike. Confused with: border wear (the mid-line shows), a gain that steps, sensor drift.

use super::{Card, Scene, Variant, parameter};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::Fit;
use crate::likelihood::rows::clock;
use crate::model::augmented::{AugmentedModel, Clock, EquationColumn, Slow};
use crate::records::dataset::Dataset;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::BorderWear, Effect::StepChange],
    of_its_record: true,
    dominates_dynamics: true,
    freed: free_course,
    ..Card::of(Stage::Dynamics, variants)
};

/// Rates of a wave, radians over the clock.
const RATES: [f64; 3] = [4.0, 9.0, 18.0];
/// Changes of the gain, and phases of a wave, from which everything is identified anew: a slow pole may pass for a drift.
const AFRESH: [f64; 2] = [-0.2, 0.2];
const PHASES: [(f64, f64); 4] = [(0.2, 0.0), (0.0, 0.2), (-0.2, 0.0), (0.0, -0.2)];

fn variants(_: &Scene<'_>) -> Vec<Variant> {
    let mut out = Vec::new();
    for clock in [Clock::Dataset, Clock::Record, Clock::Travel] {
        for degree in [1, 3] {
            let start = |slope: f64| -> Vec<_> {
                let value = |k: usize| if k == 0 { slope } else { 0.0 };
                (0..degree).map(|k| parameter("gain_change", "1", value(k), (-1.0, 1.0), 0.001)).collect()
            };
            let law = Variant::new(vec![start(0.0)], move |p, augmented| {
                drift(augmented, Slow { coefficients: p.to_vec(), ..Slow::on(clock) });
            });
            let afresh = if degree == 1 { AFRESH.map(start).into() } else { Vec::new() };
            out.push(Variant { afresh, ..law.sound_if(turns_about_an_output) });
        }
        let start = |rate: f64, (sine, cosine): (f64, f64)| {
            vec![
                parameter("sine", "1", sine, (-0.8, 0.8), 0.001),
                parameter("cosine", "1", cosine, (-0.8, 0.8), 0.001),
                parameter("rate", "radians per clock", rate, (1.0, 60.0), 0.02),
            ]
        };
        let law = Variant::new(RATES.map(|rate| start(rate, (0.0, 0.0))).into(), move |p, augmented| {
            drift(augmented, Slow { wave: Some((p[2], p[0], p[1])), ..Slow::on(clock) });
        });
        let afresh = RATES.iter().filter(|_| clock == Clock::Dataset);
        let afresh = afresh.flat_map(|&rate| PHASES.map(|phase| start(rate, phase))).collect();
        out.push(Variant { afresh, ..law.sound_if(turns_about_an_output) });
    }
    out
}

/// The gain changes about a zero of the output that is estimated.
pub(super) fn drift(augmented: &mut AugmentedModel, gain: Slow) {
    augmented.gain = Some(gain);
    augmented.equation_columns.push(EquationColumn::Gain);
}

/// Samples between knots of a free drift path, and pieces of a record at most.
const PIECE: usize = 1000;
const PIECES: usize = 4;

/// A law of the gain that is straight between knots, from where the gain of a fit ended; none where that does not change.
fn free_course(dataset: &Dataset, fit: &Fit) -> Option<Variant> {
    let gain = fit.augmented.gain.as_ref().filter(|gain| gain.changes())?;
    let known = dataset.fit().flat_map(|scaled| {
        let pieces = (scaled.v.len() / PIECE).clamp(1, PIECES);
        let last = scaled.v.len() - 1;
        (0..=pieces).map(move |k| {
            let t = last * k / pieces;
            let value = gain.at(clock(gain.clock, dataset, scaled, t, scaled.moves[t].path));
            ((scaled.clock + t) as f64, value)
        })
    });
    let known: Vec<(f64, f64)> = known.collect();
    // The scale of the gain is that of B: it is one in the beginning.
    let (first, rest) = known.split_first()?;
    let change = |value: f64| (1.0 + value) / (1.0 + first.1) - 1.0;
    let start = rest.iter().map(|k| parameter("gain_change", "1", change(k.1), (-1.0, 2.0), 0.001)).collect();
    let clocks: Vec<f64> = known.iter().map(|k| k.0).collect();
    let law = Variant::new(vec![start], move |p, augmented| {
        let values = std::iter::once(0.0).chain(p.iter().copied());
        let bends = clocks.iter().copied().zip(values).collect();
        drift(augmented, Slow { bends, ..Slow::on(Clock::Samples) });
    });
    Some(law.sound_if(turns_about_an_output))
}

/// Distance of the output's zero from the middle of the borders, in their range, at which a gain that changes is not distinguished from a drift.
const FARTHEST: f64 = 3.0;

/// Whether the zero that the gain turns about is one that an output may have.
pub(super) fn turns_about_an_output(_own: &[f64], fit: &Fit) -> bool {
    let static_gain = fit.linear.b.iter().sum::<f64>() * fit.augmented.static_gain();
    let Some(zero) = share_of_the_change(fit).map(|share| share / static_gain) else { return true };
    let borders = &fit.linear.f[..fit.grid.len()];
    let low = borders.iter().copied().fold(f64::INFINITY, f64::min);
    let high = borders.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (zero + 0.5 * (low + high)).abs() <= FARTHEST * (high - low)
}

/// The drift of the equation as a share of the gain's change, where that changes.
fn share_of_the_change(fit: &Fit) -> Option<f64> {
    fit.augmented.gain.as_ref().filter(|gain| gain.changes())?;
    let mut columns = fit.augmented.equation_columns.iter().zip(&fit.linear.d);
    columns.find(|(column, _)| **column == EquationColumn::Gain).map(|(_, share)| *share)
}
