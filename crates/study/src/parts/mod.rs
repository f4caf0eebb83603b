//! Parts of a study or an examination, run apart: what their folders say of them, and whether they make a whole.
//!
//! The folder of a part holds `part.json`, its label: which part of which scenario, and what made it; the scenario as it was; and what
//! each kind of study leaves behind.

mod error;

pub use error::MergeError;

use crate::Shard;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use switchback_io::input::{TextKind, read_text};
use switchback_io::output::{sha256, stamped};

/// What shows that a folder holds a part.
pub const PART_FILE: &str = switchback_io::output::PART;

/// Name and version of the layout of [`PART_FILE`].
pub const PART_SCHEMA: &str = "switchback/part/1";

/// The text of [`PART_FILE`].
pub fn label_text(label: &impl Serialize) -> String {
    stamped(PART_SCHEMA, label)
}

/// The hash by which a label shows that neither it nor the files that belong to it were changed: of the label without a hash, and of the files.
pub fn label_hash(label: &impl Serialize, files: &[&str]) -> String {
    sha256(files.iter().fold(sha256(label_text(label)), |text, file| text + &sha256(file)))
}

/// What a folder says that it is.
///
/// # Errors
/// [`MergeError`] if it holds no part, or one of another kind.
pub fn label<L: DeserializeOwned>(folder: &Path) -> Result<L, MergeError> {
    #[derive(Deserialize)]
    struct Written<L> {
        schema: String,
        #[serde(flatten)]
        label: L,
    }
    let no_part = || MergeError::NoPart { folder: folder.display().to_string() };
    if !folder.join(PART_FILE).is_file() {
        return Err(no_part());
    }
    let text = read_text(&folder.join(PART_FILE), TextKind::Settings)?;
    let written: Written<L> = serde_json::from_str(&text).map_err(|_| no_part())?;
    if written.schema == PART_SCHEMA { Ok(written.label) } else { Err(no_part()) }
}

/// The scenario's file of a part's folder: it shows which kind of study or examination the part is of.
///
/// # Errors
/// [`MergeError`] if the folder holds no part.
pub fn scenario_of(folder: &Path) -> Result<PathBuf, MergeError> {
    #[derive(Deserialize)]
    struct Named {
        scenario: String,
    }
    let Named { scenario } = label(folder)?;
    Ok(folder.join(scenario))
}

/// A part, as far as it must go with the others.
#[derive(Debug, Clone, Copy)]
pub struct Piece<'a> {
    /// Its folder.
    pub folder: &'a Path,
    /// Name and text of the scenario's file.
    pub scenario: (&'a str, &'a str),
    /// What else made it, by its name in a message: `("the engine", "direct")`.
    pub made_by: (&'static str, &'a str),
    /// Which part it is.
    pub shard: Shard,
}

impl Piece<'_> {
    fn name(&self) -> String {
        self.folder.display().to_string()
    }

    /// What shows that another part belongs to another whole.
    fn differs_in(&self, other: &Self) -> Option<&'static str> {
        let differences = [
            (self.scenario != other.scenario, "the scenario"),
            (self.made_by != other.made_by, self.made_by.0),
            (self.shard.of != other.shard.of, "the number of parts"),
        ];
        differences.into_iter().find_map(|(differs, what)| differs.then_some(what))
    }
}

/// Whether parts, by their number, make a whole; none at all do.
///
/// # Errors
/// [`MergeError`] if they are parts of different wholes, one of them is there twice, or some are missing.
pub fn check_whole(pieces: &[Piece<'_>]) -> Result<(), MergeError> {
    let Some((first, others)) = pieces.split_first() else { return Ok(()) };
    for piece in others {
        if let Some(what) = first.differs_in(piece) {
            return Err(MergeError::Strange { folder: piece.name(), what, first: first.name() });
        }
    }
    let mut neighbours = pieces.iter().zip(others);
    if let Some((one, other)) = neighbours.find(|(one, other)| one.shard == other.shard) {
        return Err(MergeError::Twice { folder: other.name(), first: one.name(), shard: one.shard });
    }
    let is_there = |number: &usize| pieces.binary_search_by_key(number, |piece| piece.shard.number).is_ok();
    let missing: Vec<usize> = (1..=first.shard.of).filter(|number| !is_there(number)).collect();
    MergeError::missing(first.scenario.0, &missing, first.shard.of).map_or(Ok(()), Err)
}
