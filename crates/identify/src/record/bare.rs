//! An identified model as a system without effects.

use crate::free::Model;
use switchback_model::hysteresis::Branch;
use switchback_model::system::{Borders, LinearPart, Sensor, System};

/// The same machine; none where its gain at rest is zero, or its output does not depend on a curve.
///
/// `A y = B u + c` rests at `y = (B(1)u + c)/A(1)`: these are the values of the borders.
pub fn bare_system(model: &Model) -> Option<System> {
    let coefficients = model.coefficients();
    let lag = 1 + model.structure().delay;
    let (linear, gain) = LinearPart::new(&coefficients.a, &coefficients.b, lag)?;
    let constant = coefficients.c / (1.0 + coefficients.a.iter().sum::<f64>());
    let basis = model.basis();
    let descending = basis.descending();
    let first = if basis.is_switched() { descending.len() } else { 0 };
    // The first knot is the reference: its value is zero.
    let value = |knot: usize| constant + gain * knot.checked_sub(1).map_or(0.0, |k| coefficients.f[k]);
    let table = |knots: &[f64], first: usize| {
        knots.iter().enumerate().map(|(k, &v)| (v, value(first + k))).collect::<Vec<_>>()
    };
    let borders = Borders::new(&table(descending, 0), &table(basis.ascending(), first))?;
    debug_assert_eq!(borders.points(Branch::Ascending).count(), basis.ascending().len());
    Some(System { borders, linear, sensor: Sensor::EXACT, terms: Vec::new(), rule: model.rule() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::free::{Basis, Coefficients, Structure};
    use switchback_model::reversal::ReversalRule;
    use switchback_model::system::Span;

    #[test]
    fn both_simulate_the_same() {
        let basis = Basis::borders(vec![-1.0, 0.2, 1.0], vec![-1.0, -0.1, 1.0]);
        for delay in [-1, 0, 1] {
            let structure = Structure { order: 2, delay };
            let b = if delay < 0 { vec![0.2, 0.3, -0.1] } else { vec![0.3, -0.1] };
            let coefficients =
                Coefficients { a: vec![-1.1, 0.4], b, f: vec![0.5, 1.4, -0.3, 0.6, 2.0], c: 0.2 };
            let model = Model::new(basis.clone(), structure, coefficients, ReversalRule::EXACT).unwrap();
            let v: Vec<f64> = (0..400).map(|t| (0.1 * f64::from(t)).sin()).collect();
            let system = bare_system(&model).unwrap();
            // The model's initial state is its first outputs; give it those of the system.
            let y = system.simulate(&v, Span::alone(v.len()));
            let again = model.simulate(&v, &y[..20]);
            for (t, (x, y)) in y.iter().zip(&again).enumerate().take(399) {
                assert!((x - y).abs() < 1e-9, "{delay} {t} {x} {y}");
            }
        }
    }
}
