//! The superposed engine against simulating every cell, sample by sample.

use switchback::scenario::{Method, Scenario};
use switchback::study::{ReplayedExperiment, records, replay};
use switchback_estimator::Record;
use switchback_estimator::estimators::pulse::{PulseData, PulseMethod, StepMean};

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
methods = ["paper-descendant", "paper-ascendant", "joint", "efficient", "linear-arx", "memoryless"]
"#;

/// The first `samples` samples of a simulated record, read as a user's record would be.
fn data(experiment: &ReplayedExperiment, order: usize, samples: usize) -> PulseData {
    let length = experiment.lead + samples;
    // The first sample of a record loads the border and is left out.
    let with_loading = |x: &[f64]| [&x[..1], &x[..length]].concat();
    let record = Record::new(with_loading(&experiment.v), with_loading(&experiment.y)).expect("finite");
    PulseData::from_record(&record, experiment.direction.visited_branch(), order, order)
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
                    assert_eq!((cell.series.method, cell.samples), (method, samples));
                    let fit = match method {
                        Method::PaperDescendant => PulseMethod::Paper { experiment: both[0], step: step(0) },
                        Method::PaperAscendant => PulseMethod::Paper { experiment: both[1], step: step(1) },
                        Method::Joint => PulseMethod::Joint { descendant: both[0], ascendant: both[1] },
                        Method::Efficient => PulseMethod::Efficient(&both),
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
