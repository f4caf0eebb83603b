//! What a study or an examination amounts to that was stopped, beside the report that will be.

use crate::options::Force;
use std::path::{Path, PathBuf};
use switchback_io::output::{Artefacts, remove};

/// Where it is written.
pub(super) fn place(report: &Path) -> PathBuf {
    report.join("partial")
}

/// Removes it: the report shows all. Files of someone else stay, and the folder with them.
pub(super) fn forget(report: &Path, files: &[&str], force: Force) {
    let place = place(report);
    let claimed = if place.is_dir() { force.claim(&place, files).ok() } else { None };
    if let Some(folder) = claimed
        && folder.commit(&Artefacts::default()).is_ok()
    {
        let _ = remove(&place.join(".switchback.sha256"));
        let _ = remove(&place);
    }
}
