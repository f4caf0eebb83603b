//! The linear part, of unit gain at rest.

use super::delayed::delayed;
use super::modes::Mode;
use crate::linear::{is_stable, recurse};
use nalgebra::{DMatrix, DVector};

/// `x(t) = Σ bᵢ u(t − lag − delay − i) − Σ aᵢ x(t − 1 − i)` with `Σb = 1 + Σa`.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearPart {
    a: Vec<f64>,
    /// Its poles, in an order that changes of their values leave.
    modes: Vec<Mode>,
    /// All but the first, which the gain at rest fixes.
    b: Vec<f64>,
    /// Samples between the newest input and the output; negative where the output shows it first.
    lag: isize,
    /// Further delay, any share of a sample.
    pub delay: f64,
}

impl LinearPart {
    /// From the coefficients of any gain; none if `A` is unstable or `B(1)` is zero. The second value is the gain at rest.
    pub fn new(a: &[f64], b: &[f64], lag: isize) -> Option<(Self, f64)> {
        let at_rest = 1.0 + a.iter().sum::<f64>();
        let gain = b.iter().sum::<f64>() / at_rest;
        let usable = is_stable(a) && gain.is_finite() && gain != 0.0 && !b.is_empty();
        let b = b.iter().skip(1).map(|b| b / gain).collect();
        usable.then(|| (Self { a: a.to_vec(), modes: Mode::of(a), b, lag, delay: 0.0 }, gain))
    }

    /// `a₁…aₙ`.
    pub fn a(&self) -> &[f64] {
        &self.a
    }

    /// Every numerator coefficient.
    pub fn b(&self) -> Vec<f64> {
        let rest: f64 = self.b.iter().sum();
        let first = 1.0 + self.a.iter().sum::<f64>() - rest;
        std::iter::once(first).chain(self.b.iter().copied()).collect()
    }

    /// Samples between the newest input and the output.
    pub fn lag(&self) -> isize {
        self.lag
    }

    /// The free numbers: `a`, then `b` without the first.
    pub fn coefficients(&self) -> usize {
        self.a.len() + self.b.len()
    }

    /// One of the free numbers.
    pub fn coefficient(&self, index: usize) -> f64 {
        let order = self.a.len();
        if index < order { self.a[index] } else { self.b[index - order] }
    }

    /// Sets one of the free numbers.
    pub fn set_coefficient(&mut self, index: usize, value: f64) {
        let order = self.a.len();
        if index < order {
            self.a[index] = value;
            self.modes = Mode::of(&self.a);
        } else {
            self.b[index - order] = value;
        }
    }

    /// The largest lag of its numerator, samples; zero where its inputs are present or future ones.
    pub fn largest_lag(&self) -> usize {
        (self.lag + self.b.len() as isize).max(0).unsigned_abs()
    }

    /// Whether its output stays bounded.
    pub fn is_stable(&self) -> bool {
        is_stable(&self.a)
    }

    /// Its poles: slowest first, unless their values were changed since.
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// The same numerator, up to its scale, over other poles.
    #[must_use]
    pub fn with_modes(&self, modes: &[Mode]) -> Self {
        let a = Mode::polynomial(modes);
        let ratio = (1.0 + a.iter().sum::<f64>()) / (1.0 + self.a.iter().sum::<f64>());
        Self { a, modes: modes.to_vec(), b: self.b.iter().map(|b| b * ratio).collect(), ..self.clone() }
    }

    /// The same with another value of a mode. As much of the numerator as is the mode behind a zero-order hold, `B = Q·N + rest` with `Q` of least squares,
    /// follows it: the zeros of sampling move with the poles.
    ///
    /// # Panics
    /// If there is no such mode.
    #[must_use]
    pub fn with_mode(&self, at: usize, mode: Mode) -> Self {
        let mut modes = self.modes.clone();
        let before = std::mem::replace(&mut modes[at], mode);
        let (old, new) = (before.sampled(), mode.sampled());
        let b = self.b();
        let Some(rest) = b.len().checked_sub(old.len()).filter(|_| old.len() == new.len()) else {
            return self.with_modes(&modes);
        };
        let shifted = |n: &[f64]| {
            DMatrix::from_fn(b.len(), rest + 1, |i, j| {
                i.checked_sub(j).and_then(|k| n.get(k)).copied().unwrap_or(0.0)
            })
        };
        let (old, new) = (shifted(&old), shifted(&new));
        let b = DVector::from_vec(b);
        let Some(factor) = old.tr_mul(&old).cholesky() else { return self.with_modes(&modes) };
        let share = factor.solve(&old.tr_mul(&b));
        let moved = &b + (new - old) * share;
        // Of the gain at rest that its own poles ask for, from which other ones scale it.
        let scale = (1.0 + self.a.iter().sum::<f64>()) / moved.sum();
        let b = moved.iter().skip(1).map(|b| b * scale).collect();
        Self { b, ..self.clone() }.with_modes(&modes)
    }

    /// The same system with room for other delays: its numerator reaches from the present sample, or from where it did, to one sample more than it did.
    #[must_use]
    pub fn widened(&self) -> Self {
        let lag = self.lag.min(0);
        let earlier = (self.lag - lag).unsigned_abs();
        let b = [&vec![0.0; earlier][..], &self.b(), &[0.0]].concat();
        Self { b: b[1..].to_vec(), lag, ..self.clone() }
    }

    /// The same with one pole more, fast or as slow as its slowest one, and a numerator longer by one coefficient.
    pub fn larger(&self) -> Vec<Self> {
        let with = |pole: f64| {
            let modes = [self.modes.clone(), vec![Mode::Real(pole)]].concat();
            let mut larger = self.with_modes(&modes);
            larger.b.push(0.0);
            larger
        };
        [0.3, crate::linear::spectral_radius(&self.a).min(0.99)].map(with).into()
    }

    /// The same without the first or without the last coefficient of the numerator.
    fn shorter(&self) -> Vec<Self> {
        let b = self.b();
        let without = |b: &[f64], lag| {
            let (part, _) = Self::new(&self.a, b, lag)?;
            Some(Self { modes: self.modes.clone(), delay: self.delay, ..part })
        };
        if b.len() < 2 {
            return Vec::new();
        }
        [without(&b[1..], self.lag + 1), without(&b[..b.len() - 1], self.lag)].into_iter().flatten().collect()
    }

    /// The same with one mode fewer, and a numerator shorter by as many coefficients where it has them, every choice of the mode but the last one; and with a numerator shorter by one coefficient at either end.
    pub fn smaller(&self) -> Vec<Self> {
        let without = |k: usize| {
            let mut modes = self.modes.clone();
            let poles = match modes.remove(k) {
                Mode::Real(_) => 1,
                Mode::Pair { .. } => 2,
            };
            let mut fewer = self.with_modes(&modes);
            fewer.b.truncate(self.b.len().saturating_sub(poles));
            fewer
        };
        let all = (0..self.modes.len()).map(without);
        all.filter(|part| !part.a.is_empty()).chain(self.shorter()).collect()
    }

    /// The output for an input that has rested at its first value.
    pub fn run(&self, u: &[f64]) -> Vec<f64> {
        let Some(last) = u.len().checked_sub(1) else { return Vec::new() };
        let late;
        let u = if self.delay == 0.0 {
            u
        } else {
            late = delayed(u, self.delay);
            &late
        };
        let b = self.b();
        // Before its first sample and behind its last one the input keeps its ends.
        let mut x = vec![0.0; u.len()];
        for (i, b) in b.iter().enumerate() {
            let shift = self.lag + i as isize;
            let at = |t: usize| u[(t as isize - shift).clamp(0, last as isize) as usize];
            let from = shift.clamp(0, u.len() as isize) as usize;
            let to = (u.len() as isize + shift.min(0)).max(from as isize) as usize;
            (0..from).chain(to..u.len()).for_each(|t| x[t] += b * at(t));
            if from < to {
                let inner = &u[(from as isize - shift) as usize..];
                x[from..to].iter_mut().zip(inner).for_each(|(x, u)| *x += b * u);
            }
        }
        let order = self.a.len().min(x.len());
        for t in 0..order {
            for (i, a) in self.a.iter().enumerate() {
                let before = if t > i { x[t - 1 - i] } else { u[0] };
                x[t] -= a * before;
            }
        }
        recurse(&self.a, &mut x);
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gain_at_rest_is_one_whatever_changes() {
        let (part, gain) = LinearPart::new(&[-1.2, 0.5], &[0.2, 0.4], 1).unwrap();
        assert!((gain - 2.0).abs() < 1e-12);
        let mut other = part.clone();
        other.set_coefficient(0, -1.1);
        other.set_coefficient(2, 0.3);
        other.delay = 0.4;
        let step: Vec<f64> = (0..400).map(|t| if t < 3 { 0.0 } else { 1.0 }).collect();
        for part in [&part, &other, &part.with_modes(&[Mode::Real(0.5), Mode::Real(0.9)])] {
            assert!((part.run(&step)[399] - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn zeros_of_sampling_follow_their_poles() {
        let pair = |frequency, damping| Mode::Pair { frequency, damping };
        let sampled = |mode: Mode, late: f64| {
            let n = mode.sampled();
            let b = [(1.0 - late) * n[0], (1.0 - late) * n[1] + late * n[0], late * n[1]];
            LinearPart::new(&Mode::polynomial(&[mode]), &b, 1).unwrap().0
        };
        for late in [0.0, 0.3] {
            let moved = sampled(pair(0.6, 0.3), late).with_mode(0, pair(0.5, 0.5));
            let expected = sampled(pair(0.5, 0.5), late);
            assert!(moved.b().iter().zip(expected.b()).all(|(x, y)| (x - y).abs() < 1e-12), "{late}");
            assert!(moved.a() == expected.a());
        }
        // A numerator too short for a zero keeps its shape.
        let (short, _) = LinearPart::new(&[-1.2, 0.5], &[1.0], 1).unwrap();
        assert_eq!(short.with_mode(0, pair(0.5, 0.5)), short.with_modes(&[pair(0.5, 0.5)]));
    }

    #[test]
    fn room_for_other_delays_changes_nothing_by_itself() {
        let u: Vec<f64> = (0..60).map(|t| (0.3 * f64::from(t)).sin()).collect();
        for lag in [-1, 0, 2] {
            let (part, _) = LinearPart::new(&[-1.2, 0.5], &[0.2, 0.4], lag).unwrap();
            let wide = part.widened();
            assert!(part.run(&u).iter().zip(wide.run(&u)).all(|(x, y)| (x - y).abs() < 1e-12));
            assert_eq!(wide.b().len() as isize, 3 + (lag - wide.lag()));
            assert!(wide.smaller().iter().all(|fewer| fewer.coefficients() < wide.coefficients()));
        }
    }

    #[test]
    fn it_is_the_difference_equation() {
        let (part, gain) = LinearPart::new(&[-0.7], &[0.4, 0.1], 1).unwrap();
        let u = [1.0, 3.0, -2.0, 0.5, 0.0, 0.0];
        let scaled: Vec<f64> = u.iter().map(|u| u / gain).collect();
        let expected = crate::linear::filter(&[-0.7], &[0.4, 0.1], &scaled, &[], u[0], scaled[0]);
        for (found, expected) in part.run(&u).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12);
        }
    }
}
