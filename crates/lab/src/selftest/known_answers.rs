//! Do the estimators find what is known?
//!
//! Records without noise, simulated here sample by sample from the definitions, have one answer: the system itself.
//!
//! ```text
//! y(t) = −a₁y(t−1) − a₂y(t−2) + b₁u(t−1) + b₂u(t−2),   u = k·v ± f:  + while v rises, − while it falls
//! ```
//!
//! A leaf spring with straight borders, the four designed experiments and one record at will. The program identifies the rig as a user would have it
//! identified. The limits, of the largest true number of each kind:
//!
//! - `√ε = 1.5·10⁻⁸` for joint and efficient: normal equations keep half of the sixteen digits while the condition of the columns is below
//!   `ε^(−1/4) = 8192`;
//! - `10⁻⁴` for the paper's: the mean of the step experiment is taken once the transient has fallen to that share of itself;
//! - `10⁻⁴` for `free`, whose smoothness penalty of relative weight `λ = 10⁻⁸` pulls what the data determine with weight `s` by `λ/(s + λ)` (Tikhonov):
//!   less than `√λ` for all that they determine with a weight above `√λ`.

use super::figure::Figure;
use miette::IntoDiagnostic;
use switchback_identify::excitation::Dataset;
use switchback_identify::{BorderPoint, Estimate};
use switchback_io::identification::{Method, identify};
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Rig, RigRecord};

/// The machine.
const A: [f64; 2] = [-1.2, 0.45];
const B: [f64; 2] = [0.15, 0.10];
/// Slope of both borders and half the distance between them.
const STIFFNESS: f64 = 0.12;
const FRICTION: f64 = 2.0;
/// Half the width of the working interval.
const REACH: f64 = 40.0;
/// `u_M − u_m`: the borders' values at the two ends of the interval.
const SPAN: f64 = 2.0 * (STIFFNESS * REACH + FRICTION);

const METHODS: [Method; 5] =
    [Method::PaperDescendant, Method::PaperAscendant, Method::Joint, Method::Efficient, Method::Free];

/// Identifies the machine by every method that knows hysteresis.
pub(super) fn figures(_seed: u64) -> miette::Result<Vec<Figure>> {
    let rig = rig(A)?;
    let mut figures = Vec::new();
    for method in METHODS {
        let found = identify(&rig, method)?;
        figures.extend(compare(method, &found.estimate));
    }
    Ok(figures)
}

/// Largest distances from the truth, of the largest true number of each kind.
fn compare(method: Method, found: &Estimate) -> Vec<Figure> {
    let limit = match method {
        Method::Joint | Method::Efficient => f64::EPSILON.sqrt(),
        _ => 1e-4,
    };
    let far = |found: &[f64], truth: &[f64]| {
        let scale = truth.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if found.len() != truth.len() {
            return f64::NAN;
        }
        found.iter().zip(truth).fold(0.0, |most: f64, (x, t)| {
            let distance = (x - t).abs() / scale;
            if distance.is_nan() || most.is_nan() { f64::NAN } else { most.max(distance) }
        })
    };
    let border = |points: &[BorderPoint], sign: f64| {
        let found: Vec<f64> = points.iter().map(|p| p.f).collect();
        let truth: Vec<f64> = points.iter().map(|p| (STIFFNESS * p.v + sign * FRICTION) / SPAN).collect();
        far(&found, &truth)
    };
    let mut figures = vec![
        Figure::at_most(format!("{method}: a off by"), far(&found.a, &A), limit),
        Figure::at_most(format!("{method}: b off by"), far(&found.b, &B.map(|b| b * SPAN)), limit),
    ];
    for (name, points, sign) in
        [("descending", &found.descending, -1.0), ("ascending", &found.ascending, 1.0)]
    {
        if !points.is_empty() {
            figures.push(Figure::at_most(
                format!("{method}: {name} border off by"),
                border(points, sign),
                limit,
            ));
        }
    }
    figures
}

/// The records of a whole dataset on a machine with that denominator.
fn rig(a: [f64; 2]) -> miette::Result<Rig> {
    let interval = Interval::new(-REACH, REACH).into_diagnostic()?;
    let records = Dataset::new(interval, 2, 4, 30).into_diagnostic()?.records().into_iter().map(|planned| {
        let record = Record::new(planned.v.clone(), simulate(a, &planned.v)).into_diagnostic()?;
        let (role, usage) = (planned.role, planned.usage);
        Ok(RigRecord { name: planned.name.to_owned(), role, usage, record, predicted: None })
    });
    Ok(Rig {
        name: "known".to_owned(),
        sample_time: 1.0,
        order: Some(2),
        interval: Some(interval),
        input_label: "deflection [mm]".to_owned(),
        output_label: "load [kN]".to_owned(),
        records: records.collect::<miette::Result<_>>()?,
    })
}

/// The output from rest at the first input.
fn simulate(a: [f64; 2], v: &[f64]) -> Vec<f64> {
    let first_move = v.windows(2).map(|w| w[1] - w[0]).find(|step| *step != 0.0).unwrap_or(1.0);
    // Before the first sample the input came from the end that the first move goes away from.
    let mut sign = if first_move > 0.0 { -1.0 } else { 1.0 };
    let mut u = Vec::with_capacity(v.len());
    for t in 0..v.len() {
        if t > 0 && v[t] != v[t - 1] {
            sign = (v[t] - v[t - 1]).signum();
        }
        u.push(STIFFNESS * v[t] + sign * FRICTION);
    }
    let rest = (B[0] + B[1]) / (1.0 + a[0] + a[1]) * u[0];
    let mut y: Vec<f64> = Vec::with_capacity(v.len());
    for t in 0..v.len() {
        let y_at = |lag: usize| if t >= lag { y[t - lag] } else { rest };
        let u_at = |lag: usize| if t >= lag { u[t - lag] } else { u[0] };
        y.push(-a[0] * y_at(1) - a[1] * y_at(2) + B[0] * u_at(1) + B[1] * u_at(2));
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::selftest::tests::{all_hold, some_fail};

    #[test]
    fn every_method_finds_the_machine() {
        all_hold(&figures(1).expect("identified"));
    }

    #[test]
    fn a_machine_that_is_slightly_another_shows() {
        let rig = rig([A[0], A[1] + 1e-6]).expect("a rig");
        let found = identify(&rig, Method::Efficient).expect("identified");
        some_fail(&compare(Method::Efficient, &found.estimate), "efficient: a off by");
    }

    #[test]
    fn a_parameter_too_few_and_an_estimate_that_is_no_number_show() {
        let rig = rig(A).expect("a rig");
        let mut found = identify(&rig, Method::Joint).expect("identified").estimate;
        found.b.pop();
        found.descending[0].f = f64::NAN;
        let figures = compare(Method::Joint, &found);
        some_fail(&figures, "joint: b off by");
        some_fail(&figures, "joint: descending border off by");
    }
}
