//! What scenarios of examinations have in common.

use crate::input::{FileError, TomlError, TomlFile, closest};
use miette::Diagnostic;
use std::path::Path;
use switchback_maker::EFFECTS;
use thiserror::Error;
use toml::Spanned;

/// Why a file is no scenario of an examination.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// Its content is refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Content(Box<TomlError>),
}

impl From<TomlError> for ScenarioError {
    fn from(error: TomlError) -> Self {
        Self::Content(Box::new(error))
    }
}

/// What a scenario file calls its study; none of one that cannot be read or parsed.
pub fn study_of(path: &Path) -> Option<String> {
    let table: toml::Table = TomlFile::read(path).ok()?.parse().ok()?;
    table.get("study").and_then(toml::Value::as_str).map(str::to_owned)
}

/// The effects listed, by the names of the catalogue; all that can be made where no list is given.
///
/// # Errors
/// A name that is no effect, or is listed twice.
pub fn effects_listed(
    file: &TomlFile,
    listed: Option<&[Spanned<String>]>,
) -> Result<Vec<&'static str>, TomlError> {
    let Some(listed) = listed else { return Ok(EFFECTS.to_vec()) };
    let mut effects = Vec::new();
    for name in listed {
        let known = EFFECTS.into_iter().find(|known| known == name.get_ref());
        let Some(effect) = known else {
            let remedy = closest(name.get_ref(), EFFECTS).map_or_else(
                || format!("known are {}", EFFECTS.join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            let message = format!("`{}` is no effect that can be made", name.get_ref());
            return Err(file.error(name.span(), message, remedy));
        };
        if effects.contains(&effect) {
            let message = format!("`{effect}` is listed twice");
            return Err(file.error(name.span(), message, "name each effect once"));
        }
        effects.push(effect);
    }
    Ok(effects)
}
