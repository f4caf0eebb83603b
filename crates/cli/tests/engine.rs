//! The superposed engine against simulating every cell, sample by sample.

use crate::common::Silent;
use switchback_identify::method::Method;
use switchback_identify::pulse::{PulseData, PulseMethod, StepMean};
use switchback_model::Record;
use switchback_study::consistency::{ReplayedExperiment, records, replay, run};
use switchback_study::results::{Cell, Results, to_json};
use switchback_study::scenario::{Coupling, Scenario};

const SCENARIO: &str = r#"
study = "consistency"
question = "Do both engines agree?"
seed = 7
replicates = 2
[system]
a = [-1.2, 0.45]
b = [0.15, 0.10]
interval = [-40.0, 40.0]
[[border]]
name = "spring"
kind = "leaf_spring"
stiffness = 0.2
friction = 1.5
[[border]]
name = "hardening"
kind = "leaf_spring"
stiffness = 0.12
hardening = 6e-5
friction = 2.0
[sweep]
noise = [0.05, 0.8]
samples = [150, 333]
points = [2, 5]
methods = ["paper-descendant", "paper-ascendant", "joint", "efficient", "instrumental", "linear-arx", "memoryless"]
"#;

/// The first `samples` samples of a simulated record, read as a user's record would be.
fn data(experiment: &ReplayedExperiment, order: usize, samples: usize) -> PulseData {
    let length = experiment.lead + samples;
    // The first sample of a record loads the border and is left out.
    let with_loading = |x: &[f64]| [&x[..1], &x[..length]].concat();
    let record = Record::new(with_loading(&experiment.v), with_loading(&experiment.y)).expect("finite");
    PulseData::from_record(&record, experiment.direction.visited_branch(), order, experiment.lead)
        .expect("a pulse experiment")
}

#[test]
fn superposition_gives_the_estimates_of_the_simulated_records() {
    let scenario = Scenario::parse("engine.toml", SCENARIO).expect("a valid scenario");
    let order = scenario.cases()[0].order;
    for replicate in [0, 3] {
        let records = records(&scenario, replicate).expect("simulated");
        let mut cells = replay(&scenario, replicate).expect("replayed").into_iter();
        for setting in &records {
            for (checkpoint, &samples) in scenario.sweep().samples.iter().enumerate() {
                let data = [0, 1].map(|k| data(&setting.experiments[k], order, samples));
                let step = |k: usize| StepMean {
                    mean: setting.experiments[k].step_means[checkpoint],
                    samples: samples as f64,
                };
                let both = [&data[0], &data[1]];
                for &method in &scenario.sweep().methods {
                    let cell = cells.next().expect("one cell a setting, N and method");
                    assert_eq!((&cell.series.method, cell.samples), (&method.into(), samples));
                    let fit = match method {
                        Method::PaperDescendant => PulseMethod::Paper { experiment: both[0], step: step(0) },
                        Method::PaperAscendant => PulseMethod::Paper { experiment: both[1], step: step(1) },
                        Method::Joint => PulseMethod::Joint { descendant: both[0], ascendant: both[1] },
                        Method::Efficient => PulseMethod::Efficient(&both),
                        Method::Instrumental => PulseMethod::Instrumental(&both),
                        Method::LinearArx => PulseMethod::LinearArx(&both),
                        Method::Memoryless => PulseMethod::Memoryless(&both),
                        Method::Free => unreachable!("not in the scenario"),
                    };
                    let direct: Vec<f64> =
                        fit.fit().expect("excited").parameters().map(|p| p.value).collect();
                    let superposed = cell.estimates.expect("excited");
                    assert_eq!(direct.len(), superposed.len());
                    for (d, s) in direct.iter().zip(&superposed) {
                        assert!((d - s).abs() < 1e-9 * d.abs().max(1.0), "{}: {d} against {s}", cell.series);
                    }
                }
            }
        }
        assert!(cells.next().is_none());
    }
}

/// Runs [`SCENARIO`] with `header` in place of its number of replicates.
fn study(header: &str, threads: usize) -> Results {
    let text = SCENARIO.replace("replicates = 2", header);
    let scenario = Scenario::parse("engine.toml", &text).expect("a valid scenario");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| run(&scenario, "switchback engine.toml".to_owned(), &Silent)).expect("a study")
}

#[test]
fn results_are_the_same_bytes_on_any_number_of_threads() {
    let one = to_json(&study("replicates = 150", 1));
    for threads in [2, 8] {
        assert!(to_json(&study("replicates = 150", threads)) == one, "{threads} threads change the results");
    }
}

#[test]
fn a_study_averages_what_its_replicates_give_one_by_one() {
    let replicates = 37;
    let results = study(&format!("replicates = {replicates}"), 2);
    let scenario = Scenario::parse("engine.toml", SCENARIO).expect("a valid scenario");
    let mut sums: Vec<Vec<f64>> = results.cells.iter().map(|c| vec![0.0; c.parameters.len()]).collect();
    for r in 0..replicates {
        for (sums, cell) in sums.iter_mut().zip(replay(&scenario, r).expect("replayed")) {
            sums.iter_mut().zip(cell.estimates.expect("excited")).for_each(|(sum, x)| *sum += x);
        }
    }
    for (cell, sums) in results.cells.iter().zip(&sums) {
        assert_eq!((cell.replicates, cell.failures.count), (replicates as usize, 0));
        for (parameter, sum) in cell.parameters.iter().zip(sums) {
            let (fast, slow) = (parameter.mean_estimate.expect("estimated"), sum / f64::from(replicates));
            assert!(
                (fast - slow).abs() < 1e-9 * slow.abs().max(1.0),
                "{}, {}: {fast} against {slow}",
                cell.series,
                parameter.name
            );
        }
    }
}

#[test]
fn independent_cells_agree_with_shared_ones_within_the_monte_carlo_error() {
    let shared = study("replicates = 300", 2);
    let independent = study("replicates = 300\ncoupling = \"independent\"", 2);
    assert_eq!((shared.coupling, independent.coupling), (Coupling::Shared, Coupling::Independent));
    let mut squares = Vec::new();
    for (s, i) in shared.cells.iter().zip(&independent.cells) {
        assert_eq!((&s.series, s.samples), (&i.series, i.samples));
        for (s, i) in s.parameters.iter().zip(&i.parameters) {
            let (s, i) = (s.bias.expect("estimated"), i.bias.expect("estimated"));
            if s.mcse() > 0.0 {
                squares.push((s.value() - i.value()).powi(2) / (s.mcse().powi(2) + i.mcse().powi(2)));
            }
        }
    }
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    assert!((0.5..1.6).contains(&mean), "mean squared distance {mean} over {} parameters", squares.len());
    let worst = squares.iter().fold(0.0, |m: f64, x| m.max(*x));
    assert!(worst < 25.0, "the worst is {} errors apart", worst.sqrt());
}

#[test]
fn cells_stop_when_they_are_precise_enough() {
    let sd_errors = |results: &Results| -> Vec<(usize, f64)> {
        let of_cell = |c: &Cell| {
            let relative = c.parameters.iter().filter_map(|p| p.sd).map(|sd| sd.mcse() / sd.value());
            (c.replicates, relative.fold(0.0, f64::max))
        };
        results.cells.iter().map(of_cell).collect()
    };
    // The relative error of a standard deviation is (2(R − 1))^-1/2, so 0.03 takes 557 replicates.
    let enough = study("replicates = 40\nprecision = { sd_relative_mcse = 0.03 }\nmax_replicates = 5000", 2);
    assert!(enough.cells.iter().all(|c| c.precise == Some(true)));
    for (replicates, error) in sd_errors(&enough) {
        assert!(error <= 0.0301 && (557..2500).contains(&replicates), "{error} after {replicates}");
    }
    let cut_short =
        study("replicates = 40\nprecision = { sd_relative_mcse = 0.03 }\nmax_replicates = 200", 2);
    let at_limit = |c: &Cell| (c.replicates, c.precise) == (200, Some(false));
    assert!(cut_short.cells.iter().all(at_limit), "the limit holds in every cell, and every cell says so");
    // How fast the error of a bias falls differs from cell to cell: those that meet the demand first stop first.
    let uneven = study("replicates = 40\nprecision = { bias_mcse = 0.01 }\nmax_replicates = 600", 2);
    let counts: Vec<usize> = uneven.cells.iter().map(|c| c.replicates).collect();
    assert!(counts.iter().min() < counts.iter().max(), "every cell took {counts:?}");
    assert!(counts.iter().all(|r| (40..=600).contains(r)));
}
