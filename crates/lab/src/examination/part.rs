//! Parts of an examination, judged apart, and the whole that they make.
//!
//! The folder of a part holds `part.json` (which part of which scenario, and what made and judged it), the scenario as it was, the keys of
//! its rigs, its answers, and `cases.jsonl`, a line a rig with all that a report is made of.

use super::case::Case;
use super::sealed::{KEY_FILE, id_of};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use switchback_io::input::{TextKind, read_text, stream};
use switchback_io::output::{Artefacts, sha256};
use switchback_study::Shard;
use switchback_study::parts::{MergeError, PART_FILE, Piece, check_whole, label, label_hash, label_text};

const CASES_FILE: &str = "cases.jsonl";

/// The label of a part of an examination.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Label {
    /// The scenario's file name.
    scenario: String,
    /// Which part.
    shard: Shard,
    /// SHA-256 of the sources that made and judged.
    program: String,
    /// SHA-256 of the keys of its rigs.
    key_sha256: String,
    /// SHA-256 of the label, the scenario, the keys and the cases.
    #[serde(default)]
    sha256: String,
}

impl Label {
    /// The same with the hash of itself and of the texts of the scenario, the keys and the cases.
    fn sealed(&self, texts: [&str; 3]) -> Self {
        let bare = Self { sha256: String::new(), ..self.clone() };
        Self { sha256: label_hash(&bare, &texts), ..bare }
    }
}

/// A part of an examination that was judged.
#[derive(Debug, Clone)]
pub struct Part {
    folder: PathBuf,
    label: Label,
    scenario: String,
    keys: String,
    cases: Vec<Case>,
}

/// Parts put together.
#[derive(Debug, Clone)]
pub struct Whole {
    /// The scenario's file, in the folder of one of the parts.
    pub scenario: PathBuf,
    /// The key file.
    pub keys: String,
    /// All cases, by their number in the design.
    pub cases: Vec<Case>,
}

impl Part {
    /// A part that was just judged: the scenario's file and text, which part, the sources that judged, its keys and cases.
    pub fn new(
        file: &Path,
        text: String,
        (shard, program): (Shard, &str),
        keys: String,
        cases: Vec<Case>,
    ) -> Self {
        let scenario = stream::copy_name(file);
        let (program, key_sha256, sha256) = (program.to_owned(), sha256(&keys), String::new());
        let label = Label { scenario, shard, program, key_sha256, sha256 };
        let label = label.sealed([&text, &keys, &case_lines(&cases)]);
        Self { folder: PathBuf::new(), label, scenario: text, keys, cases }
    }

    /// All files of its folder; `answers` is its table of answers.
    pub fn artefacts(&self, answers: String) -> Artefacts {
        let mut artefacts = Artefacts::default();
        artefacts.add(PART_FILE, label_text(&self.label));
        artefacts.add(self.label.scenario.as_str(), self.scenario.as_str());
        artefacts.add(KEY_FILE, self.keys.as_str());
        artefacts.add("answers.csv", answers);
        artefacts.add(CASES_FILE, case_lines(&self.cases));
        artefacts
    }

    /// Reads the folder of a part.
    ///
    /// # Errors
    /// [`MergeError`] if it holds none, or a file is not as it was written.
    pub fn read(folder: &Path) -> Result<Self, MergeError> {
        let name = || folder.display().to_string();
        let changed = |file| MergeError::Changed { folder: name(), file };
        let label: Label = label(folder)?;
        let scenario = read_text(&folder.join(&label.scenario), TextKind::Settings)?;
        let keys = read_text(&folder.join(KEY_FILE), TextKind::Results)?;
        if sha256(&keys) != label.key_sha256 {
            return Err(changed(KEY_FILE));
        }
        let cases = read_cases(folder)?;
        if label != label.sealed([&scenario, &keys, &read_text(&folder.join(CASES_FILE), TextKind::Results)?])
        {
            return Err(MergeError::Unsealed { folder: name() });
        }
        let judged: Vec<Option<usize>> = cases.iter().map(|case| Some(case.id)).collect();
        let sealed: Vec<Option<usize>> = keys.lines().map(id_of).collect();
        if judged != sealed {
            return Err(changed(CASES_FILE));
        }
        Ok(Self { folder: folder.to_owned(), label, scenario, keys, cases })
    }

    /// Paths of the files of its folder.
    pub fn inputs(&self) -> impl Iterator<Item = PathBuf> {
        let names = [PART_FILE, &self.label.scenario, KEY_FILE, "answers.csv", CASES_FILE];
        names.map(|name| self.folder.join(name)).into_iter()
    }

    /// SHA-256 of the sources that made and judged it.
    pub fn program(&self) -> &str {
        &self.label.program
    }

    /// What was judged, by its number in the design.
    pub fn cases(&self) -> &[Case] {
        &self.cases
    }

    /// Which part it is.
    pub fn shard(&self) -> Shard {
        self.label.shard
    }

    /// The scenario and which part of it.
    pub fn title(&self) -> String {
        format!("{} {}", self.label.scenario, self.label.shard)
    }

    fn piece(&self) -> Piece<'_> {
        Piece {
            folder: &self.folder,
            scenario: (&self.label.scenario, &self.scenario),
            made_by: ("the version of the program", &self.label.program),
            shard: self.label.shard,
        }
    }
}

/// Reads the cases of a part.
///
/// # Errors
/// [`MergeError`] if there are none, or they are not as they were written.
fn read_cases(folder: &Path) -> Result<Vec<Case>, MergeError> {
    // Cases hold names, which live as long as the program: so does the text, which is read once.
    let text: &'static str = read_text(&folder.join(CASES_FILE), TextKind::Results)?.leak();
    let cases = text.lines().map(serde_json::from_str).collect::<Result<_, _>>();
    cases.map_err(|_| MergeError::Changed { folder: folder.display().to_string(), file: CASES_FILE })
}

/// Cases as lines of JSON, all that a report is made of.
pub(crate) fn case_lines(cases: &[Case]) -> String {
    cases.iter().fold(String::new(), |mut lines, case| {
        let line = serde_json::to_string(case).expect("names and numbers are JSON");
        let _ = writeln!(lines, "{line}");
        lines
    })
}

/// The whole that parts make.
///
/// # Errors
/// [`MergeError`] if they are parts of different wholes, one of them is there twice, or some are missing.
pub fn merged(mut parts: Vec<Part>) -> Result<Whole, MergeError> {
    parts.sort_by_key(|part| part.label.shard);
    let Some(first) = parts.first() else {
        return Err(MergeError::NoPart { folder: ".".to_owned() });
    };
    check_whole(&parts.iter().map(Part::piece).collect::<Vec<_>>())?;
    let scenario = first.folder.join(&first.label.scenario);
    let mut lines: Vec<&str> = parts.iter().flat_map(|part| part.keys.lines()).collect();
    lines.sort_by_key(|line| id_of(line));
    let keys = lines.iter().fold(String::new(), |text, line| text + line + "\n");
    let mut cases: Vec<Case> = parts.iter().flat_map(|part| part.cases.clone()).collect();
    cases.sort_by_key(|case| case.id);
    Ok(Whole { scenario, keys, cases })
}
