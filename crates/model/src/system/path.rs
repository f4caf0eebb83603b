//! The part of a simulation that neither borders nor linear part change.

use super::borders::{Borders, Places};
use super::law::Term;
use super::motion::Motion;
use super::signals::{Operator, Span};
use crate::reversal::ReversalRule;

/// Where the working point of a record is, given the terms that act on position and operator.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    pub(super) motion: Motion,
    pub(super) operator: Operator,
    pub(super) places: Places,
    pub(super) span: Span,
}

impl Path {
    /// The path of an input.
    pub(super) fn of(
        v: &[f64],
        (borders, rule): (&Borders, ReversalRule),
        terms: &[Term],
        span: Span,
    ) -> Self {
        let mut position = v.to_vec();
        for term in terms {
            term.law.position(&term.values, &mut position);
        }
        let motion = Motion::of(&position, rule);
        let mut operator =
            Operator { z: motion.direction.clone(), width: vec![1.0; v.len()], added: vec![0.0; v.len()] };
        for term in terms {
            term.law.operator(&term.values, &motion, span, &mut operator);
        }
        let places = borders.places(&motion.position);
        Self { motion, operator, places, span }
    }
}
