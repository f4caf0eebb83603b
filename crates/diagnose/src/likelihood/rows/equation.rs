//! Disturbance columns of the equation.

use std::f64::consts::PI;

use super::clock;
use crate::model::augmented::{AugmentedModel, EquationColumn};
use crate::records::dataset::{Dataset, ScaledRecord};

/// The equation columns that act on one record.
#[derive(Debug, Clone)]
pub(crate) struct EquationColumns {
    /// Their numbers among all columns, increasing: most of these are those of other records.
    pub(crate) numbers: Vec<usize>,
    /// Row-major, as many a sample as there are numbers.
    values: Vec<f64>,
}

impl EquationColumns {
    /// The values at a sample.
    #[inline]
    pub(crate) fn row(&self, t: usize) -> &[f64] {
        let count = self.numbers.len();
        &self.values[t * count..(t + 1) * count]
    }

    /// Coefficients of the columns here, given those of all.
    pub(crate) fn coefficients(&self, all: &[f64]) -> Vec<f64> {
        self.numbers.iter().map(|&j| all[j]).collect()
    }
}

/// The equation columns of one record.
pub(crate) fn equation_columns(
    dataset: &Dataset,
    (number, scaled): (usize, &ScaledRecord),
    augmented: &AugmentedModel,
) -> EquationColumns {
    let all = &augmented.equation_columns;
    let numbers: Vec<usize> = (0..all.len()).filter(|&j| all[j].acts_on(number)).collect();
    let count = numbers.len();
    let mut out = vec![0.0; scaled.v.len() * count];
    for (k, &j) in numbers.iter().enumerate() {
        let cells = out.iter_mut().skip(k).step_by(count);
        match all[j] {
            EquationColumn::Line { frequency, scaled: only, sine } => {
                let first = if only.is_some() { 0.0 } else { scaled.clock as f64 };
                let mut wave = Wave::starting(frequency, first);
                cells.for_each(|cell| *cell = wave.next(sine));
            }
            EquationColumn::Trend { clock: c, degree } => cells.enumerate().for_each(|(t, cell)| {
                let at = clock(c, dataset, scaled, t, scaled.moves[t].path);
                *cell = (2.0 * at - 1.0).powi(degree as i32);
            }),
            EquationColumn::Gain => {
                let Some(gain) = &augmented.gain else { continue };
                cells.enumerate().for_each(|(t, cell)| {
                    *cell = gain.at(clock(gain.clock, dataset, scaled, t, scaled.moves[t].path));
                });
            }
            EquationColumn::Decay { radius, frequency, sine, .. } => {
                let mut wave = Wave::starting(frequency, 0.0);
                let mut size = 1.0;
                let from = scaled.from.min(6);
                for (t, cell) in cells.enumerate() {
                    let value = size * wave.next(sine);
                    *cell = if t < from { 0.0 } else { value };
                    size *= radius;
                    if size < 1e-9 {
                        break;
                    }
                }
            }
            EquationColumn::Local { piece, pieces, .. } => cells.enumerate().for_each(|(t, cell)| {
                let at = t as f64 / scaled.v.len() as f64 * pieces as f64;
                *cell = (1.0 - (at - piece as f64).abs()).max(0.0);
            }),
            EquationColumn::Offset { scaled: only, .. } => {
                let sign = if only == number { 1.0 } else { -1.0 };
                cells.for_each(|cell| *cell = sign);
            }
        }
    }
    EquationColumns { numbers, values: out }
}

/// A sinusoid sample by sample, by rotation; set anew every so often, so that rounding does not add up.
struct Wave {
    frequency: f64,
    at: f64,
    left: usize,
    turn: (f64, f64),
    now: (f64, f64),
}

impl Wave {
    /// Samples between exact values.
    const AFRESH: usize = 256;

    fn starting(frequency: f64, at: f64) -> Self {
        Self { frequency, at, left: 0, turn: frequency.sin_cos(), now: (0.0, 1.0) }
    }

    fn next(&mut self, sine: bool) -> f64 {
        if self.left == 0 {
            self.now = ((self.frequency * self.at) % (2.0 * PI)).sin_cos();
            self.left = Self::AFRESH;
        }
        let (s, c) = self.now;
        let (ds, dc) = self.turn;
        self.now = (s * dc + c * ds, c * dc - s * ds);
        self.left -= 1;
        self.at += 1.0;
        if sine { s } else { c }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_by_rotation_is_the_wave() {
        let mut wave = Wave::starting(0.37, 1200.0);
        for t in 1200..3000 {
            let exact = (0.37 * f64::from(t)).sin();
            assert!((wave.next(true) - exact).abs() < 1e-11, "{t}");
        }
    }
}
