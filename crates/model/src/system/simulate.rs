//! The system itself.

use super::borders::Borders;
use super::law::Term;
use super::linear_part::LinearPart;
use super::path::Path;
use super::scale::Scale;
use super::signals::Span;
use crate::reversal::ReversalRule;

/// The reading of an output: `y = gain·x + zero`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Its gain.
    pub gain: f64,
    /// Its zero, output units.
    pub zero: f64,
}

impl Sensor {
    /// The reading that changes nothing.
    pub const EXACT: Self = Self { gain: 1.0, zero: 0.0 };
}

/// A machine: borders in output units, a linear part of unit gain, a reading, and terms for effects beside these.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// The borders.
    pub borders: Borders,
    /// The linear part.
    pub linear: LinearPart,
    /// The reading.
    pub sensor: Sensor,
    /// Effects, in the order in which they act at each place.
    pub terms: Vec<Term>,
    /// What counts as a reversal.
    pub rule: ReversalRule,
}

impl System {
    /// The system with every timing of its reversals, its own first.
    pub fn with_every_timing(&self) -> impl Iterator<Item = Self> + use<> {
        let system = self.clone();
        self.rule.with_every_timing().map(move |rule| Self { rule, ..system.clone() })
    }

    /// Whether it is stable and its terms are effects of their own.
    pub fn is_sound(&self, scale: &Scale) -> bool {
        self.linear.is_stable() && self.terms.iter().all(|t| t.law.is_sound(&t.values, scale))
    }

    /// The output for an input, at rest at its first value before; one value a sample.
    pub fn simulate(&self, v: &[f64], span: Span) -> Vec<f64> {
        self.respond(&self.path(v, span), &[])
    }

    /// The response to one unit between the borders until the position first moves, where a law hides that move: on which border a record begins is not
    /// seen before. None where no law moves reversals, or the position moves at once.
    pub fn response_to_the_first_border(&self, v: &[f64]) -> Option<Vec<f64>> {
        if self.terms.iter().all(|term| !term.law.moves_reversals()) {
            return None;
        }
        let mut position = v.to_vec();
        for term in &self.terms {
            term.law.position(&term.values, &mut position);
        }
        let first = position.iter().position(|p| *p != position[0]).filter(|&first| first > 1)?;
        let mut u = vec![0.0; v.len()];
        u[..first].fill(1.0);
        Some(self.linear.run(&u))
    }

    /// The first sample at which the position does not depend on the input before the record, which a law that moves reversals remembers: where the runs that
    /// came from either side agree from then on. None where they never do.
    pub fn first_known_position(&self, v: &[f64]) -> Option<usize> {
        let (low, high) = v.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        let travel = 2.0 * (high - low);
        let [one, other] = [-travel, travel].map(|from| {
            let mut position: Vec<f64> =
                v.first().map(|first| first + from).into_iter().chain(v.iter().copied()).collect();
            for term in &self.terms {
                term.law.position(&term.values, &mut position);
            }
            position
        });
        let differ = one.iter().zip(&other).skip(1).rposition(|(one, other)| one != other);
        Some(differ.map_or(0, |last| last + 1)).filter(|first| *first < v.len())
    }

    /// Where the working point is.
    pub fn path(&self, v: &[f64], span: Span) -> Path {
        Path::of(v, (&self.borders, self.rule), (&self.terms, span), None)
    }

    /// The same where the path of another system for this input is known: what both share is not computed again.
    pub fn path_beside(&self, v: &[f64], span: Span, known: &Path) -> Path {
        Path::of(v, (&self.borders, self.rule), (&self.terms, span), Some(known))
    }

    /// For each knot of the borders the sum of squares of its share in the working points of a record: how many samples determine its value.
    pub fn knot_weights(&self, v: &[f64], span: Span) -> Vec<f64> {
        let path = self.path(v, span);
        self.borders.weights(&path.places, &path.operator.z)
    }

    /// The output along a path, which must be that of a system with the same terms and rule. What `beside` has, one value a sample or none, is
    /// added before the sensor.
    pub fn respond(&self, path: &Path, beside: &[f64]) -> Vec<f64> {
        let Path { motion, operator, places, span, .. } = path;
        let along = self.borders.along(&motion.position, places);
        let point = |(t, (mean, half)): (usize, (f64, f64))| {
            mean + operator.z[t] * operator.width[t] * half + operator.added[t]
        };
        let mut u: Vec<f64> = along.into_iter().enumerate().map(point).collect();
        for term in &self.terms {
            term.law.input(&term.values, motion, *span, &mut u);
        }
        let mut y = self.linear.run(&u);
        y.iter_mut().zip(beside).for_each(|(y, beside)| *y += beside);
        for y in &mut y {
            *y = self.sensor.gain * *y + self.sensor.zero;
        }
        for term in &self.terms {
            term.law.output(&term.values, motion, *span, &mut y);
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::LAWS;

    #[test]
    fn a_position_behind_a_play_is_known_once_the_input_has_crossed_it() {
        let law = LAWS.into_iter().find(|law| law.name() == "play").expect("a law");
        let with = |terms| System {
            borders: Borders::new(&[(-1.0, -1.0), (1.0, 1.0)], &[(-1.0, -1.0), (1.0, 1.0)]).expect("tables"),
            linear: LinearPart::new(&[], &[1.0], 0).expect("a gain").0,
            sensor: Sensor::EXACT,
            terms,
            rule: ReversalRule::EXACT,
        };
        let v = [0.0, 1.0, 2.0, 1.0, 0.0, -1.0, -2.0];
        let known = |plays: &[f64]| {
            let terms = plays.iter().map(|play| Term { law, values: vec![*play] });
            with(terms.collect()).first_known_position(&v)
        };
        assert_eq!(known(&[]), Some(0));
        assert_eq!(known(&[1.0]), Some(1));
        assert_eq!(known(&[2.0]), Some(2));
        // From 2 to -1 and no farther.
        assert_eq!(known(&[3.0]), Some(5));
        assert_eq!(known(&[5.0]), None);
    }
}
