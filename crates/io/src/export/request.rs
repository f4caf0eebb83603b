//! What is asked of an export.

use super::fmu::{LibraryError, fmu, library};
use super::heading::{heading, name_from};
use super::target::Target;
use crate::model::{ModelFile, NotCausal};
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use switchback_model::step;
use thiserror::Error;

/// What to make of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// What to make of it.
    pub to: Target,
    /// What the model is called in the file; else the name of the file, else that of the rig.
    pub name: Option<String>,
    /// The library that goes into an FMU; else the one beside the program.
    pub library: Option<PathBuf>,
}

/// Why a model was not exported.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ExportError {
    /// It looks ahead.
    #[error(transparent)]
    #[diagnostic(transparent)]
    NotCausal(#[from] NotCausal),
    /// There is no library for an FMU, or no archive of it.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Library(#[from] LibraryError),
}

impl Request {
    /// What the model is called, in a file of that path if there is one.
    pub fn name(&self, file: &ModelFile, out: Option<&Path>) -> String {
        let stem = out.and_then(Path::file_stem).and_then(|stem| stem.to_str());
        name_from(self.name.as_deref().or(stem).unwrap_or(&file.header.rig))
    }

    /// The bytes of the file: nothing is read or written but the library of an FMU. `place` is what messages call the model, `name` what it is
    /// called in the file.
    ///
    /// # Errors
    /// [`ExportError`] for a model that looks ahead, or a library that is missing.
    pub fn export(&self, file: &ModelFile, (place, name): (&Path, &str)) -> Result<Vec<u8>, ExportError> {
        let program = file.causal().map_err(|error| error.in_file(place))?.program();
        let heading = heading(file, name);
        Ok(match self.to {
            Target::C => step::c(&program, &heading).into(),
            Target::Fmu => {
                let library = library(self.library.as_deref())?;
                fmu(file, (program, &heading), &library)?
            }
        })
    }
}
