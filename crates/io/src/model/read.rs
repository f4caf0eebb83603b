//! From a model file to a model that runs.

use super::file::{Header, ModelFile, SCHEMA};
use super::system::System;
use crate::input::json_file::{self, JsonError};
use crate::input::{FileError, TextKind, read_text};
use miette::Diagnostic;
use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use std::path::Path;
use thiserror::Error;

/// Why a file is no model.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ModelError {
    /// The file cannot be read as text.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// Its content is refused.
    #[error("{place}: {message}")]
    #[diagnostic(help("{remedy}"))]
    Content {
        /// The file, with line and column where these are known.
        place: String,
        /// What is wrong.
        message: String,
        /// What to do about it.
        remedy: String,
    },
}

/// How to get a file that is one.
const MAKE_ONE: &str =
    "make one with `switchback identify RIG.toml --out DIR` or `switchback gap RIG.toml --out DIR`";
#[derive(Deserialize)]
struct Peek {
    schema: Option<String>,
    kind: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WireFile<M> {
    #[serde(rename = "schema")]
    _schema: IgnoredAny,
    #[serde(rename = "kind")]
    _kind: IgnoredAny,
    part: String,
    rig: String,
    method: Option<String>,
    input: String,
    output: String,
    sample_time: f64,
    identified_on: super::Domain,
    effects: Vec<super::file::Added>,
    #[serde(default, rename = "system")]
    _system: IgnoredAny,
    #[serde(default, rename = "version")]
    _version: IgnoredAny,
    model: M,
}

/// Reads a model file.
///
/// # Errors
/// [`ModelError`] if the file is no JSON, of another format or version, or its parts contradict each other.
pub fn read(path: &Path) -> Result<ModelFile, ModelError> {
    of_text(path, &read_text(path, TextKind::Model)?)
}

/// The model that a text holds; `path` is what messages call it.
///
/// # Errors
/// As [`read`].
pub fn of_text(path: &Path, text: &str) -> Result<ModelFile, ModelError> {
    let fail = |message: String, remedy: &str| ModelError::Content {
        place: path.display().to_string(),
        message,
        remedy: remedy.to_owned(),
    };
    let peek: Peek = parse(path, text)?;
    match peek.schema.as_deref() {
        Some(SCHEMA) => {}
        Some(other) if other.starts_with("switchback/model/") => {
            let message = format!("the model has the format `{other}`, but this program reads `{SCHEMA}`");
            return Err(fail(
                message,
                "write the model again with this version, or read it with the one that wrote it",
            ));
        }
        Some(other) => {
            let kind = json_file::kind(text).map_or_else(|| format!("a `{other}`"), str::to_owned);
            return Err(fail(format!("this is {kind}, but a model is wanted"), MAKE_ONE));
        }
        None => return Err(fail("this is no model file: there is no field `schema`".to_owned(), MAKE_ONE)),
    }
    let file = match peek.kind.as_deref() {
        Some("switched") => joined(parse(path, text)?, |model| System::Switched(Box::new(model))),
        Some("curves") => joined(parse(path, text)?, System::Curves),
        Some("machine") => joined(parse(path, text)?, |model| System::Machine(Box::new(model))),
        Some("points") => joined(parse(path, text)?, System::Points),
        Some(other) => {
            return Err(fail(
                format!("`kind` is `{other}`, but a model is switched, curves, machine or points"),
                MAKE_ONE,
            ));
        }
        None => return Err(fail("there is no field `kind`".to_owned(), MAKE_ONE)),
    };
    let sample_time = file.header.sample_time;
    if !(sample_time > 0.0 && sample_time.is_finite()) {
        return Err(fail(format!("`sample_time` is {sample_time}, but must be positive"), MAKE_ONE));
    }
    Ok(file)
}

fn joined<M>(wire: WireFile<M>, system: impl Fn(M) -> System) -> ModelFile {
    let WireFile { part, rig, method, input, output, sample_time, identified_on, effects, model, .. } = wire;
    let header = Header { part, rig, method, input, output, sample_time, identified_on, effects };
    ModelFile { header, system: system(model) }
}

fn parse<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, ModelError> {
    json_file::parse(path, text).map_err(|JsonError { place, message, .. }| ModelError::Content {
        place,
        message,
        remedy: MAKE_ONE.to_owned(),
    })
}
