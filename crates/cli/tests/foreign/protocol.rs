//! Requests and answers, and what becomes of them whoever asks, in which pieces.

use super::{results_of, run, study, with_joint};
use crate::common::faults::files;
use crate::common::{Folder, STUDY};
use serde_json::Value;
use std::fs;
use switchback_study::results::{Measured, Parameter};

/// Figures that follow from the replicates alone, without control variates.
const PLAIN: [fn(&Parameter) -> Option<Measured>; 6] =
    [|p| p.bias, |p| p.sd, |p| p.mse, |p| p.coverage, |p| p.model_sd, |p| p.model_sd_relative_error];

#[test]
fn our_joint_as_a_method_of_others_gives_the_same_table() {
    let folder = Folder::with_good_rig();
    let results = results_of(&folder, &with_joint(""));
    let (ours, theirs) = results.cells.split_at(results.cells.len() / 2);
    assert_eq!((ours.len(), theirs.len()), (2, 2));
    for (ours, theirs) in ours.iter().zip(theirs) {
        assert_eq!((theirs.series.method.name(), ours.samples), ("theirs", theirs.samples));
        assert_eq!(ours.intervals, theirs.intervals);
        assert_eq!(theirs.failures.count, 0, "{:?}", theirs.failures);
        for (p, q) in ours.parameters.iter().zip(&theirs.parameters) {
            assert_eq!((&p.name, p.v, p.truth, p.bound_sd), (&q.name, q.v, q.truth, q.bound_sd));
            for figure in PLAIN {
                let (one, other) = (figure(p).expect("a figure"), figure(q).expect("a figure"));
                let apart = (one.value() - other.value()).abs();
                assert!(apart <= 2e-4 * one.mcse(), "{}: {one:?}, {other:?}", p.name);
            }
        }
    }
    // The summaries say the same of both, and compare them on the same noise.
    let slopes = |name: &str| -> Vec<_> {
        let of = results.summaries.iter().filter(|s| s.series.method.name() == name);
        of.map(|s| (s.group, s.sd_slope.map(|f| (f.estimate * 1e6).round()))).collect()
    };
    assert_eq!(slopes("joint"), slopes("theirs"));
    let paired = results.paired.expect("shared noise");
    let overall = paired.overall.iter().find(|o| o.subject.to_string() == "theirs").expect("a comparison");
    assert!((overall.variance_ratio.value() - 1.0).abs() < 1e-9, "{overall:?}");
}

#[test]
fn replayed_estimates_of_our_joint_are_the_same_to_twelve_digits() {
    let folder = Folder::with_good_rig();
    let results = results_of(&folder, &with_joint(""));
    for replicate in [0, 7, 39] {
        let errors = |cell: usize| -> Vec<f64> {
            let id = format!("{cell}:{replicate}");
            let output = folder.switchback(&["replay", "out", &id, "--json"]).output().expect("it runs");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
            let found = &value["cells"][0]["parameters"];
            let error = |e: &Value| e["error"].as_f64().expect("a number");
            found.as_array().expect("estimates").iter().map(error).collect()
        };
        for cell in 0..results.cells.len() / 2 {
            let (ours, theirs) = (errors(cell), errors(cell + results.cells.len() / 2));
            assert_eq!((ours.len(), theirs.len()), (8, 8));
            for (one, other) in ours.iter().zip(theirs) {
                assert!((one - other).abs() <= 1e-12, "{replicate}: {one} {other}");
            }
        }
    }
}

#[test]
fn bytes_do_not_depend_on_threads_processes_or_parts() {
    let folder = Folder::with_good_rig();
    let fewer = |workers: &str| with_joint(workers).replace("replicates = 40", "replicates = 200");
    let output = run(&folder, &fewer(""), &["--out", "whole"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let whole = files(&folder.path("whole"));
    assert!(whole.contains_key("results.json"));
    for threads in ["1", "3"] {
        let output = run(&folder, &fewer(""), &["--out", threads, "--threads", threads]);
        assert_eq!(output.status.code(), Some(0));
        assert!(files(&folder.path(threads)) == whole, "at {threads} threads another report");
    }
    let parts: Vec<String> = (1..=3).map(|number| format!("part-{number}")).collect();
    for (k, part) in parts.iter().enumerate() {
        let shard = format!("{}/3", k + 1);
        assert_eq!(run(&folder, &fewer(""), &["--shard", &shard, "--out", part]).status.code(), Some(0));
    }
    let merged =
        [&["merge"], &parts.iter().map(String::as_str).collect::<Vec<_>>()[..], &["--out", "merged"]];
    let output = folder.switchback(&merged.concat()).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(files(&folder.path("merged")) == whole, "of parts another report");
    // The scenario in the results says how many processes there were, and nothing else does.
    let one = results_of(&folder, &fewer("workers = 1"));
    let all = switchback_study::results::read(&folder.path("whole")).expect("results");
    assert_eq!(one.summaries, all.summaries);
    assert_eq!(one.cells, all.cells);
}

/// An estimator in the shell: it answers each request by what `answer` prints, which knows `$line`, `$id` and `$r`, the number of the replicate.
pub(super) fn shell(version: &str, answer: &str) -> String {
    format!(
        "read -r greeting\n\
         echo '{{\"schema\":\"switchback/method/1\",\"version\":\"{version}\"}}'\n\
         while read -r line; do\n\
         id=${{line#*\\\"id\\\":}}; id=${{id%%,*}}\n\
         r=${{line#*\\\"replicate\\\":}}; r=${{r%%,*}}\n\
         {answer}\n\
         done\n"
    )
}

/// Eight estimates of the small study.
pub(super) const GOOD: &str =
    "echo \"{\\\"id\\\":$id,\\\"estimate\\\":[-0.7,0.3,-0.5,-0.1,0.1,0.5,0.2,-0.$r]}\"";

#[test]
fn parts_with_other_versions_of_a_method_are_not_merged() {
    let folder = Folder::with_good_rig();
    let text = study(&["sh", "estimator.sh"], "");
    for (part, version) in [("1/2", "1.0"), ("2/2", "1.1")] {
        folder.write("estimator.sh", &shell(version, GOOD));
        let output = run(&folder, &text, &["--shard", part, "--out", &part[..1]]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let output = folder.switchback(&["merge", "1", "2", "--out", "out"]).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(reported.contains("another version of a method"), "{reported}");
    assert!(!folder.path("out").exists());
    // So do the ids of the cells show it.
    let ids = |version: &str| -> Vec<Option<String>> {
        folder.write("estimator.sh", &shell(version, GOOD));
        results_of(&folder, &text).cells.into_iter().map(|cell| cell.strong_id).collect()
    };
    let (one, other) = (ids("1.0"), ids("1.1"));
    assert_eq!(one[..2], other[..2], "our own cells are the same");
    assert!(one[2..].iter().zip(&other[2..]).all(|(one, other)| one != other));
    assert!(one.iter().all(Option::is_some));
}

#[test]
fn a_request_says_how_the_record_was_made_and_nothing_of_the_system() {
    let folder = Folder::with_good_rig();
    folder.write("estimator.sh", &shell("1", &format!("echo \"$line\" >> requests\n{GOOD}")));
    let results = results_of(&folder, &study(&["sh", "estimator.sh"], "workers = 1"));
    let text = fs::read_to_string(folder.path("requests")).expect("requests");
    // Forty replicates and their partners, at two numbers of samples.
    assert_eq!(text.lines().count(), 2 * 2 * 40);
    for line in text.lines() {
        let request: Value = serde_json::from_str(line).expect("JSON");
        let keys: Vec<&String> = request.as_object().expect("an object").keys().collect();
        let known = [
            "antithetic",
            "block",
            "cell",
            "experiments",
            "id",
            "interval",
            "order",
            "parameters",
            "points",
            "replicate",
            "samples",
            "y",
        ];
        let mut sorted: Vec<&str> = keys.iter().map(|key| key.as_str()).collect();
        sorted.sort_unstable();
        assert_eq!(sorted, known);
        for truth in ["0.7", "spring", "stiffness", "leaf", "noise"] {
            assert!(!line.contains(truth), "{truth} in {line}");
        }
        let samples = request["samples"].as_u64().expect("N");
        assert_eq!(
            request["y"][0]["count"],
            samples + 2,
            "the lag of the first sample, and the move before it"
        );
        assert_eq!(request["parameters"][2], "F_desc(V1)");
    }
    // Standard errors were not reported: there is no coverage.
    let theirs = &results.cells[2];
    assert!(theirs.intervals.is_empty());
    let has_none = |p: &Parameter| {
        let scores = (p.interval_score, p.coverage_bias_eliminated);
        p.coverage.is_none() && p.model_sd.is_none() && scores == (None, None)
    };
    assert!(
        theirs
            .parameters
            .iter()
            .all(|p| has_none(p) && p.model_sd_relative_error.is_none() && p.sd.is_some())
    );
}

#[test]
fn a_method_may_estimate_some_of_the_parameters() {
    let folder = Folder::with_good_rig();
    let two = "echo \"{\\\"id\\\":$id,\\\"estimate\\\":[-0.7,0.3],\\\"se\\\":[0.1,0.1]}\"";
    folder.write("estimator.sh", &shell("1", two));
    let text = study(&["sh", "estimator.sh"], "parameters = [\"b\", \"a\"]\nantithetic = false");
    let results = results_of(&folder, &text);
    let names: Vec<&str> = results.cells[2].parameters.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["a1", "b1"]);
    assert_eq!(results.cells[2].parameters[0].coverage.map(|c| c.value()), Some(1.0));
}

#[test]
fn methods_that_cannot_be_asked_are_bad_input() {
    let folder = Folder::with_good_rig();
    folder.write("no-greeting.sh", "echo Welcome; cat\n");
    folder.write("ends.sh", "echo no such module >&2; exit 4\n");
    let plain = study(&["sh", "x.sh"], "");
    for (text, words) in [
        (study(&["no-such-program"], ""), &["theirs", "no-such-program", "cannot be started"][..]),
        (study(&["sh", "no-greeting.sh"], ""), &["theirs", "Welcome", "greeting"]),
        (study(&["sh", "ends.sh"], ""), &["theirs", "exit status: 4", "no such module"]),
        (study(&["sleep", "1000"], "patience = 0.2"), &["theirs", "no greeting within 0.2 s"]),
        (study(&[], ""), &["method[0].command", "empty"]),
        (study(&["sh"], "patience = 0"), &["patience", "above 0"]),
        (study(&["sh"], "workers = 0"), &["workers", "1 or more"]),
        (study(&["sh"], "parameters = [\"c\"]"), &["parameters", "valid: a, b, descending, ascending"]),
        (study(&["sh"], "pacience = 3"), &["pacience"]),
        (plain.replace("\"theirs\"", "\"joint\""), &["joint", "name of a method"]),
        (plain.replace("\"theirs\"", "\"../x\""), &["../x", "name of a method"]),
        (STUDY.replace("\"efficient\"", "\"theirs\""), &["theirs", "no such method"]),
    ] {
        let output = run(&folder, &text, &[]);
        let reported = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}: {reported}");
        for word in words {
            assert!(reported.contains(word), "`{word}` is missing in: {reported}");
        }
        assert!(!folder.path("reports").exists(), "nothing is written");
    }
}

#[test]
fn a_method_of_others_may_be_listed_expected_and_alone() {
    let folder = Folder::with_good_rig();
    folder.write("estimator.sh", &shell("1", GOOD));
    let text = study(&["sh", "estimator.sh"], "").replace("[\"efficient\"]", "[\"theirs\"]");
    let results = results_of(&folder, &text);
    assert!(results.cells.iter().all(|cell| cell.series.method.name() == "theirs"));
    let output = run(&folder, &format!("{text}[expect]\nconsistent = [\"theirs\"]\n"), &["--out", "other"]);
    assert_eq!(output.status.code(), Some(1), "what it prints is no estimate");
}
