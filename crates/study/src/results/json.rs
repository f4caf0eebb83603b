//! `results.json`: writing it byte for byte the same, and refusing what is not one.

use super::{Results, SCHEMA, condensed};
use miette::Diagnostic;
use schemars::Schema;
use serde::Serialize;
use serde_json::ser::Formatter;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use switchback_io::input::gzip::{self, GzipError};
use switchback_io::input::json_file::{self, JsonError};
use switchback_io::input::{FileError, TextKind, read_text};
use switchback_io::output::{NotWhole, verify};
use thiserror::Error;

/// Why a file holds no results.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ResultsError {
    /// The file cannot be read.
    #[error("{reported}")]
    #[diagnostic(help("give a results.json, or the folder of a report that holds one"))]
    Unreadable {
        /// The path, and what is wrong with it.
        reported: FileError,
    },
    /// The compressed file gives no text.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Gzip(#[from] GzipError),
    /// The folder is not as one run wrote it.
    #[error(transparent)]
    #[diagnostic(transparent)]
    NotWhole(#[from] NotWhole),
    /// The content is not a result table.
    #[error("{place}: is not a results file of Switchback: {message}")]
    #[diagnostic(help("give a results.json as a consistency study writes it"))]
    NotResults {
        /// The path read, with line and column.
        place: String,
        /// What does not fit.
        message: String,
    },
    /// Another command wrote it.
    #[error("{}: this is {kind}, not the results of a study", path.display())]
    #[diagnostic(help("give a results.json as a consistency study writes it"))]
    OtherKind {
        /// The path read.
        path: PathBuf,
        /// What it is.
        kind: &'static str,
    },
    /// The layout is of another version.
    #[error("{}: has results layout {found}, this version reads {SCHEMA}", path.display())]
    #[diagnostic(help("run its scenario again to renew it"))]
    OtherSchema {
        /// The path read.
        path: PathBuf,
        /// The layout found.
        found: u64,
    },
}

/// The JSON Schema of `results.json`, whose `schema` is a number.
pub fn schema() -> Schema {
    switchback_io::output::schema::<Results>(&format!("switchback/results/{SCHEMA}"))
}

/// The file of the results in a report folder.
const NAME: &str = "results.json";

/// The same in a folder of the repository, [condensed] and compressed.
pub const COMPRESSED: &str = "results.json.gz";

/// Reads `results.json` from a file or from the report folder that holds it; a folder without it may hold [`COMPRESSED`] instead.
///
/// # Errors
/// [`ResultsError`] if it is missing, no result table, of another layout, or in a folder that is not as one run wrote it.
pub fn read(path: &Path) -> Result<Results, ResultsError> {
    let is_folder = path.is_dir();
    if is_folder {
        verify(path, |_| true)?;
    }
    let path = if is_folder { in_folder(path) } else { path.to_owned() };
    let text = if gzip::is_gzip(&path) {
        gzip::read(&path)?
    } else {
        read_text(&path, TextKind::Results).map_err(|reported| ResultsError::Unreadable { reported })?
    };
    parse(&path, &text)
}

fn in_folder(folder: &Path) -> PathBuf {
    let compressed = folder.join(COMPRESSED);
    let plain = folder.join(NAME);
    if plain.exists() || !compressed.exists() { plain } else { compressed }
}

/// The results that a text holds; `path` is what messages call it.
///
/// # Errors
/// [`ResultsError`] if it is no result table, or of another layout.
pub fn parse(path: &Path, text: &str) -> Result<Results, ResultsError> {
    let refuse = |JsonError { place, message, .. }| ResultsError::NotResults { place, message };
    if let Some(kind) = json_file::kind(text).filter(|kind| *kind != "the results of a study") {
        return Err(ResultsError::OtherKind { path: path.to_owned(), kind });
    }
    let value: serde_json::Value = json_file::parse(path, text).map_err(refuse)?;
    match value.get("schema").and_then(serde_json::Value::as_u64) {
        Some(found) if found != u64::from(SCHEMA) => {
            Err(ResultsError::OtherSchema { path: path.to_owned(), found })
        }
        _ if value.get("parameters").is_some() => parse_condensed(path, value),
        _ => json_file::parse(path, text).map_err(refuse),
    }
}

fn parse_condensed(path: &Path, value: serde_json::Value) -> Result<Results, ResultsError> {
    let refuse = |message| ResultsError::NotResults { place: path.display().to_string(), message };
    let restored = condensed::restored(value)
        .ok_or_else(|| refuse("its columns and its cells have different numbers of parameters".to_owned()))?;
    serde_json::from_value(restored).map_err(|error| refuse(error.to_string()))
}

/// The bytes of `results.json`: one parameter a line, so that changes of a committed report can be read.
pub fn to_json(results: &Results) -> String {
    let mut bytes = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut bytes, Shallow::default());
    results.serialize(&mut serializer).expect("a result table has string keys and writes to memory");
    bytes.push(b'\n');
    String::from_utf8(bytes).expect("JSON is UTF-8")
}

/// How deep lines are broken: results → cells → cell → parameters; below, a parameter is one line.
const DEPTH: usize = 4;

/// Pretty down to [`DEPTH`], compact below.
#[derive(Default)]
struct Shallow {
    depth: usize,
    filled: bool,
}

impl Shallow {
    fn open<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        self.filled = false;
        writer.write_all(bracket)
    }

    fn item<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if !first {
            writer.write_all(b",")?;
        }
        self.filled = true;
        self.break_line(writer)
    }

    fn close<W: ?Sized + Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        let broken = self.filled && self.depth <= DEPTH;
        self.depth -= 1;
        self.filled = true;
        if broken {
            self.break_line(writer)?;
        }
        writer.write_all(bracket)
    }

    fn break_line<W: ?Sized + Write>(&self, writer: &mut W) -> io::Result<()> {
        if self.depth > DEPTH {
            return Ok(());
        }
        writer.write_all(b"\n")?;
        (0..self.depth).try_for_each(|_| writer.write_all(b" "))
    }
}

impl Formatter for Shallow {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.item(writer, first)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.item(writer, first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::synthetic;

    #[test]
    fn a_table_reads_back_as_written_and_its_bytes_repeat() {
        let results = synthetic::results();
        let text = to_json(&results);
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("results.json"), &text).expect("it can be written");
        let back = read(folder.path()).expect("it reads back");
        assert_eq!(back, results);
        assert_eq!(to_json(&back), text);
    }

    #[test]
    fn a_folder_with_a_compressed_table_alone_is_read_from_it() {
        let mut results = synthetic::results();
        let folder = tempfile::tempdir().expect("a temporary folder");
        let place = folder.path().join(COMPRESSED);
        let compressed = gzip::compressed(&condensed::to_json(&results));
        std::fs::write(&place, &compressed).expect("it can be written");
        assert!(read(folder.path()).expect("results").digits.is_some());
        assert!(read(&place).expect("results").digits.is_some());
        std::fs::write(&place, &compressed[..compressed.len() / 2]).expect("it can be written");
        let reported = read(folder.path()).expect_err("cut off").to_string();
        assert!(reported.contains(COMPRESSED) && reported.contains("cut off"), "{reported}");
        results.seed = 99;
        std::fs::write(folder.path().join(NAME), to_json(&results)).expect("it can be written");
        assert_eq!(
            read(folder.path()).expect("results").seed,
            99,
            "where both are there the plain one counts"
        );
    }

    #[test]
    fn a_parameter_takes_one_line() {
        let results = synthetic::results();
        let lines = to_json(&results).lines().filter(|l| l.contains("\"theory_sd\"")).count();
        assert_eq!(lines, results.cells.iter().map(|c| c.parameters.len()).sum::<usize>());
    }

    #[test]
    fn a_missing_file_another_layout_and_foreign_json_are_distinguished() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("results.json");
        assert!(matches!(read(folder.path()), Err(ResultsError::Unreadable { .. })));
        let with = |content: &str| {
            std::fs::write(&path, content).expect("it can be written");
            read(&path)
        };
        assert!(matches!(with("{\"schema\": 99}"), Err(ResultsError::OtherSchema { found: 99, .. })));
        assert!(matches!(with("{\"hello\": 1}"), Err(ResultsError::NotResults { .. })));
        assert!(matches!(with("no JSON"), Err(ResultsError::NotResults { .. })));
    }
}
