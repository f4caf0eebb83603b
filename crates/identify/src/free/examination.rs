//! What a fit has to say against itself, its errors aside.

use super::basis::Basis;
use super::normalise::{Span, has_gain};
use super::problem::{Parameters, Structure};
use super::warning::Warning;
use switchback_model::hysteresis::Branch;
use switchback_model::reversal::SensorNoise;
use switchback_model::reversal::Stroke;

/// A knot with fewer samples beside it than this is reported.
const FEW_SAMPLES: usize = 10;
/// Share of the working interval up to which a threshold is that of rounding in arithmetic.
const ROUNDING: f64 = 1e-12;
/// Fewer reversals than this are reported.
const FEW_REVERSALS: usize = 4;

/// What the fit has to say against itself.
#[derive(Debug)]
pub(super) struct Examination<'a> {
    pub(super) basis: &'a Basis,
    pub(super) structure: Structure,
    pub(super) theta: &'a Parameters,
    pub(super) noise: SensorNoise,
    pub(super) threshold: f64,
    /// Width of the working interval.
    pub(super) range: f64,
    pub(super) reversals: usize,
    /// The stroke that all records repeat.
    pub(super) stroke: Option<Stroke>,
    /// Samples in the cells beside each knot.
    pub(super) visits: Vec<usize>,
}

impl Examination<'_> {
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let mut found = Vec::new();
        // The last digits of a computed input are no news.
        if self.noise.threshold > ROUNDING * self.range {
            found.push(Warning::SensorNoise { threshold: self.threshold });
        }
        if self.basis.is_switched() && self.reversals < FEW_REVERSALS {
            found.push(Warning::FewReversals { count: self.reversals });
        }
        if self.basis.is_switched()
            && let Some(Stroke { length, samples }) = self.stroke
        {
            found.push(Warning::OneStroke { length, samples });
        }
        let lead = self.structure.ahead();
        if lead > 0 {
            found.push(Warning::LooksAhead { samples: lead });
        }
        if !Span::of(&self.theta.f).is_papers {
            found.push(Warning::SpanIllDefined);
        }
        if !has_gain(self.theta) {
            found.push(Warning::NoStationaryGain);
        } else if self.theta.b.iter().sum::<f64>() * Span::of(&self.theta.f).value < 0.0 {
            found.push(Warning::NegativeGain);
        }
        self.curves(&mut found);
        found
    }

    /// Steep cells and rarely visited knots, curve by curve. A straight line has neither.
    fn curves(&self, found: &mut Vec<Warning>) {
        let value = |k: usize| if k == 0 { 0.0 } else { self.theta.f[k - 1] };
        let curves =
            [(Branch::Descending, self.basis.descending()), (Branch::Ascending, self.basis.ascending())];
        let mut first = 0;
        for (curve, knots) in curves.into_iter().take(self.basis.sizes().count()) {
            let values: Vec<f64> = (first..first + knots.len()).map(value).collect();
            let (low, high) =
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
            for j in 1..knots.len() {
                let share = (values[j] - values[j - 1]).abs() / (high - low).max(f64::MIN_POSITIVE);
                if knots.len() > 4 && share > 0.5 {
                    found.push(Warning::SteepCell { curve, between: (knots[j - 1], knots[j]), share });
                }
            }
            for (j, &v) in knots.iter().enumerate() {
                let samples = self.visits[first + j];
                if samples < FEW_SAMPLES {
                    found.push(Warning::RarelyVisited { curve, v, samples });
                }
            }
            first += knots.len();
        }
    }
}
