//! `switchback rig`, from the outside.

use assert_cmd::Command;
use predicates::str::contains;
use std::fs;

fn switchback() -> Command {
    Command::cargo_bin("switchback").unwrap()
}

#[test]
fn the_same_seed_writes_the_same_folder_and_says_what_is_in_it() {
    let root = tempfile::tempdir().unwrap();
    for name in ["one", "two"] {
        let out = root.path().join(name);
        let run = switchback()
            .args(["rig", "--effect", "creep", "--size", "2", "--seed", "7", "--out"])
            .arg(&out)
            .assert();
        run.success().stdout(contains("creep (logarithmic, operator)"));
    }
    let files = |name: &str| {
        let mut files: Vec<_> = fs::read_dir(root.path().join(name))
            .unwrap()
            .map(|f| f.unwrap())
            .map(|f| (f.file_name(), fs::read(f.path()).unwrap()))
            .collect();
        files.sort();
        files
    };
    assert_eq!(files("one").len(), 9, "seven records, what describes them, and the list of what was written");
    assert_eq!(files("one"), files("two"));
    let description = fs::read_to_string(root.path().join("one/rig.toml")).unwrap();
    assert!(!description.contains("creep"), "the folder must not show");
}

#[test]
fn what_was_put_in_shows_how_the_borders_run_between_the_levels() {
    let root = tempfile::tempdir().unwrap();
    let made = |seed: &str| {
        let out = root.path().join(seed);
        let run = switchback().args(["rig", "--seed", seed, "--json", "--out"]).arg(out).assert().success();
        let key: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
        key["curved"].as_bool().unwrap()
    };
    let curved: Vec<bool> = ["1", "2", "3", "4", "5", "6", "7", "8"].map(made).into();
    assert!(curved.contains(&true) && curved.contains(&false), "{curved:?}");
}

#[test]
fn an_unknown_effect_is_refused_and_nothing_is_written() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("rig");
    let run = switchback().args(["rig", "--effect", "blacklash", "--out"]).arg(&out).assert();
    run.code(2).stderr(contains("`blacklash` is no effect")).stderr(contains("--list"));
    assert!(!out.exists());
}

#[test]
fn the_list_names_every_effect_with_its_laws() {
    switchback()
        .args(["rig", "--list"])
        .assert()
        .success()
        .stdout(contains("play, 1 Prandtl-Ishlinskii, 2 uneven play (full width, in input units)"))
        .stdout(contains("Bouc-Wen"));
}

/// The travel lost at a reversal, whoever reports it: twice the radius of the play operator, in units of the input.
#[test]
fn a_play_is_reported_by_its_full_width_in_input_units() {
    let root = tempfile::tempdir().unwrap();
    let made = |json: &[&str]| {
        let out = root.path().join(format!("rig{}", json.len()));
        let what = ["rig", "--effect", "backlash", "--size", "2", "--seed", "514"];
        let run = switchback().args(what).args(json).arg("--out").arg(out).assert().success();
        String::from_utf8(run.get_output().stdout.clone()).unwrap()
    };
    let reported = made(&[]);
    assert!(reported.contains("backlash (play, operator): full width 0.4000 input units"), "{reported}");
    let reported = made(&["--json"]);
    assert!(reported.starts_with("{\n  \"schema\": \"switchback/rig/1\","), "{reported}");
    let key: serde_json::Value = serde_json::from_str(&reported).unwrap();
    let effect = &key["effects"][0];
    assert_eq!((&effect["quantity"], &effect["unit"]), (&"full width".into(), &"input units".into()));
    assert!((effect["magnitude"].as_f64().unwrap() - 0.4).abs() < 1e-9, "{effect}");
}

#[test]
fn a_rig_of_the_field_declares_nothing_and_its_key_shows_the_machine_from_what_was_put_in() {
    let root = tempfile::tempdir().unwrap();
    let made = |name: &str, options: &[&str]| {
        let out = root.path().join(name);
        let run = switchback()
            .args(["rig", "--field", "--seed", "5"])
            .args(options)
            .arg("--out")
            .arg(&out)
            .assert();
        let reported = String::from_utf8(run.success().get_output().stdout.clone()).unwrap();
        (reported, fs::read_to_string(out.join("rig.toml")).unwrap())
    };
    let (reported, manifest) = made("bare", &[]);
    assert!(reported.contains("of the field: by itself it has coloured_noise"), "{reported}");
    assert!(reported.ends_with("no effect\n"), "{reported}");
    assert!(!manifest.contains("order") && !manifest.contains("interval"), "{manifest}");
    assert!(manifest.contains("role = \"free\"") && manifest.contains("use = \"holdout\""), "{manifest}");
    assert_eq!(manifest.matches("role = ").count(), manifest.matches("role = \"free\"").count());

    let (reported, of_backlash) = made("backlash", &["--effect", "backlash", "--size", "2"]);
    let survives = "times what the model leaves without it";
    assert!(
        reported.contains("backlash (play, operator): full width") && reported.contains(survives),
        "{reported}"
    );
    assert_eq!(of_backlash, manifest, "the description must not show");

    let (reported, _) = made("json", &["--json"]);
    let key: serde_json::Value = serde_json::from_str(&reported).unwrap();
    assert_eq!((&key["setting"], &key["base"][0]), (&"field".into(), &"coloured_noise".into()));
    assert_eq!(key["effects"], serde_json::json!([]));
}
