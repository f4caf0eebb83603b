//! The linear part and the borders of a model, for a reader.

use super::{Curves, Points, System};
use schemars::JsonSchema;
use serde::Serialize;
use switchback_identify::statistics::propagated;
use switchback_model::hysteresis::Branch;

/// `A(q⁻¹) y(t) = Σ bᵢ u(t−delay−i)`, `u` on two borders given by points.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Described {
    /// Order.
    pub order: usize,
    /// Delay, samples: the output follows so much later than in the paper.
    pub delay: isize,
    /// `a₁…aₙ`.
    pub a: Vec<f64>,
    /// `b₁…`.
    pub b: Vec<f64>,
    /// Points `[v, u]` of the falling border.
    pub descending: Vec<(f64, f64)>,
    /// Points `[v, u]` of the rising border.
    pub ascending: Vec<(f64, f64)>,
}

impl Described {
    /// Of a model.
    pub fn of(system: &System) -> Self {
        match system {
            System::Switched(model) => {
                let switchback_diagnose::NominalModel { a, b, descending, ascending } = model.system();
                Self { order: a.len(), delay: -model.lead(), a, b, descending, ascending }
            }
            System::Curves(curves) => Self::of_curves(curves),
            System::Machine(machine) => {
                let system = machine.system();
                let (a, b) = (system.linear.a().to_vec(), system.linear.b());
                let points = |branch| system.borders.points(branch).collect();
                let [descending, ascending] = [Branch::Descending, Branch::Ascending].map(points);
                Self { order: a.len(), delay: system.linear.lag() - 1, a, b, descending, ascending }
            }
            System::Points(points) => Self::of_points(points),
        }
    }

    fn of_curves(curves: &Curves) -> Self {
        let (a, b) = curves.linear();
        let [descending, ascending] = curves.borders();
        Self { order: a.len(), delay: curves.delay(), a, b, descending, ascending }
    }

    fn of_points(points: &Points) -> Self {
        let (a, b) = (points.a().to_vec(), points.b().to_vec());
        let [descending, ascending] = points.borders();
        Self { order: a.len(), delay: points.delay(), a, b, descending, ascending }
    }

    /// The same with its parameters moved by a step, where their covariance is known; a model of `gap` does not say.
    fn moved(system: &System, step: &[f64]) -> Self {
        match system {
            System::Switched(_) | System::Machine(_) => Self::of(system),
            System::Curves(curves) => Self::of_curves(&curves.moved(step)),
            System::Points(points) => {
                let (a, rest) = step.split_at(points.a().len());
                let (b, _) = rest.split_at(points.b().len());
                let sum = |x: &[f64], by: &[f64]| x.iter().zip(by).map(|(x, by)| x + by).collect();
                let fitted = Self::of_points(points);
                Self { a: sum(&fitted.a, a), b: sum(&fitted.b, b), ..fitted }
            }
        }
    }

    /// `a`, and `b` for a `u` that runs from `u_m` to `u_m + 1`, as an estimate shows it.
    fn linear(&self) -> (Vec<f64>, Vec<f64>) {
        let ends = self.descending.first().zip(self.ascending.last().or(self.descending.last()));
        let span = ends.map_or(1.0, |(low, high)| high.1 - low.1);
        let span = if span.is_finite() && span != 0.0 { span } else { 1.0 };
        (self.a.clone(), self.b.iter().map(|b| b * span).collect())
    }
}

impl System {
    /// A figure of the linear part, `of(a, b)` with `b` for a `u` from `u_m` to `u_m + 1`, and the standard error of each of its values by
    /// linear propagation; no errors where the parameters' covariance is not known.
    pub fn of_linear(&self, of: impl Fn(&[f64], &[f64]) -> Vec<f64>) -> (Vec<f64>, Option<Vec<f64>>) {
        let reported = |described: Described| {
            let (a, b) = match self {
                // Points are reported in that normalisation already.
                Self::Points(_) => (described.a, described.b),
                _ => described.linear(),
            };
            of(&a, &b)
        };
        let rows = match self {
            Self::Switched(_) | Self::Machine(_) => None,
            Self::Curves(curves) => curves.covariance(),
            Self::Points(points) => points.covariance(),
        };
        let variances = rows.map(|rows| propagated(rows, |step| reported(Described::moved(self, step))));
        let errors = variances.map(|v| v.into_iter().map(|v| v.max(0.0).sqrt()).collect());
        (reported(Described::of(self)), errors)
    }
}
