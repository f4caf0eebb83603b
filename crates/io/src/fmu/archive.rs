//! The archive that an FMU is.

use super::error::FmuError;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;
use zip::ZipArchive;

/// Most bytes that an archive may unpack to.
const LARGEST: u64 = 4 << 30;

/// Unpacks an FMU into a folder; what would leave the folder, or is a link, is refused.
pub(super) fn unpack(fmu: &Path, folder: &Path) -> Result<(), FmuError> {
    let fail = |what: String| {
        FmuError::new(fmu, what, "give a co-simulation FMU of FMI 2.0, as simulators export it")
    };
    let file = File::open(fmu).map_err(|error| fail(error.to_string()))?;
    let mut archive = ZipArchive::new(file)
        .map_err(|error| fail(format!("this is no FMU, which is a zip archive: {error}")))?;
    let mut left = LARGEST;
    for k in 0..archive.len() {
        let entry = archive.by_index(k).map_err(|error| fail(error.to_string()))?;
        let name = entry.name().map_err(|error| fail(error.to_string()))?.into_owned();
        let inside = entry.enclosed_name().filter(|_| !entry.is_symlink());
        let Some(inside) = inside else {
            return Err(fail(format!("its entry `{name}` would be written outside of it, or is a link")));
        };
        let place = folder.join(inside);
        if entry.is_dir() {
            fs::create_dir_all(&place).map_err(|error| fail(format!("`{name}`: {error}")))?;
            continue;
        }
        let written = write(entry, &place, left).map_err(|error| fail(format!("`{name}`: {error}")))?;
        left = left
            .checked_sub(written)
            .filter(|left| *left > 0)
            .ok_or_else(|| fail("it unpacks to more than 4 GiB".to_owned()))?;
    }
    Ok(())
}

fn write(entry: impl Read, place: &Path, most: u64) -> io::Result<u64> {
    if let Some(parent) = place.parent() {
        fs::create_dir_all(parent)?;
    }
    io::copy(&mut entry.take(most), &mut File::create(place)?)
}
