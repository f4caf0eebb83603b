//! A method's estimate with its standard errors, from dense regressions.

use super::folds::Folded;
use super::regression::{Experiment, Inner, Regression};
use super::solved::Solved;
use crate::consistency::pulse_kind::PulseKind;
use switchback_identify::pulse::{PulseFitError, StepMean};

/// Gauss–Newton ends where no parameter moves by more than this share.
const CONVERGED: f64 = 1e-12;
const MOST_STEPS: usize = 30;

/// The parameters of a method with their standard errors: `a`, `b`, then the border points of its experiments.
pub(super) fn fit(
    kind: PulseKind,
    order: usize,
    experiments: &[Experiment; 2],
    steps: [StepMean; 2],
    samples: usize,
) -> Result<Vec<(f64, f64)>, PulseFitError> {
    let seen: Vec<&Experiment> = kind.experiments().iter().map(|&k| &experiments[k]).collect();
    if kind.folds() {
        return Folded::of(&seen, order, samples)?.estimates();
    }
    let step = kind.needs_step().then(|| steps[kind.experiments()[0]]);
    let mean = step.map(|s| s.mean);
    let new = |inner| Regression::new(order, seen.clone(), samples, inner, mean);
    let mut solved = Solved::of(new(Regression::inner_of(kind)))?;
    if kind == PulseKind::Efficient {
        for _ in 0..=MOST_STEPS {
            let (b, w) = (solved.b().to_vec(), solved.regression.levels(solved.theta()));
            let next = Solved::of(new(Inner::Constrained { b, w }))?;
            let moved = next.moved_from(&solved);
            solved = next;
            if moved < CONVERGED {
                break;
            }
        }
    }
    solved.estimates(step)
}
