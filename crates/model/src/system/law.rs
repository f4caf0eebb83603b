//! A law of an effect, as a change of a system.

use super::motion::Motion;
use super::scale::Scale;
use super::signals::{Operator, Span};
use std::fmt;

/// The unit of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// None.
    One,
    /// That of the input.
    Input,
    /// That of the output.
    Output,
    /// Samples: seconds once multiplied by the sample time.
    Samples,
    /// Output over input units.
    OutputPerInput,
    /// Output over input units squared.
    OutputPerSquaredInput,
    /// Output over input units a sample.
    OutputPerSpeed,
    /// Output over input units a sample squared.
    OutputPerAcceleration,
    /// Input units a sample.
    Speed,
    /// Radians a sample.
    Frequency,
}

impl Unit {
    /// Whether a value of it scales with the output.
    pub fn is_of_output(self) -> bool {
        matches!(
            self,
            Self::Output
                | Self::OutputPerInput
                | Self::OutputPerSquaredInput
                | Self::OutputPerSpeed
                | Self::OutputPerAcceleration
        )
    }
}

/// A parameter of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Its name in reports.
    pub name: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// Smallest and largest value.
    pub bounds: (f64, f64),
    /// Whether it is estimated; others are constants that a start fixes.
    pub free: bool,
}

impl Parameter {
    pub(super) const fn new(name: &'static str, unit: Unit, bounds: (f64, f64)) -> Self {
        Self { name, unit, bounds, free: true }
    }

    pub(super) const fn constant(name: &'static str, unit: Unit) -> Self {
        Self { name, unit, bounds: (f64::NEG_INFINITY, f64::INFINITY), free: false }
    }
}

/// A law of an effect: a function of its parameters, the first of which is its strength, and at strength zero changes nothing.
///
/// A law changes what passes through one or more places of the system; each method is one place, and leaves its signal as it is unless the law says otherwise.
pub trait Law: Sync + fmt::Debug {
    /// The effect's name in reports and files.
    fn effect(&self) -> &'static str;

    /// The law's name among those of its effect.
    fn name(&self) -> &'static str;

    /// Its parameters, the strength first.
    fn parameters(&self) -> &'static [Parameter];

    /// Points from which an estimate starts, one value a parameter; the strengths are such as change the output noticeably.
    fn starts(&self, scale: &Scale) -> Vec<Vec<f64>>;

    /// Whether its strength moves reversals, by whole samples: no derivative says how much a finite change would gain.
    fn moves_reversals(&self) -> bool {
        false
    }

    /// Whether values are those of this effect, not a limit at which it is another one.
    fn is_sound(&self, _values: &[f64], _scale: &Scale) -> bool {
        true
    }

    /// The position that acts.
    fn position(&self, _values: &[f64], _position: &mut [f64]) {}

    /// The working point between the borders.
    fn operator(&self, _values: &[f64], _motion: &Motion, _span: Span, _operator: &mut Operator) {}

    /// The input of the linear part.
    fn input(&self, _values: &[f64], _motion: &Motion, _span: Span, _u: &mut [f64]) {}

    /// The output.
    fn output(&self, _values: &[f64], _motion: &Motion, _span: Span, _y: &mut [f64]) {}
}

/// An effect in a system: a law and its values.
#[derive(Debug, Clone)]
pub struct Term {
    /// The law.
    pub law: &'static dyn Law,
    /// One value a parameter of the law.
    pub values: Vec<f64>,
}

impl PartialEq for Term {
    fn eq(&self, other: &Self) -> bool {
        (self.law.effect(), self.law.name(), &self.values)
            == (other.law.effect(), other.law.name(), &other.values)
    }
}

impl Term {
    /// The same law at no strength.
    #[must_use]
    pub fn at_rest(&self) -> Self {
        let mut values = self.values.clone();
        values[0] = 0.0;
        Self { law: self.law, values }
    }

    /// Whether its strength has one sign: below zero there is no such effect.
    pub fn is_one_sided(&self) -> bool {
        self.law.parameters()[0].bounds.0 == 0.0
    }

    /// Numbers of the parameters that are estimated.
    pub fn free(&self) -> impl Iterator<Item = usize> + use<> {
        self.law.parameters().iter().enumerate().filter(|(_, p)| p.free).map(|(k, _)| k)
    }

    /// The same with another value of a parameter, within its bounds.
    #[must_use]
    pub fn set(&self, index: usize, value: f64) -> Self {
        let (low, high) = self.law.parameters()[index].bounds;
        let mut out = self.clone();
        out.values[index] = value.clamp(low, high);
        out
    }

    /// A move of a parameter to differentiate by, inwards at its upper bound.
    pub fn step(&self, index: usize, scale: &Scale) -> f64 {
        let sizes = self.law.starts(scale).into_iter().map(|start| start[index].abs());
        let size = sizes.fold(self.values[index].abs(), f64::max);
        let step = 1e-3 * size.max(f64::MIN_POSITIVE);
        if self.values[index] + step > self.law.parameters()[index].bounds.1 { -step } else { step }
    }
}
