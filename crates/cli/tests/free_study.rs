//! Sweeps of the method `free`, as a user runs them.

use assert_cmd::Command;
use std::fs;
use std::process::Output;
use switchback_identify::method::Method;
use switchback_study::results::{self, Results, Verdict};

/// Straight pieces with corners at −1, 0 and 1: on the grid for m = 3, beside it for m = 4.
/// Replicates are a multiple of the 16 sections of the jackknife.
const SMALL: &str = r#"study = "consistency"
question = "Is it consistent from any record?"
seed = 3
replicates = 96
[system]
a = [-0.7]
b = [0.3]
interval = [-1.0, 1.0]
[[border]]
name = "straight pieces"
kind = "table"
ascending = [{ v = -1.0, u = -0.5 }, { v = 0.0, u = 0.6 }, { v = 1.0, u = 1.0 }]
descending = [{ v = -1.0, u = -1.0 }, { v = 0.0, u = -0.6 }, { v = 1.0, u = 0.5 }]
[sweep]
noise = [0.02]
samples = [500, 1500, 4500]
points = [3]
methods = ["free"]
[expect]
consistent = ["free"]
within_error = ["sd_slope", "sd_over_theory", "coverage"]
"#;

struct Study(tempfile::TempDir);

impl Study {
    fn of(scenario: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("study.toml"), scenario).expect("it can be written");
        Self(folder)
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::cargo_bin("switchback").expect("the program is built");
        command.current_dir(self.0.path()).args(["study.toml", "--quiet", "--out", "out"]).args(arguments);
        command.output().expect("it runs")
    }

    #[track_caller]
    fn results(&self, arguments: &[&str]) -> Results {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        results::read(&self.0.path().join("out/results.json")).expect("a results file")
    }
}

#[test]
fn a_grid_that_holds_the_borders_is_consistent_and_at_its_theory() {
    let study = Study::of(SMALL);
    let results = study.results(&[]);
    assert!(results.as_expected(), "{:?}", results.expectations);
    assert!(results.summaries.iter().all(|s| s.verdict == Verdict::Consistent));
    let last = results.cells.last().expect("a cell");
    assert_eq!(last.series.method, Method::Free);
    assert_eq!((last.samples, last.replicates), (4500, 96));
    let names: Vec<&str> = last.parameters.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(
        names,
        ["a1", "b1", "F_desc(V1)", "F_desc(V2)", "F_desc(V3)", "F_asc(V1)", "F_asc(V2)", "F_asc(V3)"]
    );
    for file in ["bias-free.svg", "sd-free.svg", "borders-free.svg"] {
        assert!(study.0.path().join("out").join(file).is_file(), "{file} is missing");
    }
}

#[test]
fn the_control_variate_sharpens_the_bias() {
    for parameter in &Study::of(SMALL).results(&[]).cells.last().expect("a cell").parameters {
        let (plain, controlled) = (parameter.bias.expect("a bias"), parameter.bias_controlled.expect("one"));
        assert!(controlled.mcse() < 0.2 * plain.mcse(), "{}: {plain:?}, {controlled:?}", parameter.name);
    }
}

#[test]
fn a_grid_beside_the_corners_is_inconsistent() {
    let beside = SMALL.replace("points = [3]", "points = [4]").replace("consistent = [", "inconsistent = [");
    let results = Study::of(&beside.replace("\nwithin_error", "\n#")).results(&[]);
    assert!(results.as_expected(), "{:?}", results.expectations);
    assert!(results.cells.iter().flat_map(|c| &c.parameters).all(|p| p.theory_sd.is_none()));
}

/// Four even knots lie beside the corner at 0, and so do the middles of their cells.
fn beside_the_corners(case: &str) -> String {
    let sweep =
        SMALL.split("[expect]").next().expect("the part before it").replace("points = [3]", "points = [4]");
    format!("{sweep}{case}")
}

#[test]
fn a_refined_grid_covers_corners_that_a_given_one_misses() {
    let study = Study::of(&beside_the_corners(
        r#"
[[case]]
name = "given"
[[case]]
name = "refined"
knots = "refined"
expect = { coverage = { mean = [0.88, 1.0], least = 0.8 }, width = { of = "refined", at_most = 1.0 } }
[[case]]
name = "known"
knots = "known"
"#,
    ));
    let results = study.results(&[]);
    assert!(results.as_expected(), "{:?}", results.expectations);
    assert_eq!(results.expectations.len(), 2);
    let last = |case: &str| results.cells.iter().rfind(|c| c.series.case == case).expect("a cell");
    let covered = |case: &str| last(case).find("F_desc(V2)").and_then(|p| p.coverage).expect("one").value();
    assert!(covered("given") < 0.5 && covered("refined") > 0.8);
    let places = |case: &str| last(case).parameters.iter().map(|p| p.v).collect::<Vec<_>>();
    assert_eq!(places("given"), places("refined"));
    assert!(last("refined").parameters.iter().all(|p| p.theory_sd.is_none()));
}

#[test]
fn a_promise_of_coverage_that_is_broken_is_reported() {
    let study = Study::of(&beside_the_corners(
        r#"
[[case]]
name = "given"
expect = { coverage = { mean = [0.9, 0.98], least = 0.85 }, width = { of = "given", at_most = 0.9 } }
"#,
    ));
    let output = study.run(&[]);
    assert_eq!(output.status.code(), Some(1));
    let results = results::read(&study.0.path().join("out/results.json")).expect("a results file");
    assert_eq!(results.expectations.iter().map(|e| e.held).collect::<Vec<_>>(), [false, false]);
}

#[test]
fn output_noise_spoils_it() {
    let noisy = SMALL.split("[expect]").next().expect("the part before it").to_owned()
        + "[[case]]\nname = \"output noise\"\ndisturbance = { kind = \"output\" }\nexpect = { inconsistent = [\"free\"] }\n";
    assert!(Study::of(&noisy).results(&[]).as_expected());
}

#[test]
fn results_do_not_depend_on_threads() {
    let bytes = |threads| {
        let study = Study::of(SMALL);
        study.results(&["--threads", threads]);
        fs::read(study.0.path().join("out/results.json")).expect("a results file")
    };
    assert!(bytes("1") == bytes("4"));
}

#[test]
fn independent_cells_see_other_noise_and_agree() {
    let independent = SMALL.replace("seed = 3", "seed = 3\ncoupling = \"independent\"");
    let (shared, own) = (Study::of(SMALL).results(&[]), Study::of(&independent).results(&[]));
    assert!(own.as_expected(), "{:?}", own.expectations);
    // The first cell of either is the first on its stream.
    for (shared, own) in shared.cells.iter().zip(&own.cells).skip(1) {
        assert_eq!((shared.samples, &shared.series), (own.samples, &own.series));
        assert_ne!(shared.parameters[0].bias, own.parameters[0].bias);
        assert_eq!(shared.parameters[0].truth, own.parameters[0].truth);
    }
}

#[test]
fn pulse_methods_beside_it_keep_their_numbers() {
    let small = SMALL.split("[expect]").next().expect("the part before it");
    let pulses = small.replace("methods = [\"free\"]", "methods = [\"efficient\"]");
    let both = small.replace("methods = [\"free\"]", "methods = [\"free\", \"efficient\"]");
    let (alone, beside) = (Study::of(&pulses).results(&[]), Study::of(&both).results(&[]));
    let beside: Vec<_> = beside.cells.into_iter().filter(|c| c.series.method == Method::Efficient).collect();
    assert_eq!(alone.cells, beside);
}

#[test]
fn a_grid_of_one_knot_and_records_too_short_for_it_are_refused() {
    for (scenario, reported) in [
        (SMALL.replace("points = [3]", "points = [1]"), "two knots or more"),
        (SMALL.replace("samples = [500", "samples = [14"), "free: "),
    ] {
        let study = Study::of(&scenario);
        let output = study.run(&[]);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(reported), "{stderr}");
        assert!(!study.0.path().join("out").exists(), "nothing is written");
    }
}
