//! The commands of a page, run in a folder of their own.

use super::page::{Block, Page};
use super::quoted;
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Runs the commands of a page in their order; what failed or prints something else than the page quotes.
pub(crate) fn complaints(root: &Path, page: &Page) -> Vec<String> {
    let folder = TempDir::new().expect("a temporary folder");
    let scenarios = root.join("scenarios").canonicalize().expect("scenarios/");
    std::os::unix::fs::symlink(scenarios, folder.path().join("scenarios")).expect("a link");
    let mut wrong = Vec::new();
    for (k, block) in page.blocks.iter().enumerate() {
        if block.language != "sh" || block.mark.is_some() {
            continue;
        }
        match run(folder.path(), block) {
            Err(reported) => wrong.push(format!("{}: failed\n{}{reported}", page.place(block), block.text)),
            Ok(printed) => {
                let below = page.blocks.get(k + 1).filter(|below| below.follows && below.language == "text");
                let missing = below.and_then(|quote| quoted::missing(&quote.text, &printed));
                wrong.extend(
                    missing.map(|words| {
                        format!("{}: does not print\n{words}\nbut\n{printed}", page.place(block))
                    }),
                );
            }
        }
    }
    wrong
}

/// What a block prints, on both streams, the standard error first; or what it said when it failed.
fn run(folder: &Path, block: &Block) -> Result<String, String> {
    let program = assert_cmd::cargo::cargo_bin("switchback");
    let mut path: OsString = program.parent().expect("a folder").into();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    let output = Command::new("bash")
        .args(["-eu", "-o", "pipefail", "-c", &block.text])
        .current_dir(folder)
        .env("PATH", path)
        .output()
        .expect("bash");
    let reported = [output.stderr, output.stdout].concat();
    let reported = String::from_utf8_lossy(&reported).into_owned();
    if output.status.success() { Ok(reported) } else { Err(reported) }
}
