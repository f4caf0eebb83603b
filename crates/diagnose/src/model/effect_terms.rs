//! An augmented model by the parts of the model that read it.
//!
//! A new field of the augmented model does not compile until it belongs to a part; whoever reads a part takes it apart field by field, and whoever
//! compares two augmented models compares whole parts.

use super::augmented::{
    AugmentedModel, BorderColumn, EquationColumn, NoiseLaw, Relaxation, Saturation, Slow,
};
use super::augmented::{Transition, Widening, convolve, leading_one};
use super::sensor::SensorCurve;
use crate::records::motion::Play;

/// The parts of an augmented model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EffectTerms<'a> {
    /// Coefficients of B beyond the nominal order.
    pub(crate) extra_b: usize,
    pub(crate) positions: Positions,
    pub(crate) operator: Operator<'a>,
    pub(crate) filter: Filter<'a>,
    pub(crate) columns: &'a [EquationColumn],
    pub(crate) curve: &'a SensorCurve,
    pub(crate) saturation: Option<Saturation>,
    pub(crate) noise: &'a NoiseLaw,
}

/// What makes of the recorded input the positions that act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Positions {
    pub(crate) late: f64,
    pub(crate) play: Play,
}

/// What makes `u` of the positions, given the borders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Operator<'a> {
    pub(crate) jitter: f64,
    pub(crate) transition: Option<Transition>,
    pub(crate) wear: Option<&'a Slow>,
    pub(crate) widening: Option<Widening>,
    pub(crate) relaxation: Option<Relaxation>,
    pub(crate) columns: &'a [BorderColumn],
    pub(crate) gain: Option<&'a Slow>,
}

/// What stands between `u` and B.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Filter<'a> {
    pub(crate) delay: f64,
    pub(crate) numerator: &'a [f64],
    pub(crate) denominator: &'a [f64],
}

impl AugmentedModel {
    /// The augmented model by what reads it.
    pub(crate) fn effect_terms(&self) -> EffectTerms<'_> {
        let Self {
            extra_b,
            delay,
            jitter,
            late,
            play,
            transition,
            wear,
            widening,
            relaxation,
            border_columns,
            gain,
            numerator,
            denominator,
            equation_columns,
            curve,
            saturation,
            noise,
        } = self;
        let operator = Operator {
            jitter: *jitter,
            transition: *transition,
            wear: wear.as_ref(),
            widening: *widening,
            relaxation: *relaxation,
            columns: border_columns,
            gain: gain.as_ref(),
        };
        EffectTerms {
            extra_b: *extra_b,
            positions: Positions { late: *late, play: *play },
            operator,
            filter: Filter { delay: *delay, numerator, denominator },
            columns: equation_columns,
            curve,
            saturation: *saturation,
            noise,
        }
    }

    /// Whether both give the same design, so that only the law of the noise differs.
    pub(crate) fn same_design(&self, other: &Self) -> bool {
        let EffectTerms { extra_b, positions, operator, filter, columns, curve, saturation, noise } =
            self.effect_terms();
        let other = other.effect_terms();
        noise.input.is_some() == other.noise.input.is_some()
            && extra_b == other.extra_b
            && positions == other.positions
            && operator == other.operator
            && filter == other.filter
            && columns == other.columns
            && curve == other.curve
            && saturation == other.saturation
    }
}

impl Filter<'_> {
    /// The taps between the filtered `u` and `B`: the numerator and the delay, linear between samples.
    pub(crate) fn taps(&self) -> Vec<f64> {
        let Self { delay, numerator, denominator: _ } = *self;
        let whole = delay.floor();
        let effect_term = delay - whole;
        let mut taps = vec![0.0; whole as usize];
        taps.push(1.0 - effect_term);
        if effect_term > 0.0 {
            taps.push(effect_term);
        }
        convolve(&leading_one(numerator), &taps)
    }

    /// Its denominator beyond the leading one.
    pub(crate) fn poles(&self) -> &[f64] {
        self.denominator.get(1..).unwrap_or_default()
    }
}
