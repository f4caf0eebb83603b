//! A slow after-effect of the operator's output.
//!
//! ```text
//! ũ = u + κ·(1−p)/(1−p q⁻¹) u,  p = exp(−1/τ)                first-order creep
//! ũ = u + κ/4·Σₖ (1−pₖ)/(1−pₖ q⁻¹) u,  pₖ = exp(−1/(ρᵏτ)), k = 0…3   logarithmic creep over ρ³
//! u = C(v) + c·branch·ln(1 + rest/τ)                         logarithmic creep at rest
//! u = C(v) + c·branch·(1 − exp(−rest/τ))                     creep at rest that ends
//! u = C(v) + c·branch·ln(1 + t/τ)                            logarithmic creep, t since the last reversal
//! u = C(v) − k·(C(v) − m(v))·(1 − exp(−rest/τ))              relaxation at rest towards the middle m between the borders
//! ```
//!
//! Equal weights on time constants spread evenly in their logarithm make the step response grow with the logarithm of
//! time (Krejci and Kuhnen, "Inverse control of systems with hysteresis and creep", IEE Proc. Control Theory Appl. 148, 2001).
//! Parameters: `kappa` (−0.9…1 for one time constant, beyond which the lag is the response and no after-effect; 3 for several), share `k` of the distance (−1…2), time constant `tau` in samples (8…5000; the shortest
//! of several 1…1000), their ratio `rho` (1.5…20). Stage: operator. After each move the output goes on
//! drifting: onwards, or back where `kappa` is negative or `k` positive (relaxation, which is the creep of a force at rest). Both are one
//! cause, and the parameters' signs say which. Confused with: rate dependence, an extra pole (much faster), sensor drift.

use super::{Card, Scene, Variant, fitted_scaled_records, parameter};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::Fit;
use crate::model::augmented::{EquationColumn, Relaxation, convolve};
use crate::simulation::initial_conditions::begins_as_a_filter;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::RateDependence, Effect::ExtraPole],
    ..Card::of(Stage::Operator, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let scaled_records = fitted_scaled_records(scene.dataset);
    let starts = [(0.1, 15.0), (0.1, 80.0), (0.1, 500.0), (0.6, 40.0), (0.6, 200.0)]
        .iter()
        .map(|&(kappa, tau): &(f64, f64)| {
            vec![
                parameter("kappa", "1", kappa, (-0.9, 1.0), 0.002),
                parameter("log_tau", "ln samples", tau.ln(), (2.0, 8.5), 0.02),
            ]
        })
        .collect();
    let linear = Variant::conditional(starts, move |p, augmented| {
        let pole = pole(p[1]);
        augmented.filter(&[1.0 + p[0] * (1.0 - pole), -pole], &[1.0, -pole]);
        // How far the creep had proceeded when a record began is unknown.
        for &scaled in &scaled_records {
            let decay = EquationColumn::Decay { scaled, radius: pole, frequency: 0.0, sine: false };
            augmented.equation_columns.push(decay);
        }
    });
    // With initial conditions at will, a creep that is next to none follows whatever drifts in each record.
    let linear = linear.sound_if(|p, fit| begins_as_a_filter(fit, pole(p[1]), p[0]));
    let mut out = vec![linear, spread(fitted_scaled_records(scene.dataset)).sound_if(begins_spread)];
    for column in [after_effect::logarithmic, after_effect::ending, after_effect::since_reversal] {
        let starts = [3.0, 30.0]
            .iter()
            .map(|&tau: &f64| vec![parameter("log_tau", "ln samples", tau.ln(), (-1.0, 7.0), 0.02)])
            .collect();
        out.push(Variant::conditional(starts, move |p, augmented| {
            augmented.border_columns.push(column(p[0].exp()));
        }));
    }
    out.push(relaxing());
    out
}

fn relaxing() -> Variant {
    let starts = [3.0, 30.0, 200.0]
        .iter()
        .map(|&tau: &f64| {
            vec![
                parameter("share", "1", 0.3, (-1.0, 2.0), 0.002),
                parameter("log_tau", "ln samples", tau.ln(), (-1.0, 7.0), 0.02),
            ]
        })
        .collect();
    Variant::conditional(starts, |p, augmented| {
        augmented.relaxation = Some(Relaxation { share: p[0], tau: p[1].exp() });
    })
}

/// The pole of a time constant given by its logarithm.
fn pole(log_tau: f64) -> f64 {
    (-(-log_tau).exp()).exp()
}

/// The poles of several time constants.
fn poles(p: &[f64]) -> [f64; 4] {
    [0.0, 1.0, 2.0, 3.0].map(|k| pole(p[1] + k * p[2]))
}

/// What the borders go on doing by themselves.
mod after_effect {
    use crate::model::augmented::BorderColumn;

    pub(super) fn logarithmic(scale: f64) -> BorderColumn {
        BorderColumn::RestingLog { scale }
    }

    pub(super) fn ending(scale: f64) -> BorderColumn {
        BorderColumn::RestingRise { scale }
    }

    pub(super) fn since_reversal(scale: f64) -> BorderColumn {
        BorderColumn::ReversalLog { scale }
    }
}

/// Whether each record begins with what the slower ones of several time constants may hold.
fn begins_spread(p: &[f64], fit: &Fit) -> bool {
    poles(p)[2..].iter().all(|&pole| begins_as_a_filter(fit, pole, 0.25 * p[0]))
}

fn spread(scaled_records: Vec<usize>) -> Variant {
    let starts = [1.5, 6.0, 25.0]
        .iter()
        .map(|&tau: &f64| {
            vec![
                parameter("kappa", "1", 0.2, (-0.9, 3.0), 0.002),
                parameter("log_tau", "ln samples", tau.ln(), (0.0, 7.0), 0.02),
                parameter("log_rho", "1", 1.6, (0.4, 3.0), 0.02),
            ]
        })
        .collect();
    Variant::conditional(starts, move |p, augmented| {
        let poles = poles(p);
        let without = |left_out: Option<usize>| {
            let others = poles.iter().enumerate().filter(|(k, _)| Some(*k) != left_out);
            others.fold(vec![1.0], |product, (_, pole)| convolve(&product, &[1.0, -pole]))
        };
        let denominator = without(None);
        let mut numerator = denominator.clone();
        for (k, pole) in poles.iter().enumerate() {
            let weight = 0.25 * p[0] * (1.0 - pole);
            numerator.iter_mut().zip(without(Some(k))).for_each(|(n, w)| *n += weight * w);
        }
        augmented.filter(&numerator, &denominator);
        for &scaled in &scaled_records {
            for radius in [poles[2], poles[3]] {
                let decay = EquationColumn::Decay { scaled, radius, frequency: 0.0, sine: false };
                augmented.equation_columns.push(decay);
            }
        }
    })
}
