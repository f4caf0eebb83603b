//! What is judged already, on disk while an examination runs: one that was interrupted is taken up where it stood.
//!
//! A line a rig: `{"program": …, "rig": …, "case": {…}}`, the first two the SHA-256 of the sources that judged and of the
//! rig's line in the key file. Only the same sources' judgement of the same rig counts. A line before keys are sealed:
//! `{"program": …, "keys": …}`, the latter the SHA-256 of the key file: what the same sources found need not be searched for again.
//! Until there is a report the keys lie beside the journal under a name of their own: a new key never lies under an old report.

use miette::Diagnostic;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use switchback_io::input::own;
use switchback_io::output::{Growing, make_folder, overwrite, remove, sha256};
use thiserror::Error;

/// Judged rigs, in memory and on disk.
#[derive(Debug)]
pub struct Journal<C> {
    path: PathBuf,
    file: Growing,
    program: String,
    known: HashMap<String, C>,
    /// SHA-256 of the key file sealed last.
    keys: Option<String>,
}

/// The journal could not be read or written.
#[derive(Debug, Error, Diagnostic)]
#[error("{path}: cannot keep what is judged there: {source}")]
#[diagnostic(help("give a folder that you may write to, on a disk with space left; what is there is kept"))]
pub struct JournalError {
    path: String,
    source: io::Error,
}

#[derive(Serialize, Deserialize)]
struct Line<'a, C> {
    program: &'a str,
    rig: String,
    case: C,
}

#[derive(Serialize, Deserialize)]
struct KeysLine<'a> {
    program: &'a str,
    keys: String,
}

/// What a journal begins with, even one that was interrupted within its first line.
const BEGINNING: &[u8] = b"{\"program\":";

/// What a journal holds once keys were sealed beside it.
const KEYS: &[u8] = b",\"keys\":";

/// The same while the examination runs.
pub const SEALED_FILE: &str = "unfinished-key.jsonl";

impl<C: Clone + Serialize + Deserialize<'static>> Journal<C> {
    /// Opens the journal of a report folder, an empty one if there is none, and the folder too; `program` identifies the sources that judge.
    ///
    /// # Errors
    /// [`JournalError`] if the system refuses.
    pub fn open(folder: &Path, program: &str) -> Result<Self, JournalError> {
        let path = folder.join("unfinished.jsonl");
        let fails = |source| JournalError { path: path.display().to_string(), source };
        make_folder(folder).map_err(fails)?;
        let text = match own(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            other => other.map_err(fails)?,
        };
        if !text.trim_ascii_start().is_empty() && !text.trim_ascii_start().starts_with(BEGINNING) {
            return Err(fails(io::Error::other("something else wrote it")));
        }
        let sealed = path.with_file_name(SEALED_FILE);
        if sealed.exists() && !text.windows(KEYS.len()).any(|part| part == KEYS) {
            let source = io::Error::other("something else wrote it");
            return Err(JournalError { path: sealed.display().to_string(), source });
        }
        let mut file = Growing::open(&path).map_err(fails)?;
        if text.last().is_some_and(|last| *last != b'\n') {
            // Interrupted within a line.
            file.append(b"\n").map_err(fails)?;
        }
        // Cases hold names, which live as long as the program: so does the text, which is read once.
        let text: &'static str = String::from_utf8_lossy(&text).into_owned().leak();
        let known = text
            .lines()
            .filter_map(|line| serde_json::from_str::<Line<'_, C>>(line).ok())
            .filter(|line| line.program == program)
            .map(|line| (line.rig, line.case))
            .collect();
        let keys = text
            .lines()
            .filter_map(|line| serde_json::from_str::<KeysLine<'_>>(line).ok())
            .filter(|line| line.program == program)
            .map(|line| line.keys)
            .next_back();
        Ok(Self { path, file, program: program.to_owned(), known, keys })
    }

    /// The text of the key file beside the journal, if the same sources sealed it; else none.
    pub fn keys(&self) -> String {
        let text = own(&self.sealed()).unwrap_or_default();
        let text = String::from_utf8(text).unwrap_or_default();
        if self.keys.as_ref() == Some(&sha256(&text)) { text } else { String::new() }
    }

    /// Seals keys in a file beside the journal. Whose that file is the journal shows, so that it comes first.
    ///
    /// # Errors
    /// [`JournalError`] if the system refuses.
    pub fn keep_keys(&mut self, keys: &str) -> Result<(), JournalError> {
        let line = KeysLine { program: &self.program, keys: sha256(keys) };
        let line = serde_json::to_string(&line).expect("strings are JSON") + "\n";
        self.file
            .append(line.as_bytes())
            .and_then(|()| self.file.sync())
            .and_then(|()| overwrite(&self.sealed(), keys.as_bytes()))
            .map_err(|source| self.error(source))
    }

    /// Where the keys lie until there is a report.
    fn sealed(&self) -> PathBuf {
        self.path.with_file_name(SEALED_FILE)
    }

    /// What was judged before of the rig with this line in the key file.
    pub fn recall(&self, key_line: &str) -> Option<&C> {
        self.known.get(&sha256(key_line))
    }

    /// Keeps a judged rig with its line in the key file.
    ///
    /// # Errors
    /// [`JournalError`] if the system refuses.
    pub fn keep(&mut self, key_line: &str, case: &C) -> Result<(), JournalError> {
        let line = Line { program: &self.program, rig: sha256(key_line), case: case.clone() };
        let line = serde_json::to_string(&line).expect("names and numbers are JSON") + "\n";
        self.file.append(line.as_bytes()).map_err(|source| self.error(source))
    }

    /// Removes it and the keys beside it: the report shows all.
    ///
    /// # Errors
    /// [`JournalError`] if the system refuses.
    pub fn close(self) -> Result<(), JournalError> {
        if self.sealed().exists() {
            remove(&self.sealed()).map_err(|source| self.error(source))?;
        }
        remove(&self.path).map_err(|source| self.error(source))
    }

    fn error(&self, source: io::Error) -> JournalError {
        JournalError { path: self.path.display().to_string(), source }
    }
}
