//! The archive of an FMU.

use super::heading::{effect, name_from};
use crate::identification::unit;
use crate::input::{own, program};
use crate::model::ModelFile;
use miette::Diagnostic;
use sha2::{Digest, Sha256};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use switchback_fmu::{Constant, Description, Package, SCHEMA, model_description};
use switchback_model::step::{Heading, Program};
use thiserror::Error;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// The library inside an FMU is missing.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum LibraryError {
    /// It is not beside the program.
    #[error("the library that goes into an FMU is not there: {}", .0.display())]
    #[diagnostic(help(
        "build it where the sources of this program are, `cargo build --release --locked -p switchback-fmu`, and name it: `--library target/release/{}`; \
         or copy it beside the program",
        library_name()
    ))]
    Missing(PathBuf),
    /// It cannot be read.
    #[error("{}: {why}", .path.display())]
    #[diagnostic(help("give the file `{}`, as cargo builds it", library_name()))]
    Unreadable {
        /// The library.
        path: PathBuf,
        /// What the system says.
        why: std::io::Error,
    },
    /// The archive cannot be made.
    #[error("the archive cannot be made: {0}")]
    Archive(#[from] zip::result::ZipError),
}

/// What the library is called on this platform.
fn library_name() -> String {
    format!("{DLL_PREFIX}switchback_fmu{DLL_SUFFIX}")
}

/// FMI's word for this platform.
pub fn platform() -> String {
    let bits = if cfg!(target_pointer_width = "64") { "64" } else { "32" };
    let system = match std::env::consts::OS {
        "windows" => "win",
        "macos" => "darwin",
        other => other,
    };
    format!("{system}{bits}")
}

/// The library: the one that was named, or the one beside the program.
///
/// # Errors
/// [`LibraryError`] where it is not there.
pub(super) fn library(named: Option<&Path>) -> Result<Vec<u8>, LibraryError> {
    let path = match named {
        Some(path) => path.to_owned(),
        None => beside_program(),
    };
    match own(&path) {
        Ok(bytes) => Ok(bytes),
        Err(why) if why.kind() == std::io::ErrorKind::NotFound => Err(LibraryError::Missing(path)),
        Err(why) => Err(LibraryError::Unreadable { path, why }),
    }
}

/// Where the library is: beside the program, or in `deps` there, where cargo leaves it that builds it for this program alone; the newer one
/// where it is in both.
fn beside_program() -> PathBuf {
    let program = program().unwrap_or_default();
    let folder = program.parent().unwrap_or(Path::new(""));
    let places = [folder.join(library_name()), folder.join("deps").join(library_name())];
    let written = |place: &&PathBuf| place.metadata().and_then(|found| found.modified()).ok();
    let newest = places.iter().filter(|place| place.is_file()).max_by_key(written);
    newest.unwrap_or(&places[0]).clone()
}

/// The bytes of an FMU: the same model and library give the same.
///
/// # Errors
/// [`LibraryError::Archive`] where the archive cannot be made.
pub(super) fn fmu(
    file: &ModelFile,
    (program, heading): (Program, &Heading),
    library: &[u8],
) -> Result<Vec<u8>, LibraryError> {
    let header = &file.header;
    let constants = constants(file);
    let [low, high] = header.identified_on.interval;
    let mut package = Package {
        schema: SCHEMA.to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        guid: String::new(),
        sample_time: header.sample_time,
        interval: [low, high],
        start: low + 0.5 * (high - low),
        constants: constants.iter().map(|constant| constant.value).collect(),
        program,
    };
    let digest = Sha256::digest(package.json());
    package.guid = digest.iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    let label = |label: &str| [label.to_owned(), unit(label).to_owned()];
    let description = Description {
        title: format!("{} model of {}", header.part, header.rig),
        identifier: heading.name.clone(),
        says: heading.says.join(" "),
        input: label(&header.input),
        output: label(&header.output),
        constants,
    };
    let binary = format!("binaries/{}/{}{DLL_SUFFIX}", platform(), heading.name);
    let entries = [
        ("modelDescription.xml", model_description(&package, &description).into_bytes()),
        (binary.as_str(), library.to_vec()),
        ("resources/model.json", package.json().into_bytes()),
    ];
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        // No time of day: the same model gives the same bytes.
        archive.start_file(name, SimpleFileOptions::default().unix_permissions(0o644))?;
        archive.write_all(&bytes).map_err(zip::result::ZipError::from)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// The working interval and the effects with their parameters, as constants.
fn constants(file: &ModelFile) -> Vec<Constant> {
    let on = &file.header.identified_on;
    let unit = unit(&file.header.input).to_owned();
    let end = |name: &str, says: &str, value: f64| Constant {
        name: format!("identified_on.{name}"),
        unit: unit.clone(),
        says: says.to_owned(),
        value,
    };
    let mut all = vec![
        end("lowest", "lower end of the working interval", on.interval[0]),
        end("highest", "upper end of the working interval", on.interval[1]),
        end("largest_step", "largest change of the input from one sample to the next", on.largest_step),
    ];
    for added in &file.header.effects {
        for parameter in &added.parameters {
            let Some(value) = parameter.value else { continue };
            all.push(Constant {
                name: format!("{}.{}", added.effect, name_from(&parameter.name)),
                unit: parameter.unit.clone(),
                says: effect(added),
                value,
            });
        }
    }
    all
}
