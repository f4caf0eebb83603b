//! The cascaded tanks: pump voltage in, level of the lower tank out.

use crate::estimation::Benchmark;
use std::path::Path;
use switchback_model::Record;
use switchback_model::rig::Usage;

/// Samples at the beginning of the test by which a model may find its state.
const INITIAL: usize = 50;

/// Errors of the official test record: M. Schoukens, P. Mattson, T. Wigren, J.-P. Noël, "Cascaded tanks benchmark combining soft and hard nonlinearities",
/// Workshop on Nonlinear System Identification Benchmarks (2016).
pub(crate) fn report(folder: &Path) -> miette::Result<String> {
    let rig = switchback_io::rig::read(&folder.join("rig.toml"))?;
    let of = |usage: Usage| -> Record {
        let found = rig.records.iter().find(|record| record.usage == usage);
        found.expect("a record for estimation and one for tests").record.clone()
    };
    let benchmark = Benchmark {
        name: "cascaded tanks",
        sample_time: rig.sample_time,
        labels: ["pump voltage [V]", "level [V]"],
        estimation: of(Usage::Fit),
        test: of(Usage::Holdout),
        skipped: INITIAL,
    };
    let (rows, report) = benchmark.rows()?;
    Ok(format!(
        "Cascaded tanks: official record for estimation, official test from sample {} on\n\n\
         {:<62} {:>10}\n{rows}{:<62} {:>10}\n\ndiagnosis of the record for estimation:\n\n{}",
        INITIAL + 1,
        "model",
        "RMSE [V]",
        "published: simple nonlinear methods",
        "0.40–0.41",
        switchback_report::diagnosis::words(&report, None),
    ))
}
