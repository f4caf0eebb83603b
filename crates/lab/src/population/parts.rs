//! A machine in physical terms, from which its normalised form follows.

use super::borders::{Curves, PLACES};
use crate::generate::machine::{Machine, Shape, Table, multiply};
use switchback_model::hysteresis::{Interval, SwitchedHysteresis};

/// A pole or a pair, by what a physicist says of it; times in samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mode {
    /// A first-order lag.
    Lag { time_constant: f64 },
    /// A damped oscillation, angular frequency in radians a sample.
    Oscillation { frequency: f64, damping: f64 },
}

impl Mode {
    /// Its factor of `A`.
    fn factor(self) -> Vec<f64> {
        match self {
            Self::Lag { time_constant } => vec![1.0, -(-1.0 / time_constant.max(1e-3)).exp()],
            Self::Oscillation { frequency, damping } => {
                let radius = (-damping * frequency).exp();
                let angle = frequency * (1.0 - damping * damping).max(0.0).sqrt();
                vec![1.0, -2.0 * radius * angle.cos(), radius * radius]
            }
        }
    }
}

/// A machine in physical terms.
#[derive(Debug, Clone)]
pub(super) struct Parts {
    pub modes: Vec<Mode>,
    /// Numerator, one number a lag from the first; only the ratios count.
    pub numerator: Vec<f64>,
    /// Output units per unit of the curves, with sign.
    pub gain: f64,
    /// Output where the curves are zero.
    pub offset: f64,
    pub curves: Curves,
    pub interval: Interval,
    /// Cells of the levels.
    pub cells: usize,
    pub sample_time: f64,
}

/// Least distance of `C_a(h_M)` from `C_d(h_m)`, as a share of what the borders span: normalisation divides by it.
const LEAST_SPAN: f64 = 0.2;

impl Parts {
    /// The normalised machine, noise left out; none where its ends lie too close for the paper's normalisation.
    pub(super) fn machine(&self) -> Option<Machine> {
        let (low, width) = (self.interval.low(), self.interval.width());
        let border = |side: f64| -> Vec<f64> {
            self.curves.middle.iter().zip(&self.curves.half).map(|(m, h)| m + side * h).collect()
        };
        let (mut ascending, mut descending) = (border(1.0), border(-1.0));
        let span = ascending[PLACES - 1] - descending[0];
        let all = || ascending.iter().chain(&descending).copied();
        let range = all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min);
        if span.abs() < LEAST_SPAN * range {
            return None;
        }
        let shift = self.offset / self.gain;
        for u in ascending.iter_mut().chain(&mut descending) {
            *u = (*u + shift) / span;
        }
        let polynomial = self.modes.iter().fold(vec![1.0], |p, mode| multiply(&p, &mode.factor()));
        let mut a = polynomial[1..].to_vec();
        let sum: f64 = self.numerator.iter().sum();
        let scale = self.gain * span * polynomial.iter().sum::<f64>() / sum;
        let mut b: Vec<f64> = self.numerator.iter().map(|b| b * scale).collect();
        let order = a.len().max(b.len());
        a.resize(order, 0.0);
        b.resize(order, 0.0);
        let at = |share: f64| low + width * share;
        let levels = (0..PLACES).map(|i| at(i as f64 / (PLACES - 1) as f64)).collect();
        let table = Table { levels, ascending, descending };
        let hysteresis = SwitchedHysteresis::new(self.interval, Box::new(table)).ok()?;
        Some(Machine {
            a,
            b,
            hysteresis,
            interval: self.interval,
            levels: (0..=self.cells).map(|j| at(j as f64 / self.cells as f64)).collect(),
            noise_sd: 0.0,
            reach: 0.0,
            sample_time: self.sample_time,
            shape: Shape::General,
            curved: true,
        })
    }

    /// Order of the linear part.
    pub(super) fn order(&self) -> usize {
        let of = |mode: &Mode| match mode {
            Mode::Lag { .. } => 1,
            Mode::Oscillation { .. } => 2,
        };
        self.modes.iter().map(of).sum()
    }

    /// The slowest time constant in samples.
    pub(super) fn slowest(&self) -> f64 {
        let of = |mode: &Mode| match *mode {
            Mode::Lag { time_constant } => time_constant,
            Mode::Oscillation { frequency, damping } => 1.0 / (frequency * damping),
        };
        self.modes.iter().map(of).fold(0.0, f64::max)
    }
}
