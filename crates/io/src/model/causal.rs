//! A model file as it runs sample by sample, on an input that is known no further than to the present.

use super::{Curves, ModelFile, Points, System};
use crate::identification::{EstimatedSystem, obstacles, unit};
use miette::Diagnostic;
use std::path::Path;
use switchback_diagnose::LooksAhead;
use switchback_identify::free::Coefficients;
use switchback_model::reversal::Timing;
use switchback_model::step;
use thiserror::Error;

/// A model looks ahead.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}the model could not run in real time: {reasons}")]
#[diagnostic(help(
    "make one that could, from the same records, with `--causal`: `switchback identify RIG.toml --causal --out DIR`, or `switchback gap RIG.toml --causal --out DIR`"
))]
pub struct NotCausal {
    /// The file and a colon where it is known.
    file: String,
    reasons: String,
}

impl NotCausal {
    fn because(reasons: String) -> Self {
        Self { file: String::new(), reasons }
    }

    /// Names the file.
    pub fn in_file(self, file: &Path) -> Self {
        Self { file: format!("{}: ", file.display()), ..self }
    }
}

impl From<LooksAhead> for NotCausal {
    fn from(why: LooksAhead) -> Self {
        Self::because(why.to_string())
    }
}

/// Share of the working interval within which a border known at one point is met; that of [`EstimatedSystem`].
const AT_THE_POINT: f64 = 1e-6;

impl ModelFile {
    /// The model as it runs sample by sample from rest: [`Self::run`] without measured outputs.
    ///
    /// # Errors
    /// [`NotCausal`] where an output would depend on inputs that are yet to come.
    pub fn causal(&self) -> Result<step::Model, NotCausal> {
        match &self.system {
            System::Switched(model) => Ok(model.causal()?),
            System::Curves(curves) => {
                let reasons = obstacles(curves.model(), unit(&self.header.input));
                match reasons.is_empty() {
                    true => Ok(of_curves(curves)),
                    false => Err(NotCausal::because(reasons.join("; "))),
                }
            }
            System::Machine(_) => Err(NotCausal::because(
                "a source with the values of a machine has no form that runs sample by sample yet".to_owned(),
            )),
            System::Points(points) => of_points(points),
        }
    }

    /// What is assumed on records that the model was not made from, one sentence each.
    pub(crate) fn elsewhere(&self) -> Vec<String> {
        match &self.system {
            System::Switched(model) => model.elsewhere(),
            System::Curves(_) | System::Machine(_) | System::Points(_) => Vec::new(),
        }
    }
}

/// A model that is its borders and a linear part, in the user's units.
fn plain(direction: step::Direction, borders: step::Borders, linear: step::Linear) -> step::Model {
    step::Model {
        input: step::Scale::NONE,
        output: step::Scale::NONE,
        late: 0.0,
        direction,
        borders,
        effects: step::Effects::default(),
        linear,
        sensor: step::Sensor::default(),
    }
}

fn of_curves(curves: &Curves) -> step::Model {
    let model = curves.model();
    let Coefficients { a, b, f, c } = model.coefficients();
    let basis = model.basis();
    let mut values = std::iter::once(0.0).chain(f);
    let mut curve = |knots: &[f64]| step::Curve {
        knots: knots.to_vec(),
        values: values.by_ref().take(knots.len()).collect(),
        beyond: if basis.is_line() { step::Beyond::GoesOn } else { step::Beyond::Holds },
    };
    let descending = curve(basis.descending());
    let borders = match basis.is_switched() {
        true => step::Borders::Two { descending, ascending: curve(basis.ascending()) },
        false => step::Borders::One(descending),
    };
    let rule = model.rule();
    let direction = step::Direction::FirstMove {
        threshold: rule.threshold,
        between_samples: rule.timing == Timing::BetweenSamples,
    };
    let lag = usize::try_from(1 + model.structure().delay).expect("it does not look ahead");
    plain(direction, borders, step::Linear { poles: Vec::new(), a, b, lag, constant: c, limit: None })
}

fn of_points(points: &Points) -> Result<step::Model, NotCausal> {
    let (estimate, interval) = (points.estimate(), points.interval());
    let lag = usize::try_from(1 + estimate.delay)
        .map_err(|_| LooksAhead::Input(estimate.delay.unsigned_abs() - 1))?;
    let system = EstimatedSystem::of_any(&estimate, interval);
    let [descending, ascending] = system.borders().map(|points| {
        let (knots, values) = points.iter().copied().unzip();
        let beyond = match points {
            [_] => step::Beyond::Unknown(AT_THE_POINT * interval.width()),
            _ => step::Beyond::Holds,
        };
        step::Curve { knots, values, beyond }
    });
    let borders = step::Borders::Two { descending, ascending };
    let linear = step::Linear {
        poles: Vec::new(),
        a: estimate.a.clone(),
        b: estimate.b.clone(),
        lag,
        constant: 0.0,
        limit: None,
    };
    let direction = step::Direction::FirstMove { threshold: 0.0, between_samples: false };
    Ok(plain(direction, borders, linear))
}
