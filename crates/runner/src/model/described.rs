//! The linear part and the borders of a model, for a reader.

use super::System;
use serde::Serialize;

/// `A(q⁻¹) y(t) = Σ bᵢ u(t−delay−i)`, `u` on two borders given by points.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Described {
    order: usize,
    delay: isize,
    a: Vec<f64>,
    b: Vec<f64>,
    descending: Vec<(f64, f64)>,
    ascending: Vec<(f64, f64)>,
}

impl Described {
    pub(super) fn of(system: &System) -> Self {
        match system {
            System::Switched(model) => {
                let switchback_gap::NominalModel { a, b, descending, ascending } = model.system();
                Self { order: a.len(), delay: -model.lead(), a, b, descending, ascending }
            }
            System::Curves(curves) => {
                let (a, b) = curves.linear();
                let [descending, ascending] = curves.borders();
                Self { order: a.len(), delay: curves.delay(), a, b, descending, ascending }
            }
            System::Points(points) => {
                let (a, b) = (points.a().to_vec(), points.b().to_vec());
                let [descending, ascending] = points.borders();
                Self { order: a.len(), delay: points.delay(), a, b, descending, ascending }
            }
        }
    }
}
