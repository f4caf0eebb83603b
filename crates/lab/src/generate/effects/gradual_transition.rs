//! `gradual_transition`: after a reversal the working point crosses over to the other border along a travel.
//!
//! All laws move `z` from ±1 to ∓1 and put `u = mid(v) + z·half(v)`; the switch is `z = sgn Δv`.

use super::card;
use super::motion::{directions, half_width, moves};
use crate::generate::law::{INTERVAL_WIDTHS, Law, Scene};

pub(super) static LAWS: [&dyn Law; 4] = [&Exponential, &Dahl, &BoucWen, &MaxwellSlip];

/// Shorter than this, in widths, the effect falls between the samples of a moving input.
const SHORTEST: f64 = 0.01;

/// `dz = (s − z)·|dv|/λ`, solved exactly over a step.
#[derive(Debug)]
struct Exponential;

impl Law for Exponential {
    card!("gradual_transition", "exponential", Operator, INTERVAL_WIDTHS, 1.0);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let length = scene.x();
        blend(scene, v, u, |z, s, travel| s + (z - s) * (-travel / length).exp());
    }
}

/// Dahl's friction with exponent 1/2: `dz = s·√(1 − z·s)·|dv|/λ`, which arrives after a finite travel.
///
/// P. R. Dahl, "Solid friction damping of mechanical vibrations", AIAA J. 14(12), 1976.
#[derive(Debug)]
struct Dahl;

impl Law for Dahl {
    card!("gradual_transition", "Dahl, exponent 1/2", Operator, INTERVAL_WIDTHS, 1.0);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let length = scene.x();
        blend(scene, v, u, |z, s, travel| {
            let root = ((1.0 - z * s).max(0.0).sqrt() - 0.5 * travel / length).max(0.0);
            s * (1.0 - root * root)
        });
    }
}

/// Bouc–Wen with exponent 2: `dz = (s − (β·s + γ·sgn z)·z²·…)|dv|/λ`, `β + γ = 1`.
///
/// Y. K. Wen, "Method for random vibration of hysteretic systems", J. Eng. Mech. 102(2), 1976.
#[derive(Debug)]
struct BoucWen;

impl Law for BoucWen {
    card!("gradual_transition", "Bouc-Wen, exponent 2", Operator, INTERVAL_WIDTHS, 1.0);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let length = scene.x();
        let beta = scene.amount.between(0, 0.5, 0.9);
        blend(scene, v, u, |z, s, travel| {
            let slope = |z: f64| s - (beta * s * z.abs() + (1.0 - beta) * z) * z.abs();
            // z is within 10⁻⁹ of s after 12 lengths; Heun's rule over steps of at most λ/20.
            let travel = (travel / length).min(12.0);
            let steps = (20.0 * travel).ceil().max(1.0);
            let h = travel / steps;
            let mut z = z;
            for _ in 0..steps as usize {
                let first = slope(z);
                z += 0.5 * h * (first + slope(z + h * first));
            }
            z.clamp(-1.0, 1.0)
        });
    }
}

/// Five elastic sliders that let go one after another; their mean remembers every nested reversal (Maxwell–Iwan).
#[derive(Debug)]
struct MaxwellSlip;

impl Law for MaxwellSlip {
    card!("gradual_transition", "Maxwell slip", Operator, INTERVAL_WIDTHS, 1.0);

    fn least(&self) -> f64 {
        SHORTEST
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        if scene.x() == 0.0 {
            return;
        }
        let directions = directions(scene.machine, v);
        let moves = moves(scene.machine, v);
        let mut sliders = [directions[0]; 5];
        for t in 0..v.len() {
            for (k, z) in sliders.iter_mut().enumerate() {
                let reach = scene.x() * 0.4 * (k + 1) as f64; // travel from one end to the centre
                *z = (*z + moves[t] / reach).clamp(-1.0, 1.0);
            }
            let z = sliders.iter().sum::<f64>() / 5.0;
            u[t] += (z - directions[t]) * half_width(scene.machine, v[t]);
        }
    }
}

/// Runs `z ← step(z, s, |Δv|)` along the motion and adds what it changes of `u`.
fn blend(scene: &Scene<'_>, v: &[f64], u: &mut [f64], step: impl Fn(f64, f64, f64) -> f64) {
    if scene.x() == 0.0 {
        return;
    }
    let directions = directions(scene.machine, v);
    let moves = moves(scene.machine, v);
    let mut z = directions[0];
    for t in 0..v.len() {
        if moves[t] != 0.0 {
            z = step(z, directions[t], moves[t].abs());
        }
        u[t] += (z - directions[t]) * half_width(scene.machine, v[t]);
    }
}
