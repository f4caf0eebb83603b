//! What is to be run of a study.

use crate::options::{Force, Quiet, Threads};
use std::path::Path;
use switchback_study::Shard;

/// What is to be run, and how it is reported.
#[derive(Debug, Clone, Copy)]
pub struct Order<'a> {
    /// The scenario's file.
    pub file: &'a Path,
    /// The command that makes the results again.
    pub command: &'a str,
    /// The folder asked for.
    pub out: Option<&'a Path>,
    /// The part asked for.
    pub shard: Option<Shard>,
    /// The folder of the rounds before.
    pub from: Option<&'a Path>,
    /// Worker threads.
    pub threads: Threads,
    /// Whether results.json is printed.
    pub json: bool,
    /// Whether words are not.
    pub quiet: Quiet,
    /// Whether files of others may be replaced.
    pub force: Force,
}
