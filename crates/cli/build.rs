//! Shows the program which sources make, diagnose and judge the rigs of an examination, and which run the replicates of a study: what they
//! left counts, whatever else of the program is built anew.

use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The sources that judge, and the versions of the libraries.
const JUDGES: [&str; 6] =
    ["../model/src", "../noise/src", "../identify/src", "../diagnose/src", "../lab/src", "../../Cargo.lock"];

/// The sources that run replicates.
const STUDIES: [&str; 6] = [
    "../model/src",
    "../noise/src",
    "../identify/src",
    "../study/src/scenario",
    "../study/src/consistency",
    "../../Cargo.lock",
];

fn main() -> io::Result<()> {
    define("JUDGING_SOURCES", &hash(&JUDGES)?);
    define("STUDY_SOURCES", &hash(&STUDIES)?);
    define("LOCK", &hash(&["../../Cargo.lock"])?);
    define("COMMIT", &commit());
    Ok(())
}

fn define(name: &str, value: &str) {
    println!("cargo::rustc-env={name}={value}");
}

/// The commit that was checked out when this was built last, with `-dirty` where files were changed since; nothing where there is none.
///
/// A new commit alone is no reason to build anew: the hashes distinguish the sources.
fn commit() -> String {
    let reported =
        Command::new("git").args(["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]).output();
    let reported = reported.ok().filter(|reported| reported.status.success());
    reported.map(|reported| String::from_utf8_lossy(&reported.stdout).trim().to_owned()).unwrap_or_default()
}

/// One hash of all files below some paths.
fn hash(paths: &[&str]) -> io::Result<String> {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut digest = Sha256::new();
    for path in paths {
        println!("cargo::rerun-if-changed={path}");
        for file in files(&here.join(path))? {
            let text = fs::read(&file)?;
            let name = file.strip_prefix(&here).unwrap_or(&file).to_string_lossy().replace('\\', "/");
            digest.update(format!("{name} {}\n", text.len()));
            digest.update(text);
        }
    }
    Ok(digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
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
