//! What a study costs that asks an estimator which does nothing: what asking others costs is held against it by `crates/python/tests/method_overhead.py`.
#![cfg(target_os = "linux")]

use crate::common::Silent;
use std::fs;
use std::sync::Arc;
use switchback_study::ForeignName;
use switchback_study::consistency::{Ended, Study};
use switchback_study::foreign::{Design, Estimates, ForeignError, ForeignEstimator, Records};
use switchback_study::scenario::{ForeignMethod, Scenario};

const SCENARIO: &str = r#"study = "consistency"
question = "What does asking cost?"
seed = 1
replicates = REPLICATES
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
samples = [1000]
points = [4]
methods = ["memoryless"]
"#;

/// Answers zeros.
#[derive(Debug)]
struct Nothing;

impl ForeignEstimator for Nothing {
    fn begin(&self) -> Result<String, ForeignError> {
        Ok(String::new())
    }

    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>> {
        records.iter().map(|_| Ok(vec![(0.0, f64::NAN); design.parameters.len()])).collect()
    }
}

/// Seconds of processor time of this process, to a hundredth.
fn seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").expect("/proc");
    let behind = stat.rsplit_once(") ").expect("a name").1;
    let ticks: u64 = behind.split(' ').skip(11).take(2).map(|x| x.parse::<u64>().expect("ticks")).sum();
    ticks as f64 / 100.0
}

/// Microseconds of processor time an answer.
fn cost(replicates: usize) -> f64 {
    let text = SCENARIO.replace("REPLICATES", &replicates.to_string());
    let method = ForeignMethod::function(ForeignName::new("nothing").expect("a name"));
    let scenario = Scenario::parse("study.toml", &text).expect("a scenario").with_methods([method]);
    let study = Study::plan_with(&scenario, vec![Arc::new(Nothing)]).expect("a study");
    study.begin_methods().expect("a function");
    let (mut run_state, begun) = (study.begin(), seconds());
    assert_eq!(study.run(&mut run_state, &Silent, &mut ()), Ended::Finished);
    1e6 * (seconds() - begun) / (2 * replicates) as f64
}

#[test]
#[ignore = "a measurement, of processor time of this process alone"]
fn overhead_of_records_alone() {
    println!("{:.1} us an answer", cost(20_000));
}
