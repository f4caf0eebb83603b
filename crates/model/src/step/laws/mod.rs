//! From a model to its program: each law is written here, once, and runs in every language.

mod borders;
mod builder;
mod by_border;
mod columns;
mod input;
mod linear;
mod motion;
mod sensor;
mod weights;
mod working_point;

use crate::step::model::{Direction, Model};
use crate::step::program::Program;
use builder::Builder;

pub use weights::NEGLIGIBLE;

impl Model {
    /// What it does when it begins and in every sample.
    pub fn program(&self) -> Program {
        let mut b = Builder::default();
        let ends = input::Ends::new(&mut b);
        let read = sensor::procedure(&mut b, (&self.sensor, &self.output), ends.output);
        let (position, input) = input::part(&mut b, self, &ends);
        let line = linear::Line::new(&mut b, &self.linear);
        let borders = borders::Written::new(&mut b, &self.borders);
        let (motion, turns) = motion::part(&mut b, self, (&ends, position), (&borders, line.u));
        let (point, operator) = working_point::part(&mut b, self, (&ends, position), (&borders, &motion));
        let (beside, columns) = columns::part(&mut b, &self.effects, &motion);
        let linear = line.part(&self.linear, (point, beside, 1.0 + self.effects.gain), read);
        let parts = [input, turns, operator, columns, linear];
        let (mut start, mut step) = (Vec::new(), Vec::new());
        for part in parts {
            start.extend(part.start);
            step.extend(part.step);
        }
        let begins = ("start", "Begins a run at rest at `v`, as if the input had always been there.");
        b.procedure(begins, &[ends.v, ends.branch], start);
        b.procedure(("step", "The output after one more sample `v` of the input."), &[ends.v], step);
        b.finish(ends.output, motion.first_direction, self.is_direct())
    }

    /// Whether an output depends on the input of the same sample: by the first coefficient, or by a turning sample that it reports.
    fn is_direct(&self) -> bool {
        let shares = matches!(self.direction, Direction::FirstMove { between_samples: true, .. });
        self.linear.lag == 0 || (shares && self.linear.lag == 1)
    }
}
