//! The verbs, one a file: options, records and models in memory become the request of the library that does the work; one answer each.

pub(crate) mod design;
pub(crate) mod diagnose;
pub(crate) mod export;
pub(crate) mod identify;
pub(crate) mod plant;
pub(crate) mod power;
pub(crate) mod simulate;
pub(crate) mod study;

use std::path::PathBuf;

/// A model in memory: what messages call it, and its text.
pub(crate) type Model = (PathBuf, String);
