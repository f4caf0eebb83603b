//! What scenarios of examinations have in common.

use crate::generate::EFFECTS;
use miette::Diagnostic;
use std::path::Path;
use switchback_io::input::{FileError, TomlError, TomlFile, closest};
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
pub(crate) fn study_of(path: &Path) -> Option<String> {
    let table: toml::Table = TomlFile::read(path).ok()?.parse().ok()?;
    table.get("study").and_then(toml::Value::as_str).map(str::to_owned)
}

/// Most rigs of a design: a year of diagnoses on any machine, and more than memory holds once they are made.
const MOST_RIGS: u64 = 1_000_000;

/// Checks that a count of a scenario is within `most`.
///
/// # Errors
/// A count beyond it, with its key.
pub(crate) fn refuse_more_than(
    file: &TomlFile,
    most: u64,
    (key, count): (&str, &Spanned<usize>),
) -> Result<(), TomlError> {
    let found = *count.get_ref();
    if found as u64 <= most {
        return Ok(());
    }
    let message = format!("`{key} = {found}` is beyond what can be run");
    Err(file.error(count.span(), message, format!("give {most} or less")))
}

/// Checks that no key of a design, nor all of it, asks for more rigs than can be run. `rigs` counts those that keys give by being multiplied;
/// it is called when each is known to be small.
///
/// # Errors
/// Too many, with the key.
pub(crate) fn refuse_large_design(
    file: &TomlFile,
    counts: &[(&str, &Spanned<usize>)],
    rigs: impl FnOnce() -> u64,
) -> Result<(), TomlError> {
    counts.iter().try_for_each(|count| refuse_more_than(file, MOST_RIGS, *count))?;
    let rigs = rigs();
    if rigs <= MOST_RIGS {
        return Ok(());
    }
    let message = format!("effects, sizes and counts make {rigs} rigs in all");
    let span = counts.first().map_or(0..0, |(_, count)| count.span());
    Err(file.error(span, message, format!("lower the counts, so that there are {MOST_RIGS} or less")))
}

/// The effects listed, by the names of the catalogue; all that can be made where no list is given.
///
/// # Errors
/// A name that is no effect, or is listed twice.
pub(crate) fn effects_listed(
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
