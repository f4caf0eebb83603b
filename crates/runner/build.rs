//! Tells the program which sources make, diagnose and judge the rigs of an examination: what they judged counts, whatever else of the
//! program is built anew.

use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The sources, and the versions of the libraries.
const JUDGES: [&str; 7] = [
    "../estimator/src",
    "../gap/src",
    "../maker/src",
    "src/blind",
    "src/examination",
    "src/field",
    "../../Cargo.lock",
];

fn main() -> io::Result<()> {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut digest = Sha256::new();
    for judge in JUDGES {
        println!("cargo::rerun-if-changed={judge}");
        for file in files(&here.join(judge))? {
            let text = fs::read(&file)?;
            let name = file.strip_prefix(&here).unwrap_or(&file).to_string_lossy().replace('\\', "/");
            digest.update(format!("{name} {}\n", text.len()));
            digest.update(text);
        }
    }
    let hash: String = digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=JUDGING_SOURCES={hash}");
    Ok(())
}

/// The files below a path, or the file that it is, in one order.
fn files(path: &Path) -> io::Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut inside = fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    inside.sort();
    Ok(inside.iter().map(|path| files(path)).collect::<io::Result<Vec<_>>>()?.concat())
}
