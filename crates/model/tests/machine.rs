//! Runs by hand, and what a program must not do.

use std::sync::Arc;
use switchback_model::step::*;

fn model(direction: Direction) -> Model {
    let curve =
        |values: [f64; 2]| Curve { knots: vec![0.0, 1.0], values: values.into(), beyond: Beyond::Holds };
    Model {
        input: Scale::NONE,
        output: Scale::NONE,
        late: 0.0,
        direction,
        borders: Borders::Two { descending: curve([0.0, 1.0]), ascending: curve([0.5, 1.5]) },
        effects: Effects::default(),
        // y(t) = u(t−1).
        linear: Linear { poles: Vec::new(), a: vec![0.0], b: vec![1.0], lag: 1, constant: 0.0, limit: None },
        sensor: Sensor::default(),
    }
}

fn first_move() -> Model {
    model(Direction::FirstMove { threshold: 0.0, between_samples: false })
}

fn machine(model: &Model) -> Machine {
    Machine::new(Arc::new(model.program())).expect("a whole program")
}

fn run(model: &Model, v: &[f64], branch: f64) -> Vec<f64> {
    let mut run = Run::start(&machine(model), v[0], branch);
    v.iter().map(|v| run.step(*v)).collect()
}

/// To rounding.
fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-15 * 4.0), "{found:?} {expected:?}");
}

#[test]
fn the_paper_s_operator_by_hand() {
    let v = [0.2, 0.2, 0.6, 0.4, 0.4, 0.8, 0.8];
    assert_near(&run(&first_move(), &v, 1.0), &[0.7, 0.7, 0.7, 1.1, 0.4, 0.4, 1.3]);
}

#[test]
fn a_first_fall_shows_the_run_that_began_on_the_descending_border() {
    let v = [0.6, 0.6, 0.2, 0.2];
    assert_near(&run(&first_move(), &v, -1.0), &[0.6, 0.6, 0.6, 0.2]);
    // Until it is reported, the ascending border is shown.
    assert_near(&run(&first_move(), &v, 0.0), &[1.1, 1.1, 0.6, 0.2]);
}

#[test]
fn an_input_that_is_not_finite_counts_as_the_one_before() {
    let v = [0.2, 0.4, f64::NAN, f64::INFINITY, 0.5, 0.5];
    let held = [0.2, 0.4, 0.4, 0.4, 0.5, 0.5];
    assert_eq!(run(&first_move(), &v, 1.0), run(&first_move(), &held, 1.0));
}

#[test]
fn what_is_unknown_is_no_number() {
    let mut model = first_move();
    let only = Curve { knots: vec![1.0], values: vec![1.5], beyond: Beyond::Unknown(1e-6) };
    let Borders::Two { descending, .. } = model.borders else { panic!("two borders") };
    model.borders = Borders::Two { descending, ascending: only };
    // Rises to the one known place, and elsewhere.
    let known = run(&model, &[1.0, 0.3, 1.0, 0.6, 0.6], -1.0);
    assert_near(&known, &[1.0, 1.0, 0.3, 1.5, 0.6]);
    assert!(run(&model, &[1.0, 0.3, 0.7, 0.7], -1.0)[3].is_nan());
}

#[test]
fn the_next_output_is_foreseen_without_moving_on() {
    let v = [0.2, 0.6, 0.4, 0.9];
    let expected = run(&first_move(), &v, 1.0);
    let mut run = Run::start(&machine(&first_move()), v[0], 1.0);
    for t in 0..3 {
        run.step(v[t]);
        assert_eq!(run.foreseen(v[t]), expected[t + 1]);
    }
    let mut shared = model(Direction::FirstMove { threshold: 0.0, between_samples: true });
    assert!(shared.program().direct);
    shared.linear.lag = 2;
    assert!(!shared.program().direct);
}

#[test]
fn what_decays_for_ever_ends_at_zero() {
    let mut model = first_move();
    model.linear.a = vec![-0.5];
    let mut v = vec![0.4, 0.0];
    v.extend([0.0; 3000]);
    let y = run(&model, &v, -1.0);
    assert_eq!(y[2500], 0.0);
    assert!(y.iter().all(|y| *y == 0.0 || y.is_normal()));
}

#[test]
fn a_program_goes_through_json_and_a_broken_one_is_refused() {
    let program = first_move().program();
    let text = serde_json::to_string(&program).expect("plain data");
    assert_eq!(serde_json::from_str::<Program>(&text).expect("what was written"), program);
    let broken = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut value = serde_json::to_value(&program).expect("plain data");
        change(&mut value);
        let program = serde_json::from_value(value).expect("a program still");
        Machine::new(Arc::new(program)).expect_err("broken").to_string()
    };
    assert!(broken(&|p| p["output"] = 99.into()).contains("no variable 99"));
    assert!(broken(&|p| p["arrays"][2]["length"] = 7.into()).contains("not the size"));
    assert!(broken(&|p| p["procedures"] = serde_json::json!([])).contains("no `start(v, branch)`"));
    // A procedure that calls itself.
    let itself = |p: &mut serde_json::Value| {
        p["procedures"][0]["body"] = serde_json::json!([{ "run": [0, [{ "number": 0.0 }]] }]);
    };
    assert!(broken(&itself).contains("cannot be called from here"));
}
