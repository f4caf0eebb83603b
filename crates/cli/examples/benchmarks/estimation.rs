//! Models that the program identifies from the record for estimation, judged on the record for tests.

use std::fmt::Write as _;
use switchback_diagnose::Settings;
use switchback_io::diagnosis::{self, Report, Subject};
use switchback_io::identification::{Method, identify};
use switchback_io::model;
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// A benchmark with one record for estimation and one for tests.
#[derive(Debug, Clone)]
pub(crate) struct Benchmark {
    pub(crate) name: &'static str,
    pub(crate) sample_time: f64,
    pub(crate) labels: [&'static str; 2],
    pub(crate) estimation: Record,
    pub(crate) test: Record,
    /// First samples of the test that are not judged.
    pub(crate) skipped: usize,
}

/// Root mean square.
pub(crate) fn rms(errors: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = errors.len() as f64;
    (errors.map(|e| e * e).sum::<f64>() / count).sqrt()
}

impl Benchmark {
    /// Rows of the models that the program identifies from the record for estimation, each with its error on the test, and the diagnosis of that record.
    pub(crate) fn rows(&self) -> miette::Result<(String, Report)> {
        let mut rows = String::new();
        let mut row = |what: &str, error: f64| {
            writeln!(rows, "{what:<62} {error:>10.3e}").expect("a string takes all");
        };
        let rig = self.rig(vec![
            record("estimation", Usage::Fit, &self.estimation, 0..self.estimation.v().len()),
            record("test", Usage::Holdout, &self.test, 0..self.test.v().len()),
        ]);
        for method in [Method::LinearArx, Method::Memoryless, Method::Free] {
            let found = identify(&rig, method)?;
            let run = found.runs[1].as_ref().expect("a run of each record");
            row(&format!("identify --method {method}"), self.error(&run.simulated));
        }
        let report = diagnosis::examine(Subject::choose(self.split(), None)?, &Settings::default())?;
        for (name, file) in model::diagnosed(&report) {
            let run = file.run(self.test.v(), Some(self.test.y())).expect("the test is long enough");
            row(&format!("gap, {}", name.trim_end_matches(".json")), self.error(&run.y));
        }
        Ok((rows, report))
    }

    fn error(&self, simulated: &[f64]) -> f64 {
        let errors = self.test.y().iter().zip(simulated).map(|(y, run)| y - run);
        rms(errors.skip(self.skipped))
    }

    /// The record for estimation alone, its last third held out: a diagnosis looks at held-out records.
    fn split(&self) -> Rig {
        let all = self.estimation.v().len();
        let cut = all - all / 3;
        self.rig(vec![
            record("first two thirds", Usage::Fit, &self.estimation, 0..cut),
            record("last third", Usage::Holdout, &self.estimation, cut..all),
        ])
    }

    fn rig(&self, records: Vec<RigRecord>) -> Rig {
        Rig {
            name: self.name.to_owned(),
            sample_time: self.sample_time,
            order: None,
            interval: None,
            input_label: self.labels[0].to_owned(),
            output_label: self.labels[1].to_owned(),
            records,
        }
    }
}

fn record(name: &str, usage: Usage, whole: &Record, part: std::ops::Range<usize>) -> RigRecord {
    let part = Record::new(whole.v()[part.clone()].to_vec(), whole.y()[part].to_vec());
    RigRecord {
        name: name.to_owned(),
        role: Role::Free,
        usage,
        record: part.expect("finite and equally long"),
        predicted: None,
    }
}
