//! The verbs, one a file: options as the words of the command line, records and models in memory, one answer each.

pub(crate) mod design;
pub(crate) mod diagnose;
pub(crate) mod export;
pub(crate) mod identify;
pub(crate) mod plant;
pub(crate) mod power;
pub(crate) mod simulate;
pub(crate) mod study;

use crate::refusal::Refusal;
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;
use switchback::cli;
use switchback::options::Threads;

/// A model in memory: what messages call it, and its text.
pub(crate) type Model = (PathBuf, String);

/// Options of a verb with the number of threads.
#[derive(Debug, Args)]
pub(crate) struct Options<A: Args> {
    #[command(flatten)]
    pub(crate) asked: A,

    #[command(flatten)]
    pub(crate) threads: Threads,
}

/// Options from words, refused as the command line refuses them.
pub(crate) fn options<A: Args>(words: Vec<OsString>) -> Result<A, Refusal> {
    cli::options(words).map_err(|error| Refusal::of_words(&error))
}
