//! A path beside a known one is the path by itself, whatever the two systems share.

use switchback_model::reversal::ReversalRule;
use switchback_model::system::{Borders, LAWS, LinearPart, Scale, Sensor, Span, System, Term};

fn input() -> Vec<f64> {
    (0..700).map(f64::from).map(|t| 0.6 * (0.11 * t).sin() + 0.4 * (0.017 * t).cos()).collect()
}

fn bare(knots: &[f64]) -> System {
    let low: Vec<(f64, f64)> = knots.iter().map(|v| (*v, 2.0 * v + 0.3 * v * v - 0.4)).collect();
    let high: Vec<(f64, f64)> = low.iter().map(|(v, u)| (*v, u + 0.8)).collect();
    System {
        borders: Borders::new(&low, &high).expect("knots that rise"),
        linear: LinearPart::new(&[-0.8], &[0.2], 1).expect("stable").0,
        sensor: Sensor::EXACT,
        terms: Vec::new(),
        rule: ReversalRule::EXACT,
    }
}

#[test]
fn a_path_beside_another_is_the_path_itself() {
    let v = input();
    let span = Span::alone(v.len());
    let base = bare(&[-1.1, -0.4, 0.2, 1.1]);
    let y = base.simulate(&v, span);
    let scale = Scale::of(&base.linear, base.rule, &[(&v, &y)]);
    let finer = bare(&[-1.1, -0.7, -0.4, 0.2, 1.1]);
    let slower = System { rule: ReversalRule { threshold: 0.05, ..base.rule }, ..base.clone() };
    let mut systems = vec![finer, slower];
    for law in LAWS {
        for values in law.starts(&scale) {
            systems.push(System { terms: vec![Term { law, values }], ..base.clone() });
        }
    }
    let known = base.path(&v, span);
    let mut others = 0;
    for system in &systems {
        let alone = system.path(&v, span);
        assert_eq!(system.path_beside(&v, span, &known), alone, "{:?}", system.terms);
        assert_eq!(base.path_beside(&v, span, &alone), known, "{:?}", system.terms);
        others += usize::from(alone != known);
    }
    // Some of these systems have a path of their own, so that the statement is about something.
    assert!((10..systems.len()).contains(&others), "{others} of {}", systems.len());
}
