//! One measured record, to be written in many dialects.

use std::fs;
use std::path::PathBuf;
use switchback_io::rig::Survey;
use switchback_io::rig::{Between, Loaded, Request, RigError};
use tempfile::TempDir;

pub(crate) const SAMPLES: usize = 600;

/// Travel and force of a leaf spring with a first-order sensor, as a logger prints them.
pub(crate) fn truth() -> (Vec<f64>, Vec<f64>) {
    let printed = |x: f64, decimals: usize| format!("{x:.decimals$}").parse::<f64>().expect("a number");
    let v: Vec<f64> = (0..SAMPLES)
        .map(|k| k as f64 * 0.01)
        .map(|t| printed(12.0 * (5.1 * t).sin() * (0.9 * t).cos() + 3.0 * (13.0 * t).sin(), 3))
        .collect();
    let (mut u, mut y, mut noise) = (0.0, 0.0, 1_u64);
    let force = (0..SAMPLES).map(|k| {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let white = (noise >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        y += 0.5 * (u - y) + 0.05 * white;
        u = match v[k].total_cmp(&v[k.saturating_sub(1)]) {
            std::cmp::Ordering::Greater => 2.0 * v[k] + 6.0,
            std::cmp::Ordering::Less => 2.0 * v[k] - 6.0,
            std::cmp::Ordering::Equal => u,
        };
        printed(y, 4)
    });
    let force = force.collect();
    (v, force)
}

/// The record's rows, each as time in seconds, input and output.
pub(crate) fn rows() -> impl Iterator<Item = (f64, f64, f64)> {
    let (v, y) = truth();
    v.into_iter().zip(y).enumerate().map(|(k, (v, y))| ((k as f64) / 100.0, v, y))
}

/// The rows as lines, cells joined by `delimiter`, numbers printed by `print`.
pub(crate) fn lines(delimiter: &str, print: impl Fn(f64) -> String) -> Vec<String> {
    rows().map(|(t, v, y)| [t, v, y].map(&print).join(delimiter)).collect()
}

pub(crate) fn point(x: f64) -> String {
    x.to_string()
}

pub(crate) fn comma(x: f64) -> String {
    x.to_string().replace('.', ",")
}

/// What the words after a verb ask for: files, and options with their values.
fn request(words: impl IntoIterator<Item = String>) -> Request {
    let mut request = Request::default();
    let mut words = words.into_iter().peekable();
    while let Some(word) = words.next() {
        let mut value = || words.next().expect("a value");
        let number = |text: String| text.parse().expect("a number");
        match word.as_str() {
            "--time" => request.columns.time = Some(value()),
            "--input" => request.columns.input = Some(value()),
            "--output" => request.columns.output = Some(value()),
            "--sample-time" => request.sample_time = Some(number(value())),
            "--rate" => request.rate = Some(number(value())),
            "--holdout" => request.holdout = Some(value()),
            "--resample" => {
                let named = words.peek().and_then(|word| Between::named(word));
                named.inspect(|_| drop(words.next()));
                request.resample = named.or(Some(Between::Linear));
            }
            file => request.data.push(file.into()),
        }
    }
    request
}

/// A folder with files of measurements.
pub(crate) struct Bench {
    root: TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { root: TempDir::new().expect("a temporary folder") }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.root.path().join(name)
    }

    pub(crate) fn with(self, name: &str, contents: impl AsRef<[u8]>) -> Self {
        fs::write(self.path(name), contents).expect("a writable temporary folder");
        self
    }

    /// Reads as the command line `switchback gap WORDS` does; words that are files of this folder are taken from it.
    pub(crate) fn load(&self, words: &[&str]) -> Result<Loaded, RigError> {
        let word = |word: &&str| {
            let path = self.path(word);
            if path.exists() || word.ends_with(".csv") {
                path.display().to_string()
            } else {
                (*word).to_owned()
            }
        };
        request(words.iter().map(word)).load("gap")
    }

    /// Looks at a file of this folder as `switchback init` does.
    pub(crate) fn survey(&self, file: &str) -> Result<Survey, RigError> {
        request([self.path(file).display().to_string()]).survey("init")
    }

    /// The message of an error, as it is reported, with the folder left out.
    pub(crate) fn refusal(&self, words: &[&str]) -> String {
        let error = self.load(words).expect_err("bad input");
        let reported = switchback_io::output::plain(&error);
        reported.replace(&format!("{}/", self.root.path().display()), "")
    }

    /// `switchback`, run in this folder.
    pub(crate) fn switchback(&self, arguments: &[&str]) -> assert_cmd::Command {
        let mut command = assert_cmd::Command::cargo_bin("switchback").expect("the binary is built");
        command.current_dir(self.root.path()).args(arguments);
        command
    }
}
