//! Systems with less structure or another one, and the numbers that structure takes.

use super::law::Term;
use super::laws::every_law;
use super::quantity::Quantity;
use super::scale::Scale;
use super::simulate::System;

impl System {
    /// The system with one term more.
    #[must_use]
    pub fn and(&self, term: Term) -> Self {
        let mut with = self.clone();
        with.terms.push(term);
        with
    }

    /// Numbers that have a price: borders are curves, and their knots only what it takes to draw them.
    pub fn priced(&self) -> usize {
        let coordinates = Quantity::coordinates(self);
        coordinates.iter().filter(|q| !matches!(q, Quantity::Knot(_))).count()
    }

    /// The system without one term, or with a smaller linear part; and the parameters that this saves.
    pub fn smaller(&self) -> Vec<(Self, usize)> {
        let mut all = Vec::new();
        for k in 0..self.terms.len() {
            let mut without = self.clone();
            let term = without.terms.remove(k);
            all.push((without, term.values.len()));
        }
        for fewer in self.linear.smaller() {
            let saved = self.linear.coefficients() - fewer.coefficients();
            all.push((Self { linear: fewer, ..self.clone() }, saved));
        }
        all
    }

    /// The system with each other timing of its reversals, and with another law of each effect: at the same values where it has as many, else at one of its starts.
    pub fn variants(&self, scale: &Scale) -> Vec<Self> {
        let mut all: Vec<Self> = self.with_every_timing().skip(1).collect();
        for (k, term) in self.terms.iter().enumerate() {
            let is_other =
                |law: &&dyn super::Law| law.effect() == term.law.effect() && law.name() != term.law.name();
            all.extend(every_law().filter(is_other).map(|law| {
                let is_like = law.parameters().len() == term.values.len();
                let values = if is_like { term.values.clone() } else { law.starts(scale).swap_remove(0) };
                let mut other = self.clone();
                other.terms[k] = Term { law, values };
                other
            }));
        }
        all
    }
}

impl Quantity {
    /// Whether a system has it: poles that are real have no frequency.
    pub fn is_of(self, system: &System) -> bool {
        let is_of_poles = matches!(self, Self::TimeConstant(_) | Self::Frequency(_) | Self::Damping(_));
        !is_of_poles || Self::all(system).contains(&self)
    }

    /// Its value in a system that may lack the term: zero for a strength, and no number for a shape.
    pub fn value_where_known(self, system: &System) -> f64 {
        match self {
            Self::Value(term, 0) if term >= system.terms.len() => 0.0,
            Self::Value(term, _) if term >= system.terms.len() => f64::NAN,
            _ => self.value(system),
        }
    }
}
