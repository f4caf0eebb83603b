//! Compares what `switchback launch --plan` says of a study with what its parts take, and puts both into `docs/cluster.md`, between its markers.
//!
//! `cargo run --release --example scaling -- SCENARIO.toml`, in the workspace's root, after `cargo build --release`. Every part is run, one after
//! the other on one thread: times are seconds of processor time, which what else the machine does hardly touches. Takes a few times as long as the study.

use miette::{IntoDiagnostic, WrapErr, ensure, miette};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PAGE: &str = "docs/cluster.md";

/// Numbers of tasks that are run.
const TASKS: [usize; 3] = [3, 24, 96];

fn main() -> miette::Result<()> {
    let scenario = std::env::args().nth(1).ok_or_else(|| miette!("name a scenario"))?;
    let page = fs::read_to_string(PAGE).into_diagnostic().wrap_err("run this in the workspace's root")?;
    let study = Study::new(&scenario)?;
    let (words, _) = study.run(&["launch", &scenario, "--plan"])?;
    let plans = TASKS.map(|tasks| study.plan(tasks));
    let table = study.table(plans)?;
    let command = format!("$ switchback launch {scenario} --plan\n");
    let page = spliced(&page, "plan", &format!("```text\n{command}{words}```\n"))?;
    fs::write(PAGE, spliced(&page, "measured", &table)?).into_diagnostic()
}

/// A study, and where its parts go.
struct Study<'a> {
    scenario: &'a str,
    program: PathBuf,
    scratch: PathBuf,
}

impl<'a> Study<'a> {
    fn new(scenario: &'a str) -> miette::Result<Self> {
        let own = std::env::current_exe().into_diagnostic()?;
        let built = own.ancestors().nth(2).ok_or_else(|| miette!("no target folder"))?;
        let program = built.join("switchback");
        let scratch = built.join("scaling");
        let _of_before = fs::remove_dir_all(&scratch);
        fs::create_dir_all(&scratch).into_diagnostic()?;
        Ok(Self { scenario, program, scratch })
    }

    /// What the program prints, and its seconds of processor time as bash tells them.
    fn run(&self, arguments: &[&str]) -> miette::Result<(String, f64)> {
        let script = "TIMEFORMAT='%3U %3S'; time \"$@\" 2> /dev/null";
        let mut command = Command::new("bash");
        let output = command
            .args(["-c", script, "bash"])
            .arg(&self.program)
            .args(arguments)
            .output()
            .into_diagnostic()?;
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        ensure!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {told}");
        let seconds = told.split_whitespace().filter_map(|seconds| seconds.parse::<f64>().ok()).sum();
        Ok((String::from_utf8_lossy(&output.stdout).into_owned(), seconds))
    }

    fn plan(&self, tasks: usize) -> miette::Result<Value> {
        let arguments = ["launch", self.scenario, "--plan", "--json", "--tasks", &tasks.to_string()];
        serde_json::from_str(&self.run(&arguments)?.0).into_diagnostic()
    }

    /// One run, and the parts of each number of tasks, planned and measured.
    fn table(&self, plans: [miette::Result<Value>; TASKS.len()]) -> miette::Result<String> {
        let one_run = self.place("one-run");
        let whole = self.run(&[self.scenario, "--threads", "1", "--quiet", "--out", &one_run])?.1;
        let mut text = String::from(
            "| tasks | longest task, s | | all tasks, s | | merge, s | | all over one run | |\n|---|---|---|---|---|---|---|---|---|\n\
             | | planned | measured | planned | measured | planned | measured | planned | measured |\n",
        );
        for (tasks, plan) in TASKS.into_iter().zip(plans) {
            let plan = plan?;
            let planned =
                plan["forecasts"].as_array().and_then(|all| all.iter().find(|f| f["tasks"] == tasks));
            let planned = |name: &str| planned.and_then(|f| f[name].as_f64()).unwrap_or(f64::NAN);
            let parts =
                (1..=tasks).map(|number| self.part(number, tasks)).collect::<miette::Result<Vec<_>>>()?;
            let merge = self.merge(tasks)?;
            let same = fs::read(Path::new(&one_run).join("results.json")).into_diagnostic()?
                == fs::read(Path::new(&self.place("merged")).join("results.json")).into_diagnostic()?;
            ensure!(same, "{tasks} parts give other results");
            let all: f64 = parts.iter().sum();
            let one = plan["one_run"].as_f64().unwrap_or(f64::NAN);
            let cells = [
                (planned("longest"), parts.iter().copied().fold(0.0, f64::max)),
                (planned("processor") - planned("merge"), all),
                (planned("merge"), merge),
            ];
            let _ = write!(text, "| {tasks} |");
            for (planned, measured) in cells {
                let _ = write!(text, " {planned:.1} | {measured:.1} |");
            }
            let _ = writeln!(text, " {:.2} | {:.2} |", planned("processor") / one, (all + merge) / whole);
        }
        let _ = writeln!(text, "\nOne run took {whole:.1} s; every merged report had its bytes.");
        Ok(text)
    }

    fn part(&self, number: usize, tasks: usize) -> miette::Result<f64> {
        let (shard, out) = (format!("{number}/{tasks}"), self.place(&format!("part-{number}")));
        Ok(self
            .run(&[self.scenario, "--shard", &shard, "--threads", "1", "--force", "--quiet", "--out", &out])?
            .1)
    }

    fn merge(&self, tasks: usize) -> miette::Result<f64> {
        let parts: Vec<String> = (1..=tasks).map(|number| self.place(&format!("part-{number}"))).collect();
        let merged = self.place("merged");
        let parts = parts.iter().map(String::as_str);
        let arguments = ["merge"].into_iter().chain(parts).chain(["--force", "--quiet", "--out", &merged]);
        Ok(self.run(&arguments.collect::<Vec<_>>())?.1)
    }

    fn place(&self, name: &str) -> String {
        self.scratch.join(name).display().to_string()
    }
}

/// The page with another text between the markers of a name.
fn spliced(page: &str, name: &str, section: &str) -> miette::Result<String> {
    let (begin, end) = (format!("<!-- scaling: {name} -->\n"), format!("<!-- end of {name} -->"));
    let missing = || miette!("{PAGE} has no section between {} and {end}", begin.trim_end());
    let from = page.find(&begin).ok_or_else(missing)? + begin.len();
    let to = from + page[from..].find(&end).ok_or_else(missing)?;
    Ok(format!("{}{section}{}", &page[..from], &page[to..]))
}
