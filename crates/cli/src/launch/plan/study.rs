//! What a consistency study costs.

use super::clock::{most_memory, processor, timed};
use super::{Costs, Ingredient, Plan, Share};
use crate::build::BUILD;
use miette::IntoDiagnostic;
use std::fs::{self, File};
use std::io::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use switchback_io::output::sha256;
use switchback_report::pages::PageError;
use switchback_report::study as report;
use switchback_study::checkpoint::is_worth_keeping;
use switchback_study::consistency::{Keeper, Progress, ShareSize, Snapshot, Standing, Study, least_seconds};
use switchback_study::scenario::Scenario;

/// Seconds of processor time after which enough batches have been run, and the least number of them.
const ENOUGH: (f64, usize) = (3.0, 4);

/// Sums are kept once a second while a study runs, and never in more than a twentieth of its time.
const KEPT_EVERY: f64 = 1.0;

/// Lays a study out on one thread, runs a few batches, writes and reads what they leave, makes a report of them. Call it on one thread.
///
/// # Errors
/// A study that cannot be laid out, or a system without room for a temporary file.
pub fn measure<'s>(scenario: &'s Scenario) -> miette::Result<Plan<'s>> {
    let study = Study::plan(scenario).into_diagnostic()?;
    let start = processor();
    let mut standing = study.begin();
    let per_batch = run_batches(&study, &mut standing);
    let alone = run_batches(&study, &mut study.with_one_cell_each());

    let origin = study.origin(BUILD.study_sources);
    let (bytes, making) = timed(|| standing.snapshot().to_bytes(&origin));
    let place = Place::new();
    let (written, writing) = timed(|| place.write(&bytes));
    written.into_diagnostic()?;
    let memory = most_memory().unwrap_or(2.0 * bytes.len() as f64);
    let per_byte_out = (making + writing) / bytes.len() as f64;
    let (read, reading) = timed(|| fs::read(&place.0).map(|bytes| study.begin().read(&bytes, &origin)));
    let mut read = read.into_diagnostic()?.expect("it was just written");
    let ((), adding) = timed(|| read.add_to_each(&standing));
    let per_byte_added = adding / bytes.len() as f64;
    let of_a_node = bytes.len() as f64 / standing.nodes() as f64;
    let whole = of_a_node * study.shares(1).iter().map(|share| share.nodes).sum::<usize>() as f64;
    let (hashes, report) = timed(|| {
        let results = study.results(&standing, String::new());
        let files = report::artefacts(&results)?;
        Ok::<_, PageError>(files.iter().map(|(_, contents)| sha256(contents)).collect::<Vec<_>>())
    });
    hashes?;
    // The whole has more sets of sums to add up than the few batches have, and they are kept beside the report where they were dear.
    let totals = per_byte_added * (whole - bytes.len() as f64).max(0.0);
    let is_kept = is_worth_keeping(least_seconds(scenario));
    let beside = if is_kept { per_byte_out * whole } else { 0.0 };

    let keeping = (making + writing) / KEPT_EVERY.max(20.0 * (making + writing));
    let kept = per_batch * keeping;
    let cells = study.cells() as f64;
    let replicates = study.batch() as f64;
    let samples = replicates * study.samples_of_a_replicate();
    // One cell of each workload is in both.
    let of_cells =
        ((per_batch - alone) * cells / (cells - study.workloads() as f64).max(1.0)).clamp(0.0, per_batch);
    let noise = per_batch - of_cells;
    let ingredient = |name, count: f64, seconds: f64| Ingredient { name, count, seconds: seconds / count };
    let costs = Costs {
        piece: "batch",
        pieces: study.shares(1).iter().map(|share| share.batches).sum(),
        start,
        per_piece: per_batch + kept,
        per_piece_error: 0.0,
        of_a_piece: vec![
            ingredient("noise sample", samples, noise),
            ingredient("estimate of a cell", replicates * cells, of_cells),
            ingredient("keeping what is finished", 1.0, kept),
        ],
        per_byte_out,
        per_byte_in: reading / bytes.len() as f64,
        per_byte_added,
        report: report + totals + beside,
        memory,
    };
    let shares = move |tasks: usize| {
        let share =
            |share: &ShareSize| Share { pieces: share.batches, bytes: share.nodes as f64 * of_a_node };
        study.shares(tasks).iter().map(share).collect()
    };
    Ok(Plan { costs, shares: Box::new(shares), whole })
}

/// Seconds of a batch; the first is not counted, which finds no memory that another has left.
fn run_batches(study: &Study<'_>, standing: &mut Standing) -> f64 {
    let mut watch = Watch { times: vec![processor()] };
    let _stopped = study.run_part(standing, None, (&Silent, &mut watch));
    let spans: Vec<f64> = watch.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let counted = if spans.len() > 1 { &spans[1..] } else { &spans[..] };
    counted.iter().sum::<f64>() / counted.len().max(1) as f64
}

/// A file that lasts no longer than this.
struct Place(PathBuf);

impl Place {
    fn new() -> Self {
        Self(std::env::temp_dir().join(format!("switchback-plan-{}", std::process::id())))
    }

    /// Writes as the folder of a part gets it.
    fn write(&self, bytes: &[u8]) -> std::io::Result<()> {
        let _hash = sha256(bytes);
        let mut file = File::create_new(&self.0)?;
        file.write_all(bytes).and_then(|()| file.sync_all())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// When batches were done.
struct Watch {
    times: Vec<f64>,
}

impl Keeper for Watch {
    fn keep(&mut self, _: &Snapshot<'_>) -> ControlFlow<()> {
        self.times.push(processor());
        let (seconds, batches) = ENOUGH;
        let is_enough =
            self.times.len() > batches && self.times[self.times.len() - 1] - self.times[0] > seconds;
        if is_enough { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn is_stopped(&self) -> bool {
        false
    }
}

/// Nobody is told.
struct Silent;

impl Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}
