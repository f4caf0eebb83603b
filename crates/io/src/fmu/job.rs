//! What the process of an FMU is reported, and shows.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What is to be run: a file that the process reads.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Job {
    pub(super) library: PathBuf,
    /// Folder of the resources.
    pub(super) resources: PathBuf,
    pub(super) guid: String,
    pub(super) input: u32,
    pub(super) output: u32,
    /// Samples by which the output is late.
    pub(super) delay: usize,
    pub(super) sample_time: f64,
    /// The input of each record.
    pub(super) inputs: Vec<Vec<f64>>,
}

/// A line of what it shows, in a file that grows.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Line {
    /// It stands at a sample of a record.
    At(usize, usize),
    /// The outputs of a record.
    Ran(usize, Vec<f64>),
    /// It cannot go on.
    Failed(String),
}
