//! Methods of others in a study.

mod accidents;
mod alarms;
mod bench;
mod controls;
mod overhead;
mod protocol;
mod resume;

use crate::common::{Folder, STUDY};
use std::process::Output;
use switchback_study::results::{self, Results};

/// The small study with a method of others beside its own.
pub(crate) fn study(command: &[&str], more: &str) -> String {
    let words: Vec<String> = command.iter().map(|word| format!("{word:?}")).collect();
    let method = format!("[[method]]\nname = \"theirs\"\ncommand = [{}]\n{more}\n", words.join(", "));
    STUDY.replace("[sweep]", &format!("{method}[sweep]"))
}

/// The study with our `joint` as a method of others.
fn with_joint(more: &str) -> String {
    study(&[env!("CARGO_BIN_EXE_switchback"), "method", "joint"], more).replace("\"efficient\"", "\"joint\"")
}

/// Runs a study in a folder, whose report is in `out`.
fn run(folder: &Folder, text: &str, arguments: &[&str]) -> Output {
    folder.write("study.toml", text);
    let output = folder.switchback(&[&["study.toml", "--quiet"], arguments].concat()).output();
    output.expect("it runs")
}

/// The results of a study that ends well.
#[track_caller]
fn results_of(folder: &Folder, text: &str) -> Results {
    let output = run(folder, text, &["--out", "out", "--force"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    results::read(&folder.path("out")).expect("results")
}
