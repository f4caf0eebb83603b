//! Every law does the same in C, compiled by the system's compiler, and here.
//!
//! Without a C compiler the test says so and passes.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use switchback_model::step::*;

fn curve(knots: &[f64], values: &[f64]) -> Curve {
    Curve { knots: knots.to_vec(), values: values.to_vec(), beyond: Beyond::Holds }
}

fn borders() -> Borders {
    Borders::Two {
        descending: curve(&[0.0, 0.3, 1.0], &[-0.9, -0.4, 0.7]),
        // A jump.
        ascending: curve(&[0.0, 0.5, 0.5, 1.0], &[-0.6, 0.1, 0.4, 1.1]),
    }
}

fn plain() -> Model {
    Model {
        input: Scale { origin: 1.5, size: 4.0, grid: Some(1e-10) },
        output: Scale { origin: -3.0, size: 7.0, grid: None },
        late: 0.0,
        direction: Direction::Place { threshold: 0.0, play: Play::default(), between_borders: false },
        borders: borders(),
        effects: Effects::default(),
        linear: Linear {
            poles: Vec::new(),
            a: vec![-1.1, 0.4],
            b: vec![0.2, 0.1],
            lag: 1,
            constant: 0.03,
            limit: Some(1e6),
        },
        sensor: Sensor::default(),
    }
}

fn with(effects: Effects) -> Model {
    Model { effects, ..plain() }
}

/// A model a law.
fn models() -> Vec<(String, Model)> {
    let first_move = |threshold, between_samples| Direction::FirstMove { threshold, between_samples };
    let unscaled = |direction, borders| Model {
        input: Scale::NONE,
        output: Scale::NONE,
        direction,
        borders,
        linear: Linear { limit: None, ..plain().linear },
        ..plain()
    };
    let passing = |law| Transition { length: 0.08, shape: 1.3, reach: 0.6, law };
    let column = |column| with(Effects { columns: vec![(column, 0.3)], ..Effects::default() });
    let linear = |linear| Model { linear, ..plain() };
    let sensor = |sensor| Model { sensor, ..plain() };
    let line = Curve { knots: vec![2.0, 4.0], values: vec![0.5, 1.5], beyond: Beyond::GoesOn };
    let mut all = vec![
        ("plain", plain()),
        ("first_move", unscaled(first_move(0.0, false), borders())),
        ("first_move_beyond", unscaled(first_move(0.4, false), borders())),
        ("between_samples", unscaled(first_move(0.0, true), borders())),
        (
            "one_curve",
            unscaled(first_move(0.0, false), Borders::One(curve(&[1.0, 3.0, 5.0], &[0.0, 2.0, 1.0]))),
        ),
        ("line", unscaled(first_move(0.0, false), Borders::One(line))),
        ("late", Model { late: 0.3, ..plain() }),
        (
            "play",
            Model {
                direction: Direction::Place {
                    threshold: 0.02,
                    play: Play { width: 0.1, taper: 0.4 },
                    between_borders: true,
                },
                ..plain()
            },
        ),
        ("jitter", with(Effects { jitter: 0.02, ..Effects::default() })),
        ("narrow", with(Effects { narrowing: 0.2, gain: -0.1, ..Effects::default() })),
        ("direct", linear(Linear { lag: 0, ..plain().linear })),
        ("delayed", linear(Linear { lag: 5, b: vec![0.2, 0.0, 0.1], ..plain().linear })),
        ("filtered", linear(Linear { poles: vec![-0.9, 0.3, -0.05, 0.01], ..plain().linear })),
        ("first_order", linear(Linear { a: vec![-0.8], b: vec![0.4], ..plain().linear })),
        (
            "fourth_order",
            linear(Linear { a: vec![-1.1, 0.5, -0.2, 0.05], b: vec![0.1; 4], ..plain().linear }),
        ),
        ("range", sensor(Sensor { range: Some([f64::NEG_INFINITY, 0.6]), ..Sensor::default() })),
        ("powers", sensor(Sensor { powers: vec![0.05, 0.02], ..Sensor::default() })),
        (
            "bumps_and_knees",
            sensor(Sensor {
                bumps: Some(Bumps { first: -1.5, spacing: 1.0, heights: vec![0.1, -0.05, 0.04] }),
                knees: vec![
                    Knee { level: 0.4, width: 0.3, sign: 1.0, steepest: 5.0 },
                    Knee { level: -0.5, width: 0.3, sign: -1.0, steepest: 5.0 },
                ],
                ..Sensor::default()
            }),
        ),
        (
            "cubic",
            sensor(Sensor {
                cubic: Some(Cubic { square: 0.1, cube: -0.3, range: [-0.9, 0.8], flattest: 0.05 }),
                ..Sensor::default()
            }),
        ),
        ("speed", column(Column::Speed { power: 0.5, scale: 0.1, held: true })),
        ("speed_zero", column(Column::Speed { power: 2.0, scale: 0.1, held: false })),
        ("low_speed", column(Column::LowSpeed { power: 1.0, scale: 0.1, held: true })),
        ("low_speed_zero", column(Column::LowSpeed { power: 1.0, scale: 0.1, held: false })),
        ("bristle", column(Column::Bristle { power: 2.0, scale: 0.1, length: 0.05 })),
        ("resting_log", column(Column::RestingLog { scale: 2.0 })),
        ("resting_rise", column(Column::RestingRise { scale: 2.0 })),
        ("reversal_log", column(Column::ReversalLog { scale: 2.0 })),
        ("branch_change", column(Column::Branch { at: 0.7 })),
        ("side_change", column(Column::Side { at: 0.7, branch: -1.0 })),
        (
            "widening",
            with(Effects {
                widening: Some(Widening { share: 0.3, power: 0.7, scale: 0.1, at_high_speeds: true }),
                ..Effects::default()
            }),
        ),
        (
            "narrow_when_fast",
            with(Effects {
                widening: Some(Widening { share: 0.3, power: 0.7, scale: 0.1, at_high_speeds: false }),
                ..Effects::default()
            }),
        ),
        (
            "relaxation",
            with(Effects { relaxation: Some(Relaxation { share: 0.6, tau: 2.0 }), ..Effects::default() }),
        ),
    ];
    for (name, law) in [
        ("offset", TransitionLaw::Offset),
        ("held", TransitionLaw::Held),
        ("crossing", TransitionLaw::Crossing),
    ] {
        let effects = Effects {
            transition: Some(passing(law)),
            narrowing: 0.1,
            relaxation: Some(Relaxation { share: 0.5, tau: 3.0 }),
            had_starts: name == "crossing",
            ..Effects::default()
        };
        all.push((name, with(effects)));
    }
    all.into_iter().map(|(name, model)| (name.to_owned(), model)).collect()
}

/// Rises, falls, rests and small returns, from 1 to 6.
fn input() -> Vec<f64> {
    let at = |t: i32| {
        let t = if t % 37 > 29 { t - t % 37 + 29 } else { t };
        let t = f64::from(t);
        3.5 + 1.6 * (0.23 * t + 2.0).sin() + 0.9 * (0.91 * t).sin()
    };
    (0..300).map(at).collect()
}

fn heading(name: &str) -> Heading {
    Heading {
        name: name.to_owned(),
        says: vec!["A model of */ \"trouble\\\" ??/ 'Größe' 100 % /*.".to_owned()],
        input: "weg [µm] \"*/ ??=".to_owned(),
        output: "kraft [N·m]\\".to_owned(),
        sample_time: 1e-3,
        interval: [-1.0, 6.0],
    }
}

/// The run here, from the border that the input's first move shows.
fn here(model: &Model, v: &[f64]) -> (f64, Vec<f64>) {
    let machine = Machine::new(Arc::new(model.program())).expect("a whole program");
    let falls =
        machine.first_direction().is_some() && v.iter().find(|x| **x != v[0]).is_some_and(|x| *x < v[0]);
    let branch = if falls { -1.0 } else { 0.0 };
    let mut run = Run::start(&machine, v[0], branch);
    (branch, v.iter().map(|v| run.step(*v)).collect())
}

fn compare(name: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let size = expected.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    for (t, (found, y)) in found.iter().zip(expected).enumerate() {
        assert!((found - y).abs() <= 1e-12 * size, "{name}, sample {t}: {found} here {y}");
    }
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

fn output(command: &mut Command, stdin: &str) -> String {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    child.stdin.take().expect("piped").write_all(stdin.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && reported.is_empty(), "{reported}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn c_does_the_same_and_compiles_without_a_warning() {
    if Command::new("cc").arg("--version").output().is_err() {
        writeln!(std::io::stderr(), "SKIPPED: there is no C compiler `cc`").expect("it can be said");
        return;
    }
    let folder = folder("in-c");
    let (models, v) = (models(), input());
    let mut main = String::from("#include <stdio.h>\n");
    let mut calls = String::new();
    for (name, model) in &models {
        main += &c(&model.program(), &heading(name));
        let branch = here(model, &v).0;
        calls += &format!(
            "    {{\n        {name}_state s;\n        int t;\n        {name}_start(&s, v[0], {branch});\n        \
             for (t = 0; t < count; ++t) printf(\"%.17g\\n\", {name}_step(&s, v[t]));\n    }}\n"
        );
    }
    main += &format!(
        "int main(void) {{\n    static double v[1000];\n    int count = 0;\n    \
         while (count < 1000 && scanf(\"%lf\", &v[count]) == 1) ++count;\n{calls}    return 0;\n}}\n"
    );
    // Compilers warn of constants without use in the main file, not in a header, of which this is a stand-in.
    let flags =
        ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wno-unused-const-variable", "-Werror", "-O1"];
    output(
        Command::new("cc").args(flags).args(["-x", "c", "-", "-o", "main", "-lm"]).current_dir(&folder),
        &main,
    );
    let stdin: String = v.iter().map(|v| format!("{v:?}\n")).collect();
    let found = numbers(&output(&mut Command::new(folder.join("main")), &stdin));
    for ((name, model), found) in models.iter().zip(found.chunks(v.len())) {
        compare(name, found, &here(model, &v).1);
    }
}
