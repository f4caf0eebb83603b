//! `switchback bench`: two versions of an estimator on the same noise.

use super::study;
use crate::common::{Folder, STUDY, listing};
use serde_json::Value;
use std::fs;
use std::process::Output;

/// The small study with our `joint` as a program of others, of so many replicates.
fn with_program(replicates: usize) -> String {
    study(&[env!("CARGO_BIN_EXE_switchback"), "method", "joint"], "")
        .replace("replicates = 40", &format!("replicates = {replicates}"))
}

fn bench(folder: &Folder, text: &str, arguments: &[&str]) -> Output {
    folder.write("study.toml", text);
    let output = folder.switchback(&[&["bench", "study.toml"], arguments].concat()).output();
    output.expect("it runs")
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn the_same_estimator_as_a_program_is_equivalent() {
    let folder = Folder::with_good_rig();
    let output =
        bench(&folder, &with_program(200), &["joint", "theirs", "--equivalent", "--json", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output));
    let page: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&page["verdict"], &page["replicates"]), (&Value::from("equivalent"), &Value::from(200)));
    // Two cells of eight parameters, two differences of each, and the failures.
    assert_eq!(page["family"], 2 * (2 * 8 + 1));
    for parameter in page["cells"][1]["parameters"].as_array().expect("parameters") {
        assert!(parameter["bias"]["value"].as_f64().expect("a number").abs() < 1e-9, "{parameter}");
    }
    let again =
        bench(&folder, &with_program(200), &["joint", "theirs", "--json", "--quiet", "--threads", "1"]);
    assert_eq!(again.stdout, output.stdout, "whatever the threads");
}

#[test]
fn a_worse_version_is_an_alarm_and_the_way_back_is_none() {
    let folder = Folder::with_good_rig();
    let text = STUDY.replace("replicates = 40", "replicates = 200");
    let alarm = bench(&folder, &text, &["joint", "memoryless"]);
    assert_eq!(alarm.status.code(), Some(1), "{}", words(&alarm));
    assert!(words(&alarm).contains("ALARM") && words(&alarm).contains("bias [sd of the baseline]"));
    let better = bench(&folder, &text, &["memoryless", "joint", "--json", "--quiet"]);
    let page: Value = serde_json::from_slice(&better.stdout).expect("JSON");
    assert_eq!(
        (&page["measures"][0]["verdict"], &page["measures"][2]["verdict"]),
        (&Value::from("better"), &Value::from("equivalent"))
    );
    let few = bench(&folder, &text, &["joint", "efficient", "--replicates", "10"]);
    assert_eq!(few.status.code(), Some(0));
    assert!(words(&few).contains("not shown to be equivalent"), "{}", words(&few));
    assert_eq!(
        bench(&folder, &text, &["joint", "efficient", "--replicates", "10", "--equivalent"]).status.code(),
        Some(1)
    );
}

/// Answers our `joint`, but has no estimate where the number of the replicate ends in 7.
const FAILING: &str = r#"import json, subprocess, sys
worker = subprocess.Popen([sys.argv[1], "method", "joint"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
for line in sys.stdin:
    worker.stdin.write(line)
    worker.stdin.flush()
    answer, request = json.loads(worker.stdout.readline()), json.loads(line)
    if request.get("replicate", 0) % 10 == 7:
        answer = {"id": request["id"], "failed": "no convergence"}
    print(json.dumps(answer), flush=True)
"#;

#[test]
fn failures_are_an_alarm_and_the_rest_is_compared() {
    if std::process::Command::new("python3").arg("--version").output().is_err() {
        eprintln!("SKIPPED: there is no python3");
        return;
    }
    let folder = Folder::with_good_rig();
    folder.write("failing.py", FAILING);
    let text = study(&["python3", "failing.py", env!("CARGO_BIN_EXE_switchback")], "");
    let output = bench(&folder, &text, &["joint", "theirs", "--replicates", "200"]);
    assert_eq!(output.status.code(), Some(1), "{}", words(&output));
    assert!(words(&output).contains("the new version said: no convergence"), "{}", words(&output));
    assert!(
        words(&output)
            .contains("without an estimate: 0 of 400 replicates of the baseline, 40 of the new version")
    );
    let page = bench(&folder, &text, &["joint", "theirs", "--replicates", "200", "--json", "--quiet"]);
    let page: Value = serde_json::from_slice(&page.stdout).expect("JSON");
    let verdicts: Vec<&str> =
        page["measures"].as_array().expect("measures").iter().filter_map(|m| m["verdict"].as_str()).collect();
    assert_eq!(verdicts, ["equivalent", "equivalent", "worse"]);
    assert_eq!(page["cells"][0]["pairs"], 180);
}

#[test]
fn a_history_grows_by_a_line_a_version_and_is_drawn() {
    let folder = Folder::with_good_rig();
    let run = |label: &str| {
        let arguments = [
            "joint",
            "efficient",
            "--history",
            "kept/history.jsonl",
            "--label",
            label,
            "--out",
            "out",
            "--quiet",
        ];
        let output = bench(&folder, STUDY, &arguments);
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", words(&output));
        fs::read_to_string(folder.path("kept/history.jsonl")).expect("a history")
    };
    let first = run("first");
    assert_eq!(first.lines().count(), 1);
    let second = run("second <&> …");
    assert!(second.starts_with(&first) && second.lines().count() == 2);
    assert_eq!(run("first"), second, "a run that is repeated is no other version");
    assert_eq!(listing(&folder.path("kept")), ["history.jsonl"]);
    let svg = fs::read_to_string(folder.path("out/history.svg")).expect("a figure");
    assert!(svg.contains("second &lt;&amp;&gt; …"));
    let out = listing(&folder.path("out"));
    assert_eq!(out, [".switchback.sha256", "bench.json", "bench.txt", "history.svg"]);
}

#[test]
fn what_cannot_be_compared_is_bad_input_and_changes_nothing() {
    let folder = Folder::with_good_rig();
    folder.write("history.jsonl", "{\"label\":\"x\"}\n");
    let only_a = study(&["sh", "x.sh"], "parameters = [\"a\"]");
    let both = only_a
        .replace("[sweep]", "[[method]]\nname = \"mine\"\ncommand = [\"sh\"]\nparameters = [\"b\"]\n[sweep]");
    let alone = STUDY.replace("replicates = 40", "replicates = 40\ncoupling = \"independent\"");
    let history = ["joint", "efficient", "--history", "history.jsonl", "--label", "c"];
    for (text, arguments, reported) in [
        (STUDY, &["joint", "mine"][..], "`mine` is no method"),
        (STUDY, &["joint", "paper-descendant"], "the methods are joint, efficient"),
        (STUDY, &["joint", "joint"], "compared with itself"),
        (&both, &["theirs", "mine"], "estimate no parameter"),
        (&alone, &["joint", "efficient"], "coupling"),
        (&only_a, &["joint", "theirs"], "method `theirs`"),
        (STUDY, &["joint", "efficient", "--replicates", "4000000000"], "at most"),
        (STUDY, &["joint", "efficient", "--bias", "-1"], "--bias"),
        (STUDY, &["joint", "efficient", "--false-alarms", "2"], "--false-alarms"),
        (STUDY, &["joint", "efficient", "--history", "new.jsonl"], "--label"),
        (STUDY, &["joint", "efficient", "--history", "new.jsonl", "--label", "a\nb"], "--label"),
        (STUDY, &history, "history.jsonl:1: this is no entry"),
        ("study = \"blind\"", &["joint", "efficient"], "examination of the diagnosis"),
    ] {
        let output = bench(&folder, text, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", words(&output));
        assert!(words(&output).contains(reported), "{arguments:?}: {}", words(&output));
        assert_eq!(fs::read_to_string(folder.path("history.jsonl")).expect("kept"), "{\"label\":\"x\"}\n");
        assert!(!folder.path("new.jsonl").exists());
    }
}
