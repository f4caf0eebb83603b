//! Parts of an examination, judged apart, and the whole that they make.
//!
//! The folder of a part holds `part.json` (which part of which scenario, and what made and judged it), the scenario as it was, the keys of
//! its rigs, its answers, and `cases.jsonl`, a line a rig with all that a report is made of.

use super::Judged;
use super::journal::KEY_FILE;
use crate::input::{FileError, read_text, stream};
use crate::options::Shard;
use crate::output::{Artefacts, sha256, stamped};
use crate::study::Unusable;
use miette::Diagnostic;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// What tells that a folder holds a part.
pub const PART_FILE: &str = "part.json";
const CASES_FILE: &str = "cases.jsonl";
const SCHEMA: &str = "switchback/part/1";

/// Which part of what.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Label {
    /// The scenario's file name.
    scenario: String,
    shard: Shard,
    /// SHA-256 of the sources that made and judged.
    program: String,
    /// SHA-256 of the keys of its rigs.
    key_sha256: String,
}

#[derive(Deserialize)]
struct WrittenLabel {
    schema: String,
    #[serde(flatten)]
    label: Label,
}

/// A part of an examination that was judged.
#[derive(Debug, Clone)]
pub struct Part<C> {
    folder: PathBuf,
    label: Label,
    scenario: String,
    keys: String,
    cases: Vec<C>,
}

/// Parts put together.
#[derive(Debug, Clone)]
pub struct Whole<C> {
    /// The scenario's file, in the folder of one of the parts.
    pub scenario: PathBuf,
    /// The key file.
    pub keys: String,
    /// All cases, by their number in the design.
    pub cases: Vec<C>,
}

/// Why folders make no whole.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum MergeError {
    /// A file cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// The folder holds something else.
    #[error("{folder}: holds no part of a study or an examination")]
    #[diagnostic(help(
        "give folders that `switchback SCENARIO.toml --shard K/N --out DIR` has written to its end"
    ))]
    NoPart {
        /// The folder.
        folder: String,
    },
    /// A file of a part is not as it was written.
    #[error("{folder}: {file} is not what was judged there")]
    #[diagnostic(help("run this part again"))]
    Changed {
        /// The folder.
        folder: String,
        /// The file that was changed.
        file: &'static str,
    },
    /// Two parts belong to different wholes.
    #[error("{folder}: {what} differs from that of {first}")]
    #[diagnostic(help(
        "merge parts of one scenario, run by one version of the program with one number of parts"
    ))]
    Strange {
        /// The folder.
        folder: String,
        /// What differs.
        what: &'static str,
        /// The folder that it was compared with.
        first: String,
    },
    /// A part is given twice.
    #[error("{folder} and {first} are the same part, {shard}")]
    #[diagnostic(help("give every part once"))]
    Twice {
        /// One folder.
        folder: String,
        /// The other.
        first: String,
        /// Which part.
        shard: Shard,
    },
    /// What the replicates left behind cannot be read.
    #[error("{folder}: {file} {why}", file = crate::kept::KEPT_FILE)]
    #[diagnostic(help(
        "merge parts of one scenario and one round, with the version of the program and on the platform that ran them; or run this part again"
    ))]
    Unusable {
        /// The folder.
        folder: String,
        /// What is wrong.
        why: Unusable,
    },
    /// One part was given where all of a round are wanted.
    #[error(
        "{folder}: is part {shard} alone, and not what `switchback merge` writes of all parts of a round"
    )]
    #[diagnostic(help("merge the parts of the round first"))]
    OnePart {
        /// The folder.
        folder: String,
        /// Which part.
        shard: Shard,
    },
    /// Two folders hold the rounds before.
    #[error("{folder} and {first} both hold the rounds before")]
    #[diagnostic(help("give one of them, and the parts that were run from it"))]
    TwoWholes {
        /// One folder.
        folder: String,
        /// The other.
        first: String,
    },
    /// Replicates are missing, or there twice.
    #[error("replicates {start} to {end} are missing, or there twice")]
    #[diagnostic(help("merge all parts of one round, with what was merged of the rounds before"))]
    Gap {
        /// Where the next should begin.
        start: usize,
        /// Where it does.
        end: usize,
    },
    /// Parts are missing.
    #[error("of {scenario} these parts are missing: {missing}")]
    #[diagnostic(help(
        "run them: switchback {scenario} --shard {first} --out DIR; as a job array: --array={array}"
    ))]
    Missing {
        /// The scenario's file name.
        scenario: String,
        /// The parts.
        missing: String,
        /// The first of them.
        first: Shard,
        /// Their numbers, as a scheduler takes them.
        array: String,
    },
}

impl MergeError {
    /// What is missing of so many parts, if the parts of these numbers are there.
    pub fn missing(scenario: &str, there: &[usize], of: usize) -> Option<Self> {
        let is_there: BTreeSet<usize> = there.iter().copied().collect();
        let missing: Vec<usize> = (1..=of).filter(|number| !is_there.contains(number)).collect();
        let &first = missing.first()?;
        let runs = missing.chunk_by(|one, next| one + 1 == *next);
        let array = runs.map(|run| match run {
            [only] => only.to_string(),
            run => format!("{}-{}", run[0], run[run.len() - 1]),
        });
        let all = missing.iter().map(|&number| Shard { number, of }.to_string());
        Some(Self::Missing {
            scenario: scenario.to_owned(),
            missing: all.collect::<Vec<_>>().join(", "),
            first: Shard { number: first, of },
            array: array.collect::<Vec<_>>().join(","),
        })
    }
}

impl<C: Judged> Part<C> {
    /// A part that was just judged: the scenario's file and text, which part, the sources that judged, its keys and cases.
    pub fn new(
        file: &Path,
        text: String,
        (shard, program): (Shard, &str),
        keys: String,
        cases: Vec<C>,
    ) -> Self {
        let scenario = stream::copy_name(file);
        let label = Label { scenario, shard, program: program.to_owned(), key_sha256: sha256(&keys) };
        Self { folder: PathBuf::new(), label, scenario: text, keys, cases }
    }

    /// All files of its folder.
    pub fn artefacts(&self) -> Artefacts {
        let mut artefacts = Artefacts::default();
        artefacts.add(PART_FILE, stamped(SCHEMA, &self.label));
        artefacts.add(self.label.scenario.as_str(), self.scenario.as_str());
        artefacts.add(KEY_FILE, self.keys.as_str());
        artefacts.add("answers.csv", C::answers(&self.cases));
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
        let label = label(folder)?;
        let scenario = read_text(&folder.join(&label.scenario))?;
        let keys = read_text(&folder.join(KEY_FILE))?;
        if sha256(&keys) != label.key_sha256 {
            return Err(changed(KEY_FILE));
        }
        let cases: Vec<C> = read_cases(folder)?;
        let judged: Vec<Option<usize>> = cases.iter().map(|case| Some(case.id())).collect();
        let sealed: Vec<Option<usize>> = keys.lines().map(id_of).collect();
        if judged != sealed {
            return Err(changed(CASES_FILE));
        }
        Ok(Self { folder: folder.to_owned(), label, scenario, keys, cases })
    }

    /// SHA-256 of the sources that made and judged it.
    pub fn program(&self) -> &str {
        &self.label.program
    }

    /// What was judged, by its number in the design.
    pub fn cases(&self) -> &[C] {
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

    fn name(&self) -> String {
        self.folder.display().to_string()
    }

    /// What tells that another part belongs to another whole.
    fn differs_in(&self, other: &Self) -> Option<&'static str> {
        [
            (self.label.scenario != other.label.scenario || self.scenario != other.scenario, "the scenario"),
            (self.label.program != other.label.program, "the version of the program"),
            (self.label.shard.of != other.label.shard.of, "the number of parts"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what))
    }
}

/// Reads what was judged: the cases of a part, or of a report that has them.
///
/// # Errors
/// [`MergeError`] if there are none, or they are not as they were written.
pub fn read_cases<C: Judged>(folder: &Path) -> Result<Vec<C>, MergeError> {
    // Cases hold names, which live as long as the program: so does the text, which is read once.
    let text: &'static str = read_text(&folder.join(CASES_FILE))?.leak();
    let cases = text.lines().map(serde_json::from_str).collect::<Result<_, _>>();
    cases.map_err(|_| MergeError::Changed { folder: folder.display().to_string(), file: CASES_FILE })
}

/// Cases as lines of JSON, all that a report is made of.
pub fn case_lines<C: Judged>(cases: &[C]) -> String {
    cases.iter().fold(String::new(), |mut lines, case| {
        let line = serde_json::to_string(case).expect("names and numbers are JSON");
        let _ = writeln!(lines, "{line}");
        lines
    })
}

/// The number of the rig of a line of a key file.
fn id_of(line: &str) -> Option<usize> {
    let value: serde_json::Value = serde_json::from_str(line).ok()?;
    value["id"].as_u64().map(|id| id as usize)
}

/// The scenario's file of a part's folder: it tells which kind of study or examination the part is of.
///
/// # Errors
/// [`MergeError`] if the folder holds no part.
pub fn scenario_of(folder: &Path) -> Result<PathBuf, MergeError> {
    #[derive(Deserialize)]
    struct Named {
        scenario: String,
    }
    let Named { scenario } = written(folder)?;
    Ok(folder.join(scenario))
}

/// What a folder says that it is, as far as it is asked for.
fn written<T: DeserializeOwned>(folder: &Path) -> Result<T, MergeError> {
    let no_part = || MergeError::NoPart { folder: folder.display().to_string() };
    if !folder.join(PART_FILE).is_file() {
        return Err(no_part());
    }
    serde_json::from_str(&read_text(&folder.join(PART_FILE))?).map_err(|_| no_part())
}

/// What a folder says that it is.
fn label(folder: &Path) -> Result<Label, MergeError> {
    let no_part = || MergeError::NoPart { folder: folder.display().to_string() };
    let written: WrittenLabel = written(folder)?;
    if written.schema == SCHEMA { Ok(written.label) } else { Err(no_part()) }
}

/// The whole that parts make.
///
/// # Errors
/// [`MergeError`] if they are parts of different wholes, one of them is there twice, or some are missing.
pub fn merged<C: Judged>(mut parts: Vec<Part<C>>) -> Result<Whole<C>, MergeError> {
    parts.sort_by_key(|part| part.label.shard);
    let Some(first) = parts.first() else {
        return Err(MergeError::NoPart { folder: ".".to_owned() });
    };
    for part in &parts[1..] {
        if let Some(what) = first.differs_in(part) {
            return Err(MergeError::Strange { folder: part.name(), what, first: first.name() });
        }
    }
    let mut neighbours = parts.iter().zip(parts.iter().skip(1));
    if let Some((one, other)) = neighbours.find(|(x, y)| x.label.shard == y.label.shard) {
        return Err(MergeError::Twice { folder: other.name(), first: one.name(), shard: one.label.shard });
    }
    let of = first.label.shard.of;
    let there: Vec<usize> = parts.iter().map(|part| part.label.shard.number).collect();
    if let Some(error) = MergeError::missing(&first.label.scenario, &there, of) {
        return Err(error);
    }
    let scenario = first.folder.join(&first.label.scenario);
    let mut lines: Vec<&str> = parts.iter().flat_map(|part| part.keys.lines()).collect();
    lines.sort_by_key(|line| id_of(line));
    let keys = lines.iter().fold(String::new(), |text, line| text + line + "\n");
    let mut cases: Vec<C> = parts.iter().flat_map(|part| part.cases.clone()).collect();
    cases.sort_by_key(|case| case.id());
    Ok(Whole { scenario, keys, cases })
}
