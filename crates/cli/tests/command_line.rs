//! What the command line understands, and what it says to what it does not.

use crate::common::{Folder, listing};
use assert_cmd::Command;
use serde_json::Value;

fn switchback(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("switchback").expect("the binary is built");
    command.args(arguments);
    command
}

/// Exit code 2, nothing on stdout, and all the words on stderr.
#[track_caller]
fn refused(arguments: &[&str], words: &[&str]) {
    let output = switchback(arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{reported}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
}

fn printed(command: &mut Command) -> String {
    let output = command.output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn json(command: &mut Command) -> Value {
    serde_json::from_str(&printed(command)).expect("one JSON object")
}

#[test]
fn a_misspelt_verb_is_not_taken_for_a_scenario() {
    refused(&["idenify"], &["`idenify` is no verb", "did you mean `switchback identify`?"]);
    refused(&["idenify", "rig.toml"], &["did you mean `switchback identify`?"]);
    refused(&["gapp", "rig.toml", "--json"], &["did you mean `switchback gap`?"]);
    refused(&["simulat", "model.json"], &["did you mean `switchback simulate`?"]);
    refused(&["complitions", "bash"], &["did you mean `switchback completions`?"]);
    refused(&["nonsense"], &["the verbs are", "gap", "a scenario is named by its path"]);
}

#[test]
fn what_looks_like_a_path_is_one() {
    refused(&["scenarios/gapp"], &["scenarios/gapp: no such file"]);
    refused(&["gapp.toml"], &["gapp.toml: no such file"]);
}

#[test]
fn misspelt_methods_effects_and_options_get_a_suggestion() {
    refused(&["identify", "rig.toml", "--method", "eficient"], &["efficient"]);
    refused(&["gap", "rig.toml", "--without", "blacklash"], &["similar", "backlash"]);
    refused(&["rig", "--out", "x", "--effect", "blacklash"], &["did you mean `backlash`?", "--list"]);
    refused(&["rig", "--out", "x", "--effect", "amplitude_dampin"], &["did you mean `amplitude_damping`?"]);
    refused(&["gap", "rig.toml", "--jsn"], &["--json"]);
}

#[test]
fn numbers_that_cannot_be_are_reported_in_plain_words() {
    let plain = |arguments: &[&str], words: &[&str]| {
        refused(arguments, words);
        let reported =
            String::from_utf8_lossy(&switchback(arguments).output().expect("it runs").stderr).into_owned();
        for word in ["invalid digit", "invalid float", "..=", "use '--"] {
            assert!(!reported.contains(word), "`{word}` is in: {reported}");
        }
    };
    let whole = "give a whole number from 1 to 1024";
    plain(&["gap", "rig.toml", "--threads", "-1"], &[whole]);
    plain(&["gap", "rig.toml", "--threads", "two"], &[whole]);
    plain(&["gap", "rig.toml", "--threads", "0"], &[whole]);
    plain(&["gap", "rig.toml", "--threads", "65535"], &[whole]);
    plain(&["rig", "--out", "x", "--seed", "x"], &["give a whole number, 0 or more"]);
    plain(&["selftest", "--seed", "-1"], &["give a whole number from 0 to 4294967295"]);
    plain(&["rig", "--out", "x", "--size", "large"], &["give a number"]);
    plain(&["design", "--out", "x", "--order", "0"], &["give a whole number from 1 to 20"]);
    plain(&["design", "--out", "x", "--periods", "0"], &["give a whole number from 1"]);
    plain(&["gap", "rig.toml", "--foo"], &["unexpected argument '--foo'"]);
    let folder = Folder::with_good_rig();
    let output = folder.switchback(&["gap", "again.csv", "--input", "-1"]).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(reported.contains("there is no column `-1`"), "{reported}");
}

#[test]
fn a_file_of_the_wrong_kind_is_reported_with_the_verb_that_takes_it() {
    let folder = Folder::with_good_rig();
    let reported = |arguments: &[&str]| {
        let output = folder.switchback(arguments).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let data = reported(&["again.csv"]);
    assert!(data.contains("this is data") && data.contains("`switchback gap again.csv`"), "{data}");
    let rig = reported(&["rig.toml"]);
    assert!(rig.contains("this is a rig") && rig.contains("`switchback gap rig.toml`"), "{rig}");
    let from = reported(&["design", "--from", "again.csv"]);
    assert!(from.contains("this is data") && from.contains("`switchback init again.csv"), "{from}");
}

#[test]
fn quiet_verbs_say_nothing_but_the_json_that_was_asked_for() {
    let folder = Folder::with_good_rig();
    for verb in ["gap", "identify"] {
        let run = |more: &[&str]| printed(folder.switchback(&[verb, "rig.toml", "--quiet"]).args(more));
        assert_eq!(run(&[]), "", "{verb}");
        assert!(serde_json::from_str::<Value>(&run(&["--json"])).is_ok(), "{verb}");
    }
    assert_eq!(printed(&mut folder.switchback(&["rig", "--quiet", "--out", "made"])), "");
}

#[test]
fn threads_change_no_diagnosis() {
    let folder = Folder::with_good_rig();
    let gap = |threads| printed(&mut folder.switchback(&["gap", "rig.toml", "--json", "--threads", threads]));
    assert_eq!(gap("1"), gap("3"));
    refused(&["gap", "rig.toml", "--threads", "0"], &["0", "--threads"]);
}

#[test]
fn the_list_of_effects_is_json_too() {
    let page = json(&mut switchback(&["rig", "--list", "--json"]));
    let effects = page["effects"].as_array().expect("a list");
    let backlash = effects.iter().find(|e| e["effect"] == "backlash").expect("it is known");
    assert!(backlash["laws"].as_array().is_some_and(|laws| !laws.is_empty()));
    assert!(page["foreign"].to_string().contains("amplitude_damping"));
}

#[test]
fn completions_know_verbs_and_options_in_every_shell() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = printed(&mut switchback(&["completions", shell]));
        for word in ["identify", "compare", "without"] {
            assert!(script.contains(word), "{shell} does not know {word}");
        }
    }
    refused(&["completions", "bsh"], &["bash"]);
}

#[test]
fn there_is_a_manual_page_for_the_program_and_for_every_verb() {
    let page = printed(&mut switchback(&["man"]));
    assert!(page.contains(".TH switchback 1") && page.contains("3 stopped"), "{page}");
    let folder = Folder::with_good_rig();
    printed(&mut folder.switchback(&["man", "--out", "man1"]));
    let pages = listing(&folder.path("man1"));
    for verb in [
        "",
        "-compare",
        "-completions",
        "-gap",
        "-identify",
        "-init",
        "-man",
        "-plant",
        "-rig",
        "-selftest",
        "-simulate",
    ] {
        assert!(pages.contains(&format!("switchback{verb}.1")), "{verb} is missing in {pages:?}");
    }
    let gap = std::fs::read_to_string(folder.path("man1/switchback-gap.1")).expect("a page");
    assert!(gap.contains("without") && gap.contains("JSON"), "{gap}");
}
