//! The bases: measured rigs in a folder, and made ones.

use super::made;
use crate::examination::design::Design;
use crate::examination::random::scramble;
use crate::examination::scenario::Study;
use crate::generate::MakeError;
use miette::Diagnostic;
use rayon::prelude::*;
use std::io;
use std::path::{Path, PathBuf};
use switchback_io::input::names;
use switchback_io::output::note;
use switchback_io::rig::{self, RIG_FILE};
use switchback_model::rig::Rig;
use thiserror::Error;

/// A machine as it is.
#[derive(Debug, Clone)]
pub struct Base {
    /// Its name in reports: the measured rig's folder, or `made-NUMBER`.
    pub name: String,
    /// Its records.
    pub rig: Rig,
    /// Seed of a made one.
    pub made: Option<u64>,
    /// Effects that a made machine has by itself.
    pub own: Vec<&'static str>,
}

/// All bases of an examination.
#[derive(Debug, Clone, Default)]
pub struct Bases {
    /// Measured ones by name, then made ones: those that faults are put into, then those that stay without.
    pub all: Vec<Base>,
    /// Made ones at the end that stay without fault.
    pub spare: usize,
}

/// Why there are no bases.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub(crate) enum BaseError {
    /// Neither measured nor made ones.
    #[error("{folder}: holds no measured rig, and the scenario makes no base")]
    #[diagnostic(help(
        "give a folder with rigs (each a folder with {RIG_FILE}), or set `made` to at least 1"
    ))]
    None {
        /// The folder asked for.
        folder: String,
    },
    /// A folder cannot be listed.
    #[error("{folder}: cannot be listed: {source}")]
    #[diagnostic(help("give a folder that you may read"))]
    Folder {
        /// The folder.
        folder: String,
        /// What the system says.
        source: io::Error,
    },
    /// A rig could not be made.
    #[error("a base could not be made: {0}")]
    #[diagnostic(help("this is a mistake of the program; another seed may avoid it"))]
    Made(#[from] MakeError),
}

/// Distinguishes the seeds of bases from all others of a study.
const BASES: u64 = 0x4649_454C_4442_4153;

impl Bases {
    /// Reads the measured ones and makes the others; a folder that is not there is reported on stderr. The laboratory has none.
    ///
    /// # Errors
    /// A rig that cannot be read, or no base at all.
    pub fn load(study: &Study, quiet: bool) -> miette::Result<Self> {
        if study.design == Design::Laboratory {
            return Ok(Self::default());
        }
        let mut all = Vec::new();
        match study.rigs.as_deref().map(|rigs| (rigs, folder(study, rigs))) {
            Some((_, Some(folder))) => all = measured(&folder)?,
            Some((rigs, None)) if !quiet => note(&format!(
                "NO MEASURED BASES: the folder {} exists neither beside the scenario nor here; made bases only\n",
                rigs.display()
            )),
            _ => {}
        }
        if all.is_empty() && study.made == 0 {
            let folder = study.rigs.as_deref().unwrap_or(Path::new("")).display().to_string();
            return Err(BaseError::None { folder }.into());
        }
        let made = (0..study.made + study.none)
            .into_par_iter()
            .map(|k| {
                let seed = scramble(study.seed ^ BASES, k as u64);
                let (rig, own) = made::base(seed)?;
                Ok(Base { name: format!("made-{}", k + 1), rig, made: Some(seed), own })
            })
            .collect::<Result<Vec<_>, BaseError>>()?;
        all.extend(made);
        Ok(Self { all, spare: study.none })
    }

    /// The bases that faults are put into, by their position.
    pub(crate) fn contexts(&self) -> std::ops::Range<usize> {
        0..self.all.len() - self.spare
    }

    /// The made ones that stay without fault.
    pub(crate) fn spares(&self) -> std::ops::Range<usize> {
        self.contexts().end..self.all.len()
    }

    /// The measured ones.
    pub(crate) fn measured(&self) -> std::ops::Range<usize> {
        0..self.all.iter().take_while(|base| base.made.is_none()).count()
    }
}

/// The folder of measured rigs, beside the scenario or in the working folder.
fn folder(study: &Study, rigs: &Path) -> Option<PathBuf> {
    [study.folder.join(rigs), rigs.to_owned()].into_iter().find(|path| path.is_dir())
}

fn measured(folder: &Path) -> miette::Result<Vec<Base>> {
    let base = |(name, rig)| Base { name, rig, made: None, own: Vec::new() };
    Ok(measured_rigs(folder)?.into_iter().map(base).collect())
}

/// The measured rigs below a folder, each with its name, in the order of the names.
///
/// # Errors
/// A folder that cannot be listed, or a rig that cannot be read.
pub fn measured_rigs(folder: &Path) -> miette::Result<Vec<(String, Rig)>> {
    let mut files = Vec::new();
    collect(folder, &mut files)?;
    files.sort();
    let named = |file: &PathBuf| -> miette::Result<(String, Rig)> {
        let place = file.parent().unwrap_or(folder);
        let parts = place.strip_prefix(folder).unwrap_or(place).components();
        let name: Vec<_> = parts.map(|part| part.as_os_str().to_string_lossy()).collect();
        Ok((name.join("/"), rig::read(file)?))
    };
    files.iter().map(named).collect()
}

/// Every rig file below a folder but those in folders called `made-…`: their rigs are made.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), BaseError> {
    let fails = |source| BaseError::Folder { folder: folder.display().to_string(), source };
    for name in names(folder).map_err(fails)? {
        let path = folder.join(&name);
        if !path.is_dir() || name.starts_with("made-") {
            continue;
        }
        let file = path.join(RIG_FILE);
        if file.is_file() {
            files.push(file);
        }
        collect(&path, files)?;
    }
    Ok(())
}
