//! The page of a blind or a field examination.

mod blind;
mod field;
mod made;
mod measures;
mod partial;
mod share;

use super::error::PageError;
use super::files::Files;
use switchback_lab::blind::json as blind_json;
use switchback_lab::field::json as field_json;

/// The page of the files of an examination.
///
/// # Errors
/// [`PageError`] if results.json is of another format.
pub(super) fn examination(files: &Files) -> Result<String, PageError> {
    match files.needed("results.json")?.contains("\"switchback/field/") {
        true => field::field(files, &files.object("results.json", field_json::SCHEMA)?),
        false => blind::blind(files, &files.object("results.json", blind_json::SCHEMA)?),
    }
}
