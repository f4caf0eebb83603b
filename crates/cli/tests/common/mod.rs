//! A small rig in a temporary folder, to be spoilt one thing at a time.

pub(crate) mod bench_data;
pub(crate) mod faults;

use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};
use switchback_study::consistency::Progress;
use tempfile::TempDir;

/// A study whose progress nobody follows.
pub(crate) struct Silent;

impl Progress for Silent {
    fn planned(&self, _: u64) {}
    fn advanced(&self, _: u64) {}
}

pub(crate) const RIG: &str = r#"name = "small"
sample_time = 0.01
order = 2
interval = [-1.0, 1.0]

[[record]]
file = "descendant.csv"
role = "descendant"
use = "fit"

[[record]]
file = "ascendant.csv"
role = "ascendant"
use = "fit"

[[record]]
file = "again.csv"
role = "descendant"
use = "holdout"
"#;

/// A scenario that runs in a moment; tests change a line of it.
pub(crate) const STUDY: &str = r#"study = "consistency"
question = "Is it consistent?"
seed = 3
replicates = 40
[system]
a = [-0.7]
b = [0.3]
interval = [-1.0, 1.0]
[[border]]
name = "spring"
kind = "leaf_spring"
stiffness = 1.0
friction = 0.3
[sweep]
noise = [0.1]
samples = [200, 1000]
points = [3]
methods = ["efficient"]
"#;

/// An examination of one or two rigs.
pub(crate) const BLIND: &str = r#"study = "blind"
question = "?"
seed = 4
systems = 1
sizes = [1.0]
seeds = 1
none = 2
outside = 0
pairs = 0
slice = 1
"#;

pub(crate) struct Folder {
    root: TempDir,
}

impl Folder {
    /// A rig that can be identified.
    pub(crate) fn with_good_rig() -> Self {
        let root = TempDir::new().expect("a temporary folder");
        let folder = Self { root };
        folder.write("rig.toml", RIG);
        folder.write("descendant.csv", &pulses(1.0, 1));
        folder.write("ascendant.csv", &pulses(-1.0, 2));
        folder.write("again.csv", &pulses(1.0, 3));
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("a writable temporary folder");
    }

    /// Rewrites a file.
    pub(crate) fn edit(&self, name: &str, change: impl Fn(&str) -> String) {
        let text = fs::read_to_string(self.path(name)).expect("a file of the rig");
        self.write(name, &change(&text));
    }

    /// Puts another text in place of a line, counted from 1.
    pub(crate) fn replace_line(&self, name: &str, line: usize, with: &str) {
        self.edit(name, |text| {
            let mut lines: Vec<&str> = text.lines().collect();
            lines[line - 1] = with;
            lines.join("\n") + "\n"
        });
    }

    /// `switchback`, run in this folder.
    pub(crate) fn switchback(&self, arguments: &[&str]) -> Command {
        let mut command = Command::cargo_bin("switchback").expect("the binary is built");
        command.current_dir(self.root.path()).args(arguments);
        command
    }

    /// Names of everything in the folder.
    pub(crate) fn listing(&self) -> Vec<String> {
        listing(self.root.path())
    }
}

pub(crate) fn listing(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("an existing folder")
        .map(|entry| entry.expect("a readable entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// The pulse experiment of the satellite `satellite` (1: descendant, −1: ascendant).
fn pulses(satellite: f64, seed: u64) -> String {
    let levels = [-satellite, -0.5 * satellite, 0.0, 0.5 * satellite];
    let period = 14;
    let mut v = vec![-satellite];
    v.extend((0..80 * period).map(|k| match k % period {
        4 => levels[0],
        phase @ (8 | 10 | 12) => levels[(phase - 6) / 2],
        _ => satellite,
    }));
    measured(&v, seed)
}

/// The step experiment at the satellite `satellite`.
pub(crate) fn step(satellite: f64, seed: u64) -> String {
    let mut v = vec![satellite; 400];
    v[0] = -satellite;
    measured(&v, seed)
}

/// What the rig answers: a leaf spring, a second-order system, a little noise.
fn measured(v: &[f64], seed: u64) -> String {
    let mut noise = seed;
    let (mut text, mut y, mut u) = (String::from("t,v,y\n"), [-0.6 * v[1]; 2], [-0.3 * v[1]; 2]);
    for t in 0..v.len() {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let white = (noise >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
        let now = 1.2 * y[0] - 0.5 * y[1] + 0.4 * u[0] + 0.2 * u[1] + 0.002 * white;
        let moved = if t > 0 { v[t] - v[t - 1] } else { 0.0 };
        let held = match moved {
            rise if rise > 0.0 => 0.3 * v[t] + 0.2,
            fall if fall < 0.0 => 0.3 * v[t] - 0.2,
            _ => u[0],
        };
        text.push_str(&format!("{:.2},{},{now}\n", 0.01 * t as f64, v[t]));
        (y, u) = ([now, y[0]], [held, u[0]]);
    }
    text
}

/// The diagnosis of a rig made with the arguments given.
pub(crate) fn diagnosis_of_made(what: &[&str]) -> serde_json::Value {
    let folder = Folder::with_good_rig();
    let made = folder.switchback(&[&["rig", "--out", "made"], what].concat()).output().expect("it runs");
    assert_eq!(made.status.code(), Some(0), "{}", String::from_utf8_lossy(&made.stderr));
    let reported = folder.switchback(&["gap", "made/rig.toml", "--json"]).output().expect("it runs");
    serde_json::from_slice(&reported.stdout).expect("one JSON object on stdout")
}
