//! Control variates for methods of others: they agree with the plain figures and with those of theory, and are worth what they promise.

use crate::common::Silent;
use std::sync::Arc;
use switchback_identify::Method;
use switchback_study::ForeignName;
use switchback_study::consistency::{Ended, Study};
use switchback_study::foreign::{Design, Estimates, ForeignError, ForeignEstimator, Records};
use switchback_study::results::{Cell, Parameter, Results};
use switchback_study::scenario::{ForeignMethod, Scenario};
use switchback_versions::OwnMethod;

const SCENARIO: &str = r#"study = "consistency"
question = "Is it consistent?"
seed = 5
replicates = 300
[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-40.0, 40.0]
[[border]]
name = "spring"
kind = "leaf_spring"
stiffness = 0.12
hardening = 6e-5
friction = 2.0
[sweep]
noise = [0.2]
samples = [1000, 10000]
points = [4]
methods = ["joint"]
"#;

fn study(text: &str, methods: Vec<(ForeignMethod, Arc<dyn ForeignEstimator>)>) -> Results {
    let (methods, functions): (Vec<_>, Vec<_>) = methods.into_iter().unzip();
    let scenario = Scenario::parse("study.toml", text).expect("a scenario").with_methods(methods);
    let study = Study::plan_with(&scenario, functions).expect("a study");
    study.begin_methods().expect("functions");
    let mut run_state = study.begin();
    assert_eq!(study.run(&mut run_state, &Silent, &mut ()), Ended::Finished);
    study.results(&run_state, String::new())
}

fn function(name: &str, antithetic: bool) -> ForeignMethod {
    let name = ForeignName::new(name).expect("a name");
    ForeignMethod { antithetic, ..ForeignMethod::function(name) }
}

fn own(method: Method) -> Arc<dyn ForeignEstimator> {
    Arc::new(OwnMethod::new(method).expect("both experiments"))
}

fn cells<'r>(results: &'r Results, method: &str) -> Vec<&'r Cell> {
    results.cells.iter().filter(|cell| cell.series.method.name() == method).collect()
}

/// How many times smaller the error of the bias is, the least over all parameters.
fn gain(cell: &Cell) -> f64 {
    let of = |p: &Parameter| Some(p.bias?.mcse() / p.bias_controlled?.mcse());
    cell.parameters.iter().map(|p| of(p).expect("both figures")).fold(f64::INFINITY, f64::min)
}

#[test]
fn with_and_without_partners_they_agree_with_theory_and_the_error_shrinks() {
    let methods =
        vec![(function("pairs", true), own(Method::Joint)), (function("alone", false), own(Method::Joint))];
    let results = study(SCENARIO, methods);
    for name in ["pairs", "alone"] {
        for (cell, ours) in cells(&results, name).into_iter().zip(cells(&results, "joint")) {
            for (p, q) in cell.parameters.iter().zip(&ours.parameters) {
                let agree =
                    |one: Option<switchback_study::results::Measured>, other, at_most: f64, what: &str| {
                        let (one, other): (_, switchback_study::results::Measured) =
                            (one.expect("a figure"), Option::expect(other, "a figure"));
                        let apart = (one.value() - other.value()) / one.mcse().hypot(other.mcse());
                        assert!(apart.abs() < at_most, "{name}, {}, {what}: {one:?} and {other:?}", p.name);
                    };
                agree(p.bias_controlled, q.bias_controlled, 4.5, "bias");
                agree(p.bias_controlled, p.bias, 4.5, "plain bias");
                // Errors from sixteen sections have heavier tails.
                agree(p.sd_controlled, q.sd_controlled, 6.0, "sd");
                agree(p.sd_controlled, p.sd, 5.0, "plain sd");
            }
            let least = if cell.samples == 10_000 { 15.0 } else { 5.0 };
            assert!(gain(cell) > least, "{name}, N = {}: {}", cell.samples, gain(cell));
        }
    }
}

#[test]
fn estimates_of_our_methods_from_records_alone_are_those_of_the_study() {
    for (order, a, b) in [
        (1, "[-0.7]", "[0.3]"),
        (2, "[-1.2, 0.45]", "[0.15, 0.1]"),
        (3, "[-0.9, 0.3, -0.05]", "[0.2, 0.1, 0.05]"),
    ] {
        for method in ["joint", "efficient", "linear-arx", "memoryless"] {
            let text = SCENARIO
                .replace("[-1.2, 0.45]", a)
                .replace("[0.15, 0.10]", b)
                .replace("[\"joint\"]", &format!("[{method:?}]"))
                .replace("[1000, 10000]", "[500]");
            let of = Method::from_name(method).expect("a method");
            let scenario = Scenario::parse("study.toml", &text).expect("a scenario");
            let scenario = scenario.with_methods([function("theirs", true)]);
            let study = Study::plan_with(&scenario, vec![own(of)]).expect("a study");
            for replicate in [0, 1, 17] {
                let singles = study.replicate(replicate);
                let [ours, theirs] = &singles[..] else { panic!("two cells") };
                let (ours, theirs) =
                    (ours.estimates.as_ref().expect("one"), theirs.estimates.as_ref().expect("one"));
                assert_eq!(ours.len(), theirs.len());
                for (one, other) in ours.iter().zip(theirs) {
                    assert_eq!(one.name, other.name);
                    let scale = one.truth.abs().max(1.0);
                    assert!(
                        (one.error - other.error).abs() <= 1e-12 * scale,
                        "order {order}, {method}, {replicate}: {one:?} {other:?}"
                    );
                    assert!((one.se - other.se).abs() <= 1e-9 * one.se, "{one:?} {other:?}");
                }
            }
        }
    }
}

/// Fails where the noise is large, so that what is left is no fair sample of it.
#[derive(Debug)]
struct Choosy;

impl ForeignEstimator for Choosy {
    fn begin(&self) -> Result<String, ForeignError> {
        Ok(String::new())
    }

    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>> {
        let all = OwnMethod::new(Method::Joint).expect("a method").estimate(design, records);
        let choose = |found: Result<Estimates, String>| match found {
            Ok(found) if found[0].0 > -1.19 => Err("it is not believed".to_owned()),
            found => found,
        };
        all.into_iter().map(choose).collect()
    }
}

#[test]
fn failures_that_depend_on_the_noise_do_no_harm() {
    for antithetic in [true, false] {
        let text =
            SCENARIO.replace("replicates = 300", "replicates = 1200").replace("[1000, 10000]", "[300]");
        let results = study(&text, vec![(function("choosy", antithetic), Arc::new(Choosy))]);
        let cell = cells(&results, "choosy")[0];
        assert!((20..900).contains(&cell.failures.count), "{:?}", cell.failures.count);
        for p in &cell.parameters {
            let (plain, controlled) = (p.bias.expect("a bias"), p.bias_controlled.expect("a bias"));
            // Both are of the same replicates.
            let apart = (plain.value() - controlled.value()) / plain.mcse();
            assert!(apart.abs() < 4.0, "{}: {plain:?} {controlled:?}", p.name);
        }
        let (plain, controlled) = (cell.parameters[0].bias, cell.parameters[0].bias_controlled);
        let (plain, controlled) = (plain.expect("a bias"), controlled.expect("a bias"));
        assert!(plain.value() < -5.0 * plain.mcse(), "the choice shows: {plain:?}");
        assert!(controlled.value() < -5.0 * controlled.mcse(), "and is not hidden: {controlled:?}");
    }
}

#[test]
fn coloured_noise_is_no_exception() {
    let coloured = "[[case]]\nname = \"coloured\"\ndisturbance = { kind = \"coloured\", ar = [-0.6] }\n\
                    [[case]]\nname = \"output\"\ndisturbance = { kind = \"output\" }\n[sweep]";
    let text = SCENARIO.replace("[sweep]", coloured);
    let results = study(&text, vec![(function("theirs", true), own(Method::Joint))]);
    for (cell, ours) in cells(&results, "theirs").into_iter().zip(cells(&results, "joint")) {
        for (p, q) in cell.parameters.iter().zip(&ours.parameters) {
            let plain = |p: &Parameter| (p.bias.expect("a bias"), p.sd.expect("a deviation"));
            let ((bias, sd), (ours_bias, ours_sd)) = (plain(p), plain(q));
            assert!((bias.value() - ours_bias.value()).abs() < 2e-4 * bias.mcse(), "{}", p.name);
            assert!((sd.value() - ours_sd.value()).abs() < 2e-4 * sd.mcse(), "{}", p.name);
            let (controlled, exact) =
                (p.bias_controlled.expect("a bias"), q.bias_controlled.expect("a bias"));
            let apart = (controlled.value() - exact.value()) / controlled.mcse().hypot(exact.mcse());
            assert!(apart.abs() < 4.5, "{}: {controlled:?} {exact:?}", p.name);
        }
        // `joint` has a bias under this noise, whose own fluctuations nothing controls.
        assert!(gain(cell) > 0.98, "{}: {}", cell.series, gain(cell));
    }
}

/// Off by two standard errors, which it does not know.
#[derive(Debug)]
struct Off;

impl ForeignEstimator for Off {
    fn begin(&self) -> Result<String, ForeignError> {
        Ok(String::new())
    }

    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>> {
        let all = OwnMethod::new(Method::Joint).expect("a method").estimate(design, records);
        let off = |(value, se): (f64, f64)| (value + 2.0 * se, se);
        all.into_iter().map(|found| Ok(found?.into_iter().map(off).collect())).collect()
    }
}

#[test]
fn around_the_mean_estimate_intervals_are_as_wide_as_estimates_scatter_whatever_the_bias() {
    let text = SCENARIO.replace("[1000, 10000]", "[1000]").replace("replicates = 300", "replicates = 1000");
    let right = (function("right", true), own(Method::Joint));
    let results = study(&text, vec![right, (function("off", true), Arc::new(Off))]);
    for (right, off) in
        cells(&results, "right")[0].parameters.iter().zip(&cells(&results, "off")[0].parameters)
    {
        let (plain, around) =
            (right.coverage.expect("coverage"), right.coverage_bias_eliminated.expect("coverage"));
        // There is next to no bias: both count the same intervals, but for a few.
        assert!((plain.value() - around.value()).abs() < 0.006, "{}: {plain:?} {around:?}", right.name);
        let (plain, of_off) =
            (off.coverage.expect("coverage"), off.coverage_bias_eliminated.expect("coverage"));
        assert!(plain.value() < 0.6, "{}: {plain:?}", off.name);
        assert!((of_off.value() - around.value()).abs() < 0.006, "{}: {of_off:?} {around:?}", off.name);
        assert!((around.mcse() - 0.0069).abs() < 0.001, "{around:?}");
    }
    // Methods of ours go eight at a time, and keep no ends.
    assert!(cells(&results, "joint")[0].parameters.iter().all(|p| p.coverage_bias_eliminated.is_none()));
}
