//! A part of a study on disk: which part of which scenario, the scenario as it was, and what its replicates left behind.

use super::order::Order;
use crate::build::BUILD;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use switchback_io::input::{FileError, TextKind, own, read_text, stream};
use switchback_io::output::{Artefacts, stamped_schema};
use switchback_io::provenance::PROVENANCE_FILE;
use switchback_lab::examination;
use switchback_study::Shard;
use switchback_study::checkpoint::CHECKPOINT_FILE;
use switchback_study::consistency::{RunState, Study};
use switchback_study::parts::{MergeError, PART_FILE, PART_SCHEMA, Piece, label, label_hash, label_text};
use switchback_study::scenario::{Engine, Scenario, ScenarioError};

/// The label of a part of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub(super) struct Label {
    /// The scenario's file name.
    pub(super) scenario: String,
    /// The command that makes the results again.
    pub(super) command: String,
    /// The engine that runs it.
    pub(super) engine: Engine,
    /// Which part; null for the rounds before, put together.
    pub(super) shard: Option<Shard>,
    /// SHA-256 of the label and the scenario.
    #[serde(default)]
    pub(super) sha256: String,
}

impl Label {
    /// The same with the hash of itself and the scenario's text.
    fn sealed(&self, text: &str) -> Self {
        let bare = Self { sha256: String::new(), ..self.clone() };
        Self { sha256: label_hash(&bare, &[text]), ..bare }
    }
}

/// What `part.json` holds: the label of a part of a study, or of an examination.
enum AnyLabel {}

impl JsonSchema for AnyLabel {
    fn schema_name() -> Cow<'static, str> {
        "Label".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let forms = [Label::json_schema(generator), examination::Label::json_schema(generator)];
        json_schema!({ "description": "A part of a study or examination: `part.json`.", "anyOf": forms })
    }
}

/// The JSON Schema of `part.json`.
pub(super) fn schema() -> Schema {
    stamped_schema::<AnyLabel>(PART_SCHEMA)
}

/// A part of a study.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) folder: PathBuf,
    pub(super) label: Label,
    /// The scenario's text.
    pub(super) text: String,
}

impl Part {
    /// A part that is to be run.
    pub(super) fn new(order: Order<'_>, engine: Engine, shard: Option<Shard>) -> Result<Self, FileError> {
        let (scenario, command) = (stream::copy_name(order.file), order.command.to_owned());
        let (text, sha256) = (read_text(order.file, TextKind::Settings)?, String::new());
        let label = Label { scenario, command, engine, shard, sha256 }.sealed(&text);
        Ok(Self { folder: PathBuf::new(), label, text })
    }

    /// The same label and scenario, without a shard: for what all parts of a round make.
    pub(super) fn of_all(&self) -> Self {
        let label = Label { shard: None, ..self.label.clone() };
        Self { label: label.sealed(&self.text), ..self.clone() }
    }

    /// The scenario as it is run.
    pub(super) fn scenario(&self) -> Result<Scenario, ScenarioError> {
        let file = self.folder.join(&self.label.scenario);
        Ok(Scenario::parse(&file.display().to_string(), &self.text)?.on(self.label.engine))
    }

    /// Its label as it is written.
    pub(super) fn label(&self) -> String {
        label_text(&self.label)
    }

    /// Paths of the files of its folder, which a merge reads.
    pub(super) fn inputs(&self) -> impl Iterator<Item = PathBuf> {
        self.files().map(|name| self.folder.join(name)).into_iter()
    }

    /// Names of the files of its folder.
    pub(super) fn files(&self) -> [&str; 4] {
        [PART_FILE, &self.label.scenario, CHECKPOINT_FILE, PROVENANCE_FILE]
    }

    /// What its folder gets, with what its replicates left behind.
    pub(super) fn artefacts(&self, sums: Vec<u8>) -> Artefacts {
        let mut artefacts = Artefacts::default();
        artefacts.add(PART_FILE, self.label());
        artefacts.add(self.label.scenario.as_str(), self.text.as_str());
        artefacts.add(CHECKPOINT_FILE, sums);
        artefacts
    }

    /// Reads the folder of a part, but for what its replicates left behind: of all parts that may be more than the memory holds.
    pub(super) fn read(folder: &Path) -> Result<Self, MergeError> {
        let label: Label = label(folder)?;
        let text = read_text(&folder.join(&label.scenario), TextKind::Settings)?;
        if label != label.sealed(&text) {
            return Err(MergeError::Unsealed { folder: folder.display().to_string() });
        }
        Ok(Self { folder: folder.to_owned(), label, text })
    }

    /// It as a piece of the round; nothing where it is all of one.
    pub(super) fn piece(&self) -> Option<Piece<'_>> {
        Some(Piece {
            folder: &self.folder,
            scenario: (&self.label.scenario, &self.text),
            made_by: ("the engine", self.label.engine.name()),
            shard: self.label.shard?,
        })
    }

    /// Its replicates, as a part of the round that `round` stands at.
    pub(super) fn run_state_in(&self, round: &RunState, study: &Study<'_>) -> Result<RunState, MergeError> {
        let origin = study.origin(BUILD.study_sources).of_part(self.label.shard, round);
        let folder = || self.folder.display().to_string();
        let sums = own(&self.folder.join(CHECKPOINT_FILE));
        let sums = sums.map_err(|_| MergeError::NoPart { folder: folder() })?;
        let strange = |why| MergeError::Unusable { folder: folder(), why };
        round.emptied().read(&sums, &origin).map_err(strange)
    }

    /// How far the study had come that a folder without a shard holds.
    pub(super) fn run_state(&self, study: &Study<'_>) -> Result<RunState, MergeError> {
        if let Some(shard) = self.label.shard {
            return Err(MergeError::OnePart { folder: self.folder.display().to_string(), shard });
        }
        self.run_state_in(&study.begin(), study)
    }
}
