//! The engine that simulates every cell and solves dense least squares, against the one that superposes.

use crate::common::Silent;
use proptest::prelude::*;
use std::path::Path;
use switchback_study::consistency::run;
use switchback_study::results::{Results, to_json};
use switchback_study::scenario::{Engine, Scenario};

/// Runs a scenario on both engines and compares every figure.
fn both_agree(scenario: &Scenario) {
    let [superposed, direct] = Engine::ALL.map(|engine| {
        run(&scenario.clone().on(engine), "switchback direct.toml".to_owned(), &Silent).expect("a study")
    });
    assert_eq!((superposed.engine, direct.engine), (Engine::Superposed, Engine::Direct));
    assert_eq!(superposed.cells.len(), direct.cells.len());
    estimates_agree(&superposed, &direct);
}

#[track_caller]
fn estimates_agree(superposed: &Results, direct: &Results) {
    for (s, d) in superposed.cells.iter().zip(&direct.cells) {
        assert_eq!((&s.series, s.samples, &s.failures), (&d.series, d.samples, &d.failures));
        for (p, q) in s.parameters.iter().zip(&d.parameters) {
            let place = || format!("{}, N = {}, {}", s.series, s.samples, p.name);
            let close = |x: f64, y: f64, scale: f64| (x - y).abs() <= 1e-9 * scale.max(1.0);
            let (x, y) = (p.mean_estimate.expect("estimated"), q.mean_estimate.expect("estimated"));
            assert!(close(x, y, x.abs()), "{}: {x} against {y}", place());
            for (what, x, y) in [
                ("sd", p.sd, q.sd),
                ("bias", p.best_bias(), q.best_bias()),
                ("standard error", p.model_sd, q.model_sd),
            ] {
                let (x, y) = (x.expect("measured"), y.expect("measured"));
                // Stored to a ten-thousandth of its error.
                let slack = 2e-4 * x.mcse().max(y.mcse());
                let apart = (x.value() - y.value()).abs();
                assert!(
                    apart <= slack + 1e-9 * x.value().abs().max(1.0),
                    "{what} of {}: {x:?}, {y:?}",
                    place()
                );
            }
            assert_eq!(p.coverage, q.coverage, "{}", place());
        }
    }
}

#[test]
fn the_quick_scenario_comes_out_the_same() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/quick.toml");
    both_agree(&Scenario::read(&path).expect("a shipped scenario"));
}

#[test]
fn threads_do_not_matter_to_it() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/quick.toml");
    let scenario = Scenario::read(&path).expect("a shipped scenario").on(Engine::Direct);
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        to_json(
            &pool.install(|| run(&scenario, "switchback quick.toml".to_owned(), &Silent)).expect("a study"),
        )
    };
    let one = bytes(1);
    assert!([2, 8].into_iter().all(|threads| bytes(threads) == one));
}

#[test]
fn broken_assumptions_come_out_the_same() {
    let text = r#"
study = "consistency"
question = "Do both engines agree where assumptions fail?"
seed = 5
replicates = 3
[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-1.0, 1.0]
[[border]]
name = "leaf spring"
kind = "leaf_spring"
stiffness = 0.6
hardening = 0.4
friction = 0.3
[[case]]
name = "coloured equation noise"
disturbance = { kind = "coloured", ar = [-0.8], ma = [0.3] }
[[case]]
name = "output noise"
disturbance = { kind = "output" }
[[case]]
name = "order too low"
order = 1
[[case]]
name = "pulses one sample apart"
system = { a = [-0.7], b = [0.3] }
spacing = 1
[sweep]
noise = [0.05, 0.3]
samples = [200, 777]
points = [4, 5]
methods = ["paper-descendant", "paper-ascendant", "joint", "efficient", "instrumental", "linear-arx", "memoryless"]
"#;
    both_agree(&Scenario::parse("direct.toml", text).expect("a valid scenario"));
}

#[test]
fn estimates_from_any_record_come_out_the_same() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/any-record.toml");
    let shipped = std::fs::read_to_string(path).expect("a shipped scenario");
    let short = shipped.replace("replicates = 400", "replicates = 3").replace(", 10000, 30000]", "]");
    assert_ne!(shipped, short);
    both_agree(&Scenario::parse("any-record.toml", &short).expect("a valid scenario"));
}

#[test]
fn estimates_on_refined_grids_come_out_the_same() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/smooth-record.toml");
    let shipped = std::fs::read_to_string(path).expect("a shipped scenario");
    let short = shipped.replace("replicates = 400", "replicates = 3").replace("3000, 10000, 30000]", "2000]");
    assert_ne!(shipped, short);
    both_agree(&Scenario::parse("smooth-record.toml", &short).expect("a valid scenario"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_system_border_and_sweep_comes_out_the_same(
        pole in 0.1..0.8_f64,
        angle in 0.2..2.5_f64,
        b in (0.1..1.0_f64, 0.0..0.8_f64),
        spring in (0.2..2.0_f64, 0.0..0.5_f64, 0.1..1.0_f64),
        (noise, points) in (0.01..0.2_f64, 2..7_usize),
        (samples, more) in (150..400_usize, 1..500_usize),
        seed in 0..1000_u32,
    ) {
        let text = format!(
            r#"
study = "consistency"
question = "Do both engines agree?"
seed = {seed}
replicates = 2
[system]
a = [{}, {}]
b = [{}, {}]
interval = [-1.0, 1.5]
[[border]]
name = "spring"
kind = "leaf_spring"
stiffness = {}
hardening = {}
friction = {}
[sweep]
noise = [{noise}]
samples = [{samples}, {}]
points = [{points}]
methods = ["paper-descendant", "paper-ascendant", "joint", "efficient", "instrumental", "linear-arx", "memoryless"]
"#,
            -2.0 * pole * angle.cos(), pole * pole, b.0, b.1, spring.0, spring.1, spring.2, samples + more,
        );
        both_agree(&Scenario::parse("direct.toml", &text).expect("a valid scenario"));
    }
}

/// Both engines minimise the same free-run error: one over every sample, the other over three periods, the last of which stands for all that followed.
#[test]
fn fits_of_the_free_run_come_out_the_same() {
    let text = r#"
study = "consistency"
question = "Is a folded free run the free run?"
seed = 7
replicates = 3
[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-1.0, 1.0]
[[border]]
name = "hardening"
kind = "leaf_spring"
stiffness = 0.5
hardening = 0.6
friction = 0.25
[[case]]
name = "output noise"
disturbance = { kind = "output" }
fit = "free run"
[[case]]
name = "output noise, knots refined"
disturbance = { kind = "output" }
knots = "refined"
fit = "free run"
[[case]]
name = "white equation noise"
fit = "free run"
[sweep]
noise = [0.1]
samples = [500, 2100]
points = [5]
methods = ["free"]
"#;
    let scenario = Scenario::parse("direct.toml", text).expect("a valid scenario");
    let [superposed, direct] = Engine::ALL.map(|engine| {
        run(&scenario.clone().on(engine), "switchback direct.toml".to_owned(), &Silent).expect("a study")
    });
    for (s, d) in superposed.cells.iter().zip(&direct.cells) {
        for (p, q) in s.parameters.iter().zip(&d.parameters) {
            let (x, y) = (p.mean_estimate.expect("estimated"), q.mean_estimate.expect("estimated"));
            let (se, direct_se) = (
                p.model_sd.expect("a standard error").value(),
                q.model_sd.expect("a standard error").value(),
            );
            let place = || format!("{}, N = {}, {}: {x} and {y}", s.series, s.samples, p.name);
            // Iterations end where the sum of squares falls by no more than a billionth.
            assert!((x - y).abs() < 1e-4 * se, "{}, standard error {se}", place());
            assert!((se - direct_se).abs() < 1e-4 * se, "{}, standard errors {se} and {direct_se}", place());
        }
    }
}

/// Orders up to six have code of their own; what is larger goes one by one.
#[test]
fn every_order_comes_out_the_same_by_every_designed_method() {
    for order in 1..=20 {
        let a: Vec<f64> = (0..order).map(|k| if k % 2 == 0 { -0.3 } else { 0.2 } / order as f64).collect();
        let b: Vec<f64> = (0..order).map(|k| 0.1 + 0.02 * k as f64).collect();
        let text = format!(
            "study = \"consistency\"\nquestion = \"?\"\nseed = 1\nreplicates = 3\n[system]\na = {a:?}\nb = {b:?}\n\
             interval = [-40.0, 40.0]\n[[border]]\nname = \"h\"\nkind = \"relay\"\nlow = 0.0\nhigh = 1.0\n\
             ascending_threshold = 1.0\ndescending_threshold = -1.0\n[sweep]\nnoise = [0.01]\nsamples = [1500]\npoints = [2]\n\
             methods = [\"paper-descendant\", \"paper-ascendant\", \"joint\", \"efficient\", \"instrumental\", \"memoryless\"]\n"
        );
        both_agree(
            &Scenario::parse("order.toml", &text).unwrap_or_else(|error| panic!("order {order}: {error}")),
        );
    }
}
