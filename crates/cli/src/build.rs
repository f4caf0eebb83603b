//! The sources that this program was built from.

use switchback_io::provenance::Build;

/// As the build script found them.
pub(crate) const BUILD: Build =
    Build { commit: env!("COMMIT"), study_sources: env!("STUDY_SOURCES"), lock: env!("LOCK") };

/// SHA-256 of the sources that make, diagnose and judge rigs.
pub(crate) const JUDGING_SOURCES: &str = env!("JUDGING_SOURCES");
