//! What the functions do in and out of turn; FMPy calls them from outside in the tests of `switchback`.

use std::sync::Arc;
use switchback_fmu::{
    Constant, Description, Instance, Package, PackageError, Refusal, SCHEMA, model_description, references,
};
use switchback_model::step::{Beyond, Borders, Curve, Direction, Effects, Linear, Model, Scale, Sensor};

/// `y(t) = u(t − lag)` on two straight borders.
fn package(lag: usize) -> Package {
    let curve =
        |values: [f64; 2]| Curve { knots: vec![0.0, 1.0], values: values.into(), beyond: Beyond::Holds };
    let model = Model {
        input: Scale::NONE,
        output: Scale::NONE,
        late: 0.0,
        direction: Direction::FirstMove { threshold: 0.0, between_samples: false },
        borders: Borders::Two { descending: curve([0.0, 1.0]), ascending: curve([0.5, 1.5]) },
        effects: Effects::default(),
        linear: Linear { poles: Vec::new(), a: vec![0.0], b: vec![1.0], lag, constant: 0.0, limit: None },
        sensor: Sensor::default(),
    };
    Package {
        schema: SCHEMA.to_owned(),
        version: "1".to_owned(),
        guid: "g".to_owned(),
        sample_time: 0.1,
        interval: [0.0, 1.0],
        start: 0.5,
        constants: vec![7.0],
        program: model.program(),
    }
}

fn running(lag: usize) -> Instance {
    let mut instance = Instance::new(Arc::new(package(lag))).expect("a whole program");
    instance.set_real(references::V, 0.25).expect("an input");
    instance.enter_initialization().expect("in turn");
    instance.exit_initialization().expect("in turn");
    instance
}

fn y(instance: &Instance) -> f64 {
    instance.real(references::Y).expect("the output")
}

/// The output after each step with these inputs.
fn outputs(instance: &mut Instance, v: &[f64]) -> Vec<f64> {
    let step = |v: &f64| {
        instance.set_real(references::V, *v).expect("an input");
        instance.step(instance.time(), 0.1).expect("a step");
        y(instance)
    };
    v.iter().map(step).collect()
}

#[test]
fn the_output_after_a_step_is_that_of_its_end() {
    let mut instance = running(1);
    assert_eq!(instance.integer(references::OUTPUT_DELAY), Ok(0));
    // y(k + 1) = u(k): rises to 0.5, falls to 0, rests.
    assert_eq!(y(&instance), 0.75);
    assert_eq!(outputs(&mut instance, &[0.5, 0.0, 0.0]), [1.0, 0.0, 0.0]);
}

#[test]
fn where_it_depends_on_the_present_input_it_is_a_sample_late() {
    let mut instance = running(0);
    assert_eq!(instance.integer(references::OUTPUT_DELAY), Ok(1));
    assert_eq!(outputs(&mut instance, &[0.5, 0.0]), [1.0, 0.0]);
}

#[test]
fn a_step_of_several_samples_holds_the_input() {
    let mut long = running(1);
    long.set_real(references::V, 0.5).expect("an input");
    long.step(0.0, 0.3).expect("three samples");
    let mut short = running(1);
    assert_eq!(y(&long), outputs(&mut short, &[0.5; 3])[2]);
    assert_eq!(long.time(), short.time());
}

#[test]
fn what_is_refused_changes_nothing() {
    let mut instance = running(1);
    let fresh = instance.clone();
    for step in [0.05, 0.15, 0.0, -0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(instance.step(0.0, step), Err(Refusal::Step { .. })), "{step}");
    }
    assert!(matches!(instance.step(5.0, 0.1), Err(Refusal::Point { .. })));
    assert!(matches!(instance.set_real(references::V, f64::NAN), Err(Refusal::Input(_))));
    assert!(matches!(instance.set_real(references::Y, 1.0), Err(Refusal::Variable { .. })));
    assert!(matches!(instance.real(101), Err(Refusal::Variable { .. })));
    assert!(matches!(instance.set_integer(references::BORDER, 1), Err(Refusal::Turn { .. })));
    assert!(matches!(instance.enter_initialization(), Err(Refusal::Turn { .. })));
    assert_eq!((y(&instance), instance.time()), (y(&fresh), fresh.time()));
    assert_eq!(instance.real(references::CONSTANTS), Ok(7.0));
}

#[test]
fn after_a_reset_it_is_as_fresh() {
    let mut instance = running(1);
    outputs(&mut instance, &[0.9, 2.0]);
    assert_eq!(instance.boolean(references::OUTSIDE), Ok(true));
    instance.terminate().expect("in turn");
    assert!(matches!(instance.step(0.2, 0.1), Err(Refusal::Turn { .. })));
    instance.reset();
    assert_eq!(instance.boolean(references::OUTSIDE), Ok(false));
    instance.set_up(5.0).expect("in turn");
    instance.set_integer(references::BORDER, -1).expect("a border");
    instance.enter_initialization().expect("in turn");
    instance.set_real(references::V, 0.25).expect("an input");
    // The descending border.
    assert_eq!(y(&instance), 0.25);
    instance.exit_initialization().expect("in turn");
    instance.step(5.0, 0.1).expect("from its own beginning on");
}

#[test]
fn a_package_of_another_format_is_refused() {
    let text = package(1).json();
    assert_eq!(Package::from_json(&text).expect("what was written"), package(1));
    let other = text.replace(SCHEMA, "switchback/fmu/99");
    let reported = Package::from_json(&other).expect_err("another format").to_string();
    assert!(reported.contains("switchback/fmu/99") && reported.contains(SCHEMA), "{reported}");
    let bad = text.replace("\"sample_time\":0.1", "\"sample_time\":0.0");
    assert!(matches!(Package::from_json(&bad), Err(PackageError::SampleTime(_))));
    assert!(Package::from_json("{").is_err());
}

#[test]
fn the_description_names_all_variables_with_their_units() {
    let description = Description {
        title: "a < b".to_owned(),
        identifier: "model".to_owned(),
        says: String::new(),
        input: ["travel [mm]".to_owned(), "mm".to_owned()],
        output: ["force".to_owned(), String::new()],
        constants: vec![Constant {
            name: "backlash.play".to_owned(),
            unit: "mm".to_owned(),
            says: String::new(),
            value: 7.0,
        }],
    };
    let text = model_description(&package(1), &description);
    for words in [
        "modelName=\"a &lt; b\"",
        "<Unit name=\"mm\"/>",
        "<Real start=\"0.5\" unit=\"mm\"/>",
        "name=\"backlash.play\" valueReference=\"100\"",
        "stepSize=\"0.1\"",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert_eq!(text.matches("<Unit name=").count(), 1);
}
