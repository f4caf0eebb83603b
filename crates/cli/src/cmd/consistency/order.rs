//! What is to be run of a study.

use crate::options::{Force, Quiet, Threads};
use std::path::Path;
use switchback_study::Shard;

/// What is to be run, and how it is reported.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Order<'a> {
    /// The scenario's file.
    pub(crate) file: &'a Path,
    /// The command that makes the results again.
    pub(crate) command: &'a str,
    /// The folder asked for.
    pub(crate) out: Option<&'a Path>,
    /// The part asked for.
    pub(crate) shard: Option<Shard>,
    /// The folder of the rounds before.
    pub(crate) from: Option<&'a Path>,
    /// Worker threads.
    pub(crate) threads: Threads,
    /// Whether results.json is printed.
    pub(crate) json: bool,
    /// Whether words are not.
    pub(crate) quiet: Quiet,
    /// Whether files of others may be replaced.
    pub(crate) force: Force,
}
