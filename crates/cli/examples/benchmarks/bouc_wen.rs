//! The Bouc–Wen oscillator of the benchmark, by its published equations.

use crate::signal::Period;

/// `m·ẍ + c·ẋ + k·x + z = u`, `ż = αẋ − β(γ|ẋ||z|^(ν−1)z + δẋ|z|^ν)` with `ν = 1`.
///
/// J.-P. Noël, M. Schoukens, "Hysteretic benchmark with a dynamic nonlinearity", Workshop on Nonlinear System Identification Benchmarks (2016).
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoucWen {
    mass: f64,
    damping: f64,
    stiffness: f64,
    alpha: f64,
    beta: f64,
    gamma: f64,
    delta: f64,
}

impl BoucWen {
    /// The published values: kg, Ns/m, N/m.
    pub(crate) const PUBLISHED: Self =
        Self { mass: 2.0, damping: 10.0, stiffness: 5e4, alpha: 5e4, beta: 1e3, gamma: 0.8, delta: -1.1 };

    /// One period of the displacement, m, under a periodic force, N, after some periods of transient: the rule of Runge and Kutta of fourth order.
    pub(crate) fn displacement(&self, force: &Period, interval: f64, transient: usize) -> Period {
        let samples = force.0.len();
        let mut state = [0.0; 3];
        let mut run = Vec::with_capacity(samples);
        for t in 0..(transient + 1) * samples {
            if t >= transient * samples {
                run.push(state[0]);
            }
            let ends = [force.0[t % samples], force.0[(t + 1) % samples]];
            state = self.stepped(state, ends, interval);
        }
        Period(run)
    }

    fn stepped(&self, state: [f64; 3], [now, next]: [f64; 2], interval: f64) -> [f64; 3] {
        let middle = 0.5 * (now + next);
        let along = |slope: [f64; 3], share: f64| [0, 1, 2].map(|i| state[i] + share * interval * slope[i]);
        let first = self.slope(state, now);
        let second = self.slope(along(first, 0.5), middle);
        let third = self.slope(along(second, 0.5), middle);
        let fourth = self.slope(along(third, 1.0), next);
        [0, 1, 2].map(|i| state[i] + interval / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]))
    }

    fn slope(&self, [x, speed, z]: [f64; 3], force: f64) -> [f64; 3] {
        let acceleration = (force - self.damping * speed - self.stiffness * x - z) / self.mass;
        let loss = self.beta * (self.gamma * speed.abs() * z + self.delta * speed * z.abs());
        [speed, acceleration, self.alpha * speed - loss]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Without hysteresis it is linear: gain and phase at a frequency are those of its transfer function.
    #[test]
    fn without_hysteresis_it_is_a_linear_oscillator() {
        let linear = BoucWen { beta: 0.0, ..BoucWen::PUBLISHED };
        let (samples, interval) = (750, 1.0 / 15000.0);
        let omega = TAU / (samples as f64 * interval);
        let angle = |t: usize| omega * t as f64 * interval;
        let force = Period((0..samples).map(|t| angle(t).sin()).collect());
        let run = linear.displacement(&force, interval, 400);
        let (stiff, lossy) = (1e5 - 2.0 * omega * omega, 10.0 * omega);
        let size = 1.0 / stiff.hypot(lossy);
        let phase = lossy.atan2(stiff);
        for (t, x) in run.0.iter().enumerate() {
            let exact = size * (angle(t) - phase).sin();
            assert!((x - exact).abs() < 1e-4 * size, "{t}: {x} {exact}");
        }
    }
}
