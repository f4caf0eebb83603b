//! The nominal system of a rig, drawn at random over wide ranges.

mod draw;
mod shape;
mod table;

pub(crate) use draw::CURVED;
pub use draw::Family;
pub(crate) use draw::multiply;
pub use shape::Shape;
pub(crate) use table::Table;

use switchback_model::hysteresis::{Interval, SwitchedHysteresis};

/// A nominal system: the switched hysteresis on its interval, the linear part, and the noise.
///
/// `A(q⁻¹) y(t) = B(q⁻¹) u(t) + ξ(t)` with `u = F[v]`, `u_M − u_m = 1`, `ξ` white, Gaussian, of standard deviation `noise_sd`.
/// Borders are straight between the levels, so that a nominal model with hat functions there has no gap; or they are curved, so
/// that no table has none and a fine one hardly any.
#[derive(Debug, Clone)]
pub struct Machine {
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// `b₁…bₙ`, output units per unit of `u`.
    pub b: Vec<f64>,
    /// The operator `F`.
    pub hysteresis: SwitchedHysteresis,
    /// The working interval, input units.
    pub interval: Interval,
    /// The levels of the pulse experiments with both satellites, increasing.
    pub levels: Vec<f64>,
    /// Standard deviation of the white equation error, output units.
    pub noise_sd: f64,
    /// Most that the noise-free output leaves [`Machine::y_centre`] during the dataset, output units.
    pub reach: f64,
    /// Seconds between samples.
    pub sample_time: f64,
    /// Shape that the borders were drawn from.
    pub shape: Shape,
    /// Whether the borders are curved between the levels too.
    pub curved: bool,
}

impl Machine {
    /// Order `n` of the linear part.
    pub(crate) fn order(&self) -> usize {
        self.a.len()
    }

    /// Stationary gain `B(1)/A(1)`.
    pub(crate) fn gain(&self) -> f64 {
        self.b.iter().sum::<f64>() / (1.0 + self.a.iter().sum::<f64>())
    }

    /// Stationary output midway between both satellites'.
    pub(crate) fn y_centre(&self) -> f64 {
        self.gain() * 0.5 * (self.hysteresis.u_low() + self.hysteresis.u_high())
    }

    /// Half of what the stationary output spans between the satellites; positive.
    pub(crate) fn y_half(&self) -> f64 {
        0.5 * self.gain().abs()
    }

    /// Impulse response of `1/A`, as long as it matters.
    pub(crate) fn noise_response(&self) -> Vec<f64> {
        impulse_response(&self.a)
    }

    /// Output noise sd over equation noise sd: `√Σe²`, `e` the impulse response of `1/A`.
    pub(crate) fn noise_amplification(&self) -> f64 {
        amplification(&self.a)
    }

    /// Samples after which a transient has fallen below 10⁻⁶ of its start.
    pub(crate) fn settling(&self) -> usize {
        self.noise_response().len()
    }
}

/// Standard deviation of white noise of unit variance behind `1/A`: `√Σe²`.
pub(crate) fn amplification(a: &[f64]) -> f64 {
    impulse_response(a).iter().map(|e| e * e).sum::<f64>().sqrt()
}

/// Impulse response of `1/A` until it has stayed below 10⁻⁶ for the length of `a`, at most 2,000 samples.
fn impulse_response(a: &[f64]) -> Vec<f64> {
    let mut e = vec![1.0];
    while e.len() < 2000 {
        let next: f64 = a
            .iter()
            .enumerate()
            .map(|(i, ai)| if e.len() > i { -ai * e[e.len() - 1 - i] } else { 0.0 })
            .sum();
        e.push(next);
        if e.iter().rev().take(a.len() + 2).all(|x: &f64| x.abs() < 1e-6) {
            break;
        }
    }
    e
}
