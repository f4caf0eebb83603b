//! The part of a simulation that neither borders nor linear part change.

use super::borders::{Borders, Places};
use super::law::Term;
use super::motion::Motion;
use super::signals::{Operator, Span};
use crate::reversal::ReversalRule;
use std::sync::Arc;

/// Where the working point of a record is, given the terms that act on position and operator.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    pub(super) motion: Arc<Motion>,
    pub(super) operator: Operator,
    pub(super) places: Arc<Places>,
    pub(super) span: Span,
    rule: ReversalRule,
}

impl Path {
    /// The path of an input. Motion and places are shared with a known path of the same positions, rule and knots.
    pub(super) fn of(
        v: &[f64],
        (borders, rule): (&Borders, ReversalRule),
        (terms, span): (&[Term], Span),
        known: Option<&Self>,
    ) -> Self {
        let mut position = v.to_vec();
        for term in terms {
            term.law.position(&term.values, &mut position);
        }
        let same = known.filter(|known| known.rule == rule && known.motion.position == position);
        let motion =
            same.map_or_else(|| Arc::new(Motion::of(&position, rule)), |known| Arc::clone(&known.motion));
        let mut operator =
            Operator { z: motion.direction.clone(), width: vec![1.0; v.len()], added: vec![0.0; v.len()] };
        for term in terms {
            term.law.operator(&term.values, &motion, span, &mut operator);
        }
        let same = same.filter(|known| borders.has_the_knots_of(&known.places));
        let places = same
            .map_or_else(|| Arc::new(borders.places(&motion.position)), |known| Arc::clone(&known.places));
        Self { motion, operator, places, span, rule }
    }
}
