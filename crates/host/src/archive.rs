//! The archive that an FMU is.

use crate::error::FmuError;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;
use switchback_io::input::regular;
use zip::ZipArchive;

/// Most bytes that an archive may unpack to.
const LARGEST: u64 = 4 << 30;

/// Unpacks an FMU into a folder; what would leave the folder, or is a link, is refused. `goes_on` receives the number of bytes so far.
pub(crate) fn unpack(fmu: &Path, folder: &Path, mut goes_on: impl FnMut(u64)) -> Result<(), FmuError> {
    let fail = |what: String| {
        FmuError::new(fmu, what, "give a co-simulation FMU of FMI 2.0, as simulators export it")
    };
    let file = regular(fmu).map_err(|error| fail(error.to_string()))?;
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
        let so_far = |written| goes_on(LARGEST - left + written);
        let written =
            write(entry, &place, (left, so_far)).map_err(|error| fail(format!("`{name}`: {error}")))?;
        left = left
            .checked_sub(written)
            .filter(|left| *left > 0)
            .ok_or_else(|| fail("it unpacks to more than 4 GiB".to_owned()))?;
    }
    Ok(())
}

/// Most bytes of an entry that are unpacked at once.
const CHUNK: u64 = 1 << 20;

fn write(entry: impl Read, place: &Path, (most, mut so_far): (u64, impl FnMut(u64))) -> io::Result<u64> {
    if let Some(parent) = place.parent() {
        fs::create_dir_all(parent)?;
    }
    let (mut entry, mut file, mut written) = (entry.take(most), File::create(place)?, 0);
    loop {
        match io::copy(&mut entry.by_ref().take(CHUNK), &mut file)? {
            0 => return file.flush().map(|()| written),
            more => written += more,
        }
        so_far(written);
    }
}
