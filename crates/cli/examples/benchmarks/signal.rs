//! Periodic signals by their lines.

use crate::estimation::rms;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;
use std::f64::consts::TAU;

/// Samples of one period, evenly spaced.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Period(pub(crate) Vec<f64>);

impl Period {
    /// Lines of equal amplitude and random phases between two of them, scaled to a root mean square.
    pub(crate) fn multisine(
        rng: &mut ChaCha8Rng,
        samples: usize,
        (first, last): (usize, usize),
        rms: f64,
    ) -> Self {
        let mut lines = vec![Complex64::ZERO; samples / 2 + 1];
        lines[first..=last].fill_with(|| Complex64::from_polar(1.0, TAU * rng.random::<f64>()));
        let mut signal = Self::of_lines(lines, samples);
        let factor = rms / signal.rms();
        signal.0.iter_mut().for_each(|x| *x *= factor);
        signal
    }

    pub(crate) fn rms(&self) -> f64 {
        rms(self.0.iter().copied())
    }

    /// Every `step`th sample.
    pub(crate) fn every(&self, step: usize) -> Self {
        Self(self.0.iter().copied().step_by(step).collect())
    }

    /// The lines up to `last`, on `factor` times as many samples.
    pub(crate) fn resampled(&self, factor: usize, last: usize) -> Self {
        let samples = self.0.len();
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(samples);
        let (mut input, mut lines) = (self.0.clone(), transform.make_output_vec());
        transform.process(&mut input, &mut lines).expect("the lengths are the plan's");
        lines.truncate(last + 1);
        lines.resize(factor * samples / 2 + 1, Complex64::ZERO);
        lines.iter_mut().for_each(|line| *line /= samples as f64);
        Self::of_lines(lines, factor * samples)
    }

    /// `x(t) = Σ Re …` of the lines of a transform.
    fn of_lines(mut lines: Vec<Complex64>, samples: usize) -> Self {
        let transform = RealFftPlanner::<f64>::new().plan_fft_inverse(samples);
        let mut signal = transform.make_output_vec();
        transform
            .process(&mut lines, &mut signal)
            .expect("lines at rest and at the highest frequency are real");
        Self(signal)
    }
}
