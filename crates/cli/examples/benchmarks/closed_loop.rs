//! A system from displacement to force, its loop closed again by its mass.

use crate::signal::Period;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use switchback_model::system::{Quantity, Scale, System, Term};

/// Periods before the one that is compared.
const TRANSIENT: usize = 2;

/// `m·ẍ + c·ẋ + F = u`, with `F` the force between the borders of a system.
#[derive(Debug)]
pub(crate) struct ClosedLoop<'a> {
    system: &'a System,
    mass: f64,
    damping: f64,
    is_elastic: bool,
    length: f64,
}

impl<'a> ClosedLoop<'a> {
    /// Of a system without dynamics of its own, with a mass, a damping and a gradual transition; its samples are `interval` seconds apart.
    pub(crate) fn of(system: &'a System, interval: f64) -> Option<Self> {
        let term = |effect| system.terms.iter().find(|term: &&Term| term.law.effect() == effect);
        let strength = |effect| term(effect).map(|term| term.values[0]);
        let transition = term("gradual_transition")?;
        Some(Self {
            system,
            mass: strength("inertia")? * interval * interval,
            damping: strength("rate_dependence").unwrap_or(0.0) * interval,
            is_elastic: transition.law.name() == "elastic",
            length: transition.values[0],
        })
    }

    /// One period of the displacement under a periodic force, after some periods of transient: leapfrog steps.
    pub(crate) fn displacement(&self, force: &Period, interval: f64, transient: usize) -> Period {
        let samples = force.0.len();
        let (mut x, mut speed, mut z) = (0.0, 0.0, 0.0);
        let mut run = Vec::with_capacity(samples);
        for t in 0..(transient + 1) * samples {
            if t >= transient * samples {
                run.push(x);
            }
            let half = 0.5 * interval / self.mass;
            let pull = force.0[t % samples] - self.between(x, z);
            // The loss acts on the mean of the speeds before and after.
            let loss = half * self.damping;
            speed = (speed * (1.0 - loss) + 2.0 * half * pull) / (1.0 + loss);
            let moved = interval * speed;
            z = self.passed(z, moved);
            x += moved;
        }
        Period(run)
    }

    fn between(&self, x: f64, z: f64) -> f64 {
        let (mean, half) = self.system.borders.at(x);
        mean + z * half
    }

    /// The place between the borders after a move.
    fn passed(&self, z: f64, moved: f64) -> f64 {
        let target = moved.signum();
        if self.is_elastic {
            let step = 2.0 * moved.abs() / self.length;
            z + (target - z).clamp(-step, step)
        } else {
            target - (target - z) * (-moved.abs() / self.length).exp()
        }
    }
}

/// Iterations at most, and the share of the error that the last must gain.
const ITERATIONS: usize = 30;
const LEAST_GAIN: f64 = 1e-5;

/// A record of the closed loop: a periodic force, and one period of the displacement, every so many samples of it.
#[derive(Debug)]
pub(crate) struct Trial {
    pub(crate) force: Period,
    pub(crate) interval: f64,
    pub(crate) measured: Period,
}

impl Trial {
    /// Errors of the closed loop of a system whose samples are `interval` seconds apart; none where it has no loop to close.
    pub(crate) fn errors(&self, system: &System, interval: f64) -> Option<DVector<f64>> {
        let closed = ClosedLoop::of(system, interval)?;
        let run = closed.displacement(&self.force, self.interval, TRANSIENT);
        let step = self.force.0.len() / self.measured.0.len();
        let errors = run.0.iter().step_by(step).zip(&self.measured.0).map(|(run, x)| x - run);
        Some(DVector::from_iterator(self.measured.0.len(), errors))
    }

    /// The system of least squared error of the closed loop near a start, by the rule of Levenberg and Marquardt.
    pub(crate) fn fitted(&self, start: &System, (interval, scale): (f64, &Scale)) -> Option<System> {
        let quantities = Quantity::coordinates(start);
        let (mut system, mut errors, mut damping) = (start.clone(), self.errors(start, interval)?, 1e-3);
        for _ in 0..ITERATIONS {
            let columns: Vec<DVector<f64>> = quantities
                .par_iter()
                .map(|quantity| {
                    let step = quantity.step(&system, scale);
                    let moved = quantity.set(&system, quantity.value(&system) + step);
                    Some((&errors - self.errors(&moved, interval)?) / step)
                })
                .collect::<Option<_>>()?;
            let jacobian = DMatrix::from_columns(&columns);
            let (information, gradient) = (jacobian.tr_mul(&jacobian), jacobian.tr_mul(&errors));
            let before = errors.norm();
            while damping < 1e9 {
                let mut damped = information.clone();
                (0..quantities.len()).for_each(|i| damped[(i, i)] *= 1.0 + damping);
                let step = damped.cholesky()?.solve(&gradient);
                let moved = quantities.iter().zip(&step).fold(system.clone(), |moved, (quantity, step)| {
                    quantity.set(&moved, quantity.value(&system) + step)
                });
                match self.errors(&moved, interval) {
                    Some(next) if moved.is_sound(scale) && next.norm() < errors.norm() => {
                        (system, errors) = (moved, next);
                        damping *= 0.2;
                        break;
                    }
                    _ => damping *= 6.0,
                }
            }
            if before - errors.norm() <= LEAST_GAIN * before {
                break;
            }
        }
        Some(system)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_model::reversal::ReversalRule;
    use switchback_model::system::{Borders, LAWS, LinearPart, Sensor, Span};

    fn system(name: &str) -> System {
        let term = |effect: &str, name: &str, value: f64| {
            let law = LAWS.iter().find(|law| (law.effect(), law.name()) == (effect, name)).expect("a law");
            Term { law: *law, values: vec![value] }
        };
        System {
            borders: Borders::new(&[(-1.0, -60.0), (0.0, -5.0), (1.0, 50.0)], &[(-1.0, -50.0), (1.0, 60.0)])
                .expect("knots that rise"),
            linear: LinearPart::new(&[], &[1.0], 0).expect("a gain of one").0,
            sensor: Sensor::EXACT,
            terms: vec![term("gradual_transition", name, 0.4), term("inertia", "mass", 17e3)],
            rule: ReversalRule::EXACT,
        }
    }

    /// The force that moves it is that of the system on its path: a period is as long as the transition's memory.
    #[test]
    fn the_force_on_its_path_is_that_of_the_system() {
        let (interval, step) = (1.0 / 3000.0, 1.0 / 15000.0);
        let samples = 3000;
        let angle = |t: usize| std::f64::consts::TAU * 8.0 * t as f64 / samples as f64;
        let force =
            Period((0..samples).map(|t| 30.0 * angle(t).sin() + 10.0 * (3.0 * angle(t)).cos()).collect());
        for name in ["relaxing", "elastic"] {
            let mut system = system(name);
            let run = ClosedLoop::of(&system, interval).expect("a loop").displacement(&force, step, 20);
            let term = &mut system.terms[1];
            // The same mass by samples that are so much closer.
            term.values[0] *= (interval / step).powi(2);
            let again = system.simulate(&run.0, Span::alone(samples));
            let later = samples / 2..samples - 2;
            let worst = later.map(|t| (again[t] - force.0[t]).abs()).fold(0.0, f64::max);
            assert!(worst < 0.05, "{name}: {worst} N");
        }
    }
}
