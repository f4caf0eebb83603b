//! A lightly damped mode.
//!
//! ```text
//! A y = B⁺/(1 − 2ρ cos ω q⁻¹ + ρ² q⁻²) u + ξ,   ρ = exp(−ζω/√(1−ζ²)),   B⁺ with two more coefficients than B
//! ```
//!
//! Parameters: angular frequency `omega` of the ringing (radians per sample), damping ratio `zeta` (0.003…0.6: beyond that
//! nothing rings, and two real poles are an extra lag). Stage: dynamics. Ringing after every move. Confused with: extra pole, input delay. The equation error passes the mode or does not; or two modes ring.

use nalgebra::Complex;

use super::{Card, Follows, Room, Scene, Variant, fitted_scaled_records, outlasts_the_records, parameter};
use crate::effect::{Effect, Stage};
use crate::likelihood::engine::{Fit, NonlinearParameter};
use crate::model::augmented::EquationColumn;
use switchback_model::spectrum::strongest_lines;

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::ExtraPole, Effect::InputDelay],
    follows: Some(Follows::Steps),
    room: Some(Room::Order),
    // Two poles and a zero that are free follow the lines, lags and frictions of others to a good part.
    is_noise_in_disguise: is_coloured_noise,
    ..Card::of(Stage::Dynamics, variants)
};

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    // A mode rings in the residual: its lines are the likeliest frequencies.
    let mut lines: Vec<f64> = Vec::new();
    for line in strongest_lines(scene.innovations, CANDIDATES).into_iter().filter(|w| *w > 0.1) {
        // A mode is as broad as several lines.
        if lines.len() < LINES && lines.iter().all(|l| (l - line).abs() > APART) {
            lines.push(line);
        }
    }
    let sharp = lines.iter().map(|w| mode(*w, SHARP).to_vec());
    let blunt = lines.iter().chain(&ELSEWHERE).map(|w| mode(*w, BLUNT).to_vec());
    let alone: Vec<Vec<NonlinearParameter>> = blunt.chain(sharp).collect();
    let mut two = Vec::new();
    for (k, one) in lines.iter().enumerate() {
        let elsewhere = if k == 0 { &ELSEWHERE[..] } else { &[] };
        let others = lines[k + 1..].iter().chain(elsewhere).filter(|w| (*w - one).abs() > APART);
        two.extend(others.map(|other| [mode(*one, SHARP), mode(*other, SHARP)].concat()));
    }
    let laws = [(alone.clone(), false), (alone, true), (two, false)];
    let laws = laws.into_iter().filter(|(starts, _)| !starts.is_empty());
    // Every line is a valley of its own.
    let ringing = |(starts, passes)| ringing(fitted_scaled_records(scene.dataset), starts, passes);
    laws.map(ringing)
        .map(|law| law.sound_if(|_, fit| !outlasts_the_records(fit)))
        .map(|law| Variant { climbs: LINES + 1, ..law })
        .collect()
}

/// Lines of the residual that a search starts from, and frequencies without a line.
const LINES: usize = 3;
/// Lines among which these are looked for, and how far they are apart in radians a sample.
const CANDIDATES: usize = 24;
const APART: f64 = 0.08;
const ELSEWHERE: [f64; 4] = [0.35, 0.75, 1.2, 1.8];
/// Pole radii that a search starts from.
const SHARP: f64 = 0.97;
const BLUNT: f64 = 0.91;

fn mode(omega: f64, radius: f64) -> [NonlinearParameter; 2] {
    let zeta = damping(radius, omega).min(0.4);
    [
        parameter("omega", "radians per sample", omega, (0.03, 3.1), 0.003),
        parameter("zeta", "1", zeta, (0.003, 0.6), 0.002),
    ]
}

/// Modes one after the other, `omega` and `zeta` each.
fn ringing(scaled_records: Vec<usize>, starts: Vec<Vec<NonlinearParameter>>, passes: bool) -> Variant {
    Variant::conditional(starts, move |p, augmented| {
        for mode in p.chunks_exact(2) {
            let (frequency, radius) = (mode[0], radius(mode[1], mode[0]));
            let poles = [1.0, -2.0 * radius * frequency.cos(), radius * radius];
            augmented.filter(&[1.0], &poles);
            augmented.extra_b += 2;
            // The mode rings when a record begins, nobody knows how.
            for &scaled in &scaled_records {
                for sine in [false, true] {
                    let ring = EquationColumn::Decay { scaled, radius, frequency, sine };
                    augmented.equation_columns.push(ring);
                }
            }
            if passes {
                augmented.noise.ar = crate::model::augmented::times_monic(&augmented.noise.ar, &poles[1..]);
            }
        }
    })
}

/// Least pole radius: below it a mode dies within few samples, and any short memory would pass for one.
const DEAD: f64 = 0.6;

/// Pole radius of a mode with damping ratio `zeta` that rings at `omega`.
fn radius(zeta: f64, omega: f64) -> f64 {
    (-zeta * omega / (1.0 - zeta * zeta).sqrt()).exp().max(DEAD)
}

/// Damping ratio of a mode with pole radius `rho` that rings at `omega`.
fn damping(rho: f64, omega: f64) -> f64 {
    -rho.ln() / rho.ln().hypot(omega)
}

/// Whether a mode that the equation error passes is no mode but the plant's own, and the colour of its noise in the place of the
/// plant's dynamics: `A` then has a pole that `B⁺` undoes.
///
/// ```text
/// A y = B u + ξ/D   ⟺   D·A y = D·B u + ξ
/// ```
fn is_coloured_noise(fit: &Fit) -> bool {
    let passes = !fit.augmented.noise.ar.is_empty();
    let b = &fit.linear.b;
    passes && fit.linear.poles().into_iter().any(|pole| pole.norm() > LASTING && undone(b, pole) < UNDONE)
}

/// Least magnitude of a pole that colours noise much, and how near a zero must be.
const LASTING: f64 = 0.15;
const UNDONE: f64 = 0.02;

/// `|Σ bⱼ z⁻ʲ|` over its largest possible value.
fn undone(b: &[f64], pole: Complex<f64>) -> f64 {
    let terms = || (0..b.len()).map(|j| pole.powi(-(j as i32)) * b[j]);
    let most: f64 = terms().map(|term| term.norm()).sum();
    terms().sum::<Complex<f64>>().norm() / most.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::linear::Linear;

    #[test]
    fn a_pole_that_the_numerator_undoes_is_found() {
        // (1 − 0.7 q⁻¹)(1 − 0.2 q⁻¹), and a numerator with and without the first factor.
        let poles = Linear { a: vec![-0.9, 0.14], ..Linear::default() }.poles();
        assert_eq!(poles.len(), 2);
        let least = |b: &[f64]| poles.iter().map(|z| undone(b, *z)).fold(1.0, f64::min);
        assert!(least(&[1.0, -0.4, -0.21]) < 1e-9);
        assert!(least(&[1.0, 0.5, 0.3]) > 0.1);
    }

    #[test]
    fn damping_and_radius_undo_each_other() {
        for (rho, omega) in [(0.91, 0.35), (0.99, 2.0), (0.7, 0.9)] {
            assert!((radius(damping(rho, omega), omega) - rho).abs() < 1e-12);
        }
    }
}
