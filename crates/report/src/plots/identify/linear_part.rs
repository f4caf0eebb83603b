//! The linear part of an estimate: frequency and step response, poles and zeros, with the standard errors that those of the coefficients
//! give them.

use std::f64::consts::{PI, TAU};
use switchback_io::identification::json::EstimateFile;
use switchback_io::model::ModelFile;
use switchback_model::linear::{
    filter, frequency_response, is_stable, roots, settling_samples, spectral_radius,
};

/// Frequencies of a Bode diagram.
const FREQUENCIES: usize = 160;
/// Samples of a step response at least and at most.
const STEP: (usize, usize) = (20, 600);

/// Values over something, with their standard errors where these are known.
#[derive(Debug)]
pub(super) struct Curve {
    pub(super) x: Vec<f64>,
    pub(super) values: Vec<f64>,
    pub(super) errors: Option<Vec<f64>>,
}

/// A pole or a zero: real and imaginary part, and their standard errors where these are known.
#[derive(Debug)]
pub(crate) struct Root {
    pub(crate) at: (f64, f64),
    pub(crate) se: Option<(f64, f64)>,
}

/// The linear part of an estimate; `model` knows the covariance of its coefficients.
#[derive(Debug)]
pub(crate) struct LinearPart<'a> {
    pub(super) estimate: &'a EstimateFile,
    model: Option<&'a ModelFile>,
}

impl<'a> LinearPart<'a> {
    /// That of an estimate; `None` where its coefficients are not known.
    pub(crate) fn of(estimate: &'a EstimateFile, model: Option<&'a ModelFile>) -> Option<Self> {
        let is_known = estimate.a.iter().chain(&estimate.b).all(|x| x.is_finite()) && !estimate.b.is_empty();
        is_known.then_some(Self { estimate, model })
    }

    /// Whether anything has a standard error.
    pub(crate) fn has_errors(&self) -> bool {
        self.figure(|a, _| a.to_vec()).1.is_some()
    }

    /// Hertz of radians a sample.
    pub(crate) fn hertz(&self, omega: f64) -> f64 {
        omega / (TAU * self.estimate.sample_time)
    }

    /// Poles and zeros.
    pub(crate) fn roots(&self) -> [Vec<Root>; 2] {
        let poles = self.figure(|a, _| flat(&roots(&[&[1.0], a].concat())));
        let zeros = self.figure(|_, b| flat(&roots(b)));
        // A root keeps its place in the list while its parameters move a thousandth of their errors; two that meet do not, and their
        // errors mean nothing.
        [poles, zeros].map(|(values, errors)| {
            let pair = |k: usize, of: &[f64]| (of[2 * k], of[2 * k + 1]);
            (0..values.len() / 2)
                .map(|k| Root { at: pair(k, &values), se: errors.as_ref().map(|e| pair(k, e)) })
                .collect()
        })
    }

    /// Gain in decibels over hertz.
    pub(super) fn gain(&self) -> Curve {
        self.over_frequency(|response| {
            response.iter().map(|response| 20.0 * response.norm().log10()).collect()
        })
    }

    /// Phase in degrees over hertz.
    pub(super) fn phase(&self) -> Curve {
        self.over_frequency(|response| unwrapped(response.iter().map(|response| response.arg())))
    }

    /// Output over seconds after a step of `u` from `u_m` to `u_m + 1`.
    pub(super) fn step(&self) -> Curve {
        let (a, delay) = (&self.estimate.a, self.estimate.delay);
        let settled = if is_stable(a) { settling_samples(a, 1e-3) } else { STEP.1 };
        let length = (settled + settled / 5 + delay.unsigned_abs()).clamp(STEP.0, STEP.1);
        let x = (0..length).map(|t| t as f64 * self.estimate.sample_time).collect();
        let (values, errors) = self.figure(|a, b| step(a, b, delay, length));
        Curve { x, values, errors }
    }

    /// A figure of `(a, b)` with its errors.
    fn figure(&self, of: impl Fn(&[f64], &[f64]) -> Vec<f64>) -> (Vec<f64>, Option<Vec<f64>>) {
        match self.model {
            Some(model) => model.system.of_linear(of),
            None => (of(&self.estimate.a, &self.estimate.b), None),
        }
    }

    /// A figure of the frequency response, from well below the slowest pole to half the sampling rate.
    fn over_frequency(&self, of: impl Fn(&[nalgebra::Complex<f64>]) -> Vec<f64>) -> Curve {
        let slowest = spectral_radius(&self.estimate.a).clamp(1e-6, 1.0 - 1e-6);
        let low = (-slowest.ln() / 30.0).clamp(1e-6, 0.03);
        let omega = |k: usize| low * (PI / low).powf(k as f64 / (FREQUENCIES - 1) as f64);
        let omegas: Vec<f64> = (0..FREQUENCIES).map(omega).collect();
        let (values, errors) = self.figure(|a, b| {
            let response = |w: &f64| frequency_response(a, b, self.estimate.delay, *w);
            of(&omegas.iter().map(response).collect::<Vec<_>>())
        });
        Curve { x: omegas.iter().map(|w| self.hertz(*w)).collect(), values, errors }
    }
}

fn flat(roots: &[nalgebra::Complex<f64>]) -> Vec<f64> {
    roots.iter().flat_map(|root| [root.re, root.im]).collect()
}

fn step(a: &[f64], b: &[f64], delay: isize, length: usize) -> Vec<f64> {
    let y = filter(a, b, &vec![1.0; length + delay.min(0).unsigned_abs()], &[], 0.0, 0.0);
    let at = |t: isize| usize::try_from(t).ok().and_then(|t| y.get(t).copied()).unwrap_or(0.0);
    (0..length as isize).map(|t| at(t - delay)).collect()
}

/// Angles in degrees without jumps of a turn.
fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut before: Option<f64> = None;
    let mut turned = |angle: f64| {
        let angle = before.map_or(angle, |before| angle + TAU * ((before - angle) / TAU).round());
        before = Some(angle);
        angle.to_degrees()
    };
    angles.map(&mut turned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_comes_as_late_as_the_delay_says() {
        // 1 − 0.5ᵗ, one sample late.
        assert_eq!(step(&[-0.5], &[0.5], 0, 4), [0.0, 0.5, 0.75, 0.875]);
        assert_eq!(step(&[-0.5], &[0.5], 2, 4), [0.0, 0.0, 0.0, 0.5]);
        assert_eq!(step(&[-0.5], &[0.5, 0.0], -1, 3), [0.5, 0.75, 0.875]);
    }

    #[test]
    fn a_phase_has_no_jumps() {
        let lag = unwrapped((0..100).map(|k| (-0.2 * f64::from(k)).sin().atan2((-0.2 * f64::from(k)).cos())));
        assert!((lag[99] - (-0.2f64 * 99.0).to_degrees()).abs() < 1e-9);
    }
}
