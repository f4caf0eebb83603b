//! `switchback plant`, from the outside.

use assert_cmd::Command;
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn switchback() -> Command {
    Command::cargo_bin("switchback").unwrap()
}

/// A rig of this program's own, in a folder.
fn base() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/rigs/leaf-spring")
}

/// What was put in, as JSON.
fn injected(effect: &str, out: &Path) -> Value {
    let run = switchback()
        .args(["plant", "--effect", effect, "--size", "2", "--seed", "3", "--json", "--quiet", "--out"])
        .args([out, &base().join("rig.toml")])
        .assert()
        .success();
    serde_json::from_slice(&run.get_output().stdout).unwrap()
}

fn outputs(folder: &Path) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("sweep.csv")).unwrap();
    text.lines().skip(1).map(|line| line.rsplit(',').next().unwrap().parse().unwrap()).collect()
}

#[test]
fn a_injected_fault_changes_the_records_and_is_distinguished_from_them() {
    let root = tempfile::tempdir().unwrap();
    let (one, two) = (root.path().join("one"), root.path().join("two"));
    let fault = injected("backlash", &one);
    assert_eq!(fault, injected("backlash", &two));
    assert_eq!(outputs(&one), outputs(&two));
    assert!(outputs(&one) != outputs(&base()));
    assert_eq!((fault["effect"].as_str(), fault["exact"].as_bool()), (Some("backlash"), Some(false)));
    assert!((fault["size"].as_f64().unwrap() / 2.0 - 1.0).abs() < 0.15, "{fault}");
    assert_eq!(fault["observable"].as_bool(), Some(true));
    for file in fs::read_dir(&one).unwrap() {
        let text = fs::read_to_string(file.unwrap().path()).unwrap();
        assert!(!text.contains("backlash"), "the folder must not show");
    }
    // The planted records are a rig like any other.
    switchback().args(["identify", "--quiet"]).arg(one.join("rig.toml")).assert().success();
}

#[test]
fn a_reading_is_changed_in_the_record_itself() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("rig");
    let fault = injected("sensor_quantisation", &out);
    assert_eq!((fault["planting"].as_str(), fault["exact"].as_bool()), (Some("reading"), Some(true)));
    // A sensor that rounds knows few values.
    let mut values = outputs(&out);
    values.sort_by(f64::total_cmp);
    values.dedup_by(|x, y| (*x - *y).abs() < 1e-9);
    assert!(values.len() < outputs(&base()).len() / 4, "{}", values.len());
}

#[test]
fn what_cannot_be_injected_is_refused_and_nothing_is_written() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("rig");
    let rig = base().join("rig.toml");
    let plant = |effect: &str| {
        let mut command = switchback();
        command.args(["plant", "--quiet", "--effect", effect, "--out"]).arg(&out);
        command
    };
    let unknown = plant("blacklash").arg(&rig).assert().code(2);
    unknown.stderr(contains("`blacklash` is no effect")).stderr(contains("did you mean `backlash`"));
    plant("backlash")
        .args(["--law", "99"])
        .arg(&rig)
        .assert()
        .code(2)
        .stderr(contains("law 99 does not exist"));
    plant("backlash").args(["--size", "-1"]).arg(&rig).assert().code(2).stderr(contains("size"));
    // A model of another form, and data without an output that moves.
    let models = root.path().join("models");
    switchback().args(["identify", "--quiet", "--out"]).args([&models, &rig]).assert().success();
    let other = plant("backlash").arg("--model").args([&models.join("model.json"), &rig]).assert().code(2);
    other.stderr(contains("a model of the form `points` cannot carry a fault"));
    let flat = root.path().join("flat.csv");
    let rows: String = (0..300).map(|t| format!("{t},{},1\n", f64::from(t % 40))).collect();
    fs::write(&flat, format!("t,v,y\n{rows}")).unwrap();
    plant("backlash").arg(&flat).assert().code(2).stderr(contains("flat.csv"));
    assert!(!out.exists());
    // The records themselves are never replaced.
    let copy = root.path().join("copy");
    fs::create_dir(&copy).unwrap();
    for file in fs::read_dir(base()).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), copy.join(file.file_name())).unwrap();
    }
    let before = outputs(&copy);
    let mut onto_itself = switchback();
    onto_itself.args(["plant", "--quiet", "--force", "--effect", "backlash", "--out"]).arg(&copy);
    onto_itself.arg(copy.join("rig.toml")).assert().code(2);
    assert_eq!(outputs(&copy), before);
}

#[test]
fn a_model_of_ones_own_carries_the_fault() {
    let root = tempfile::tempdir().unwrap();
    let (models, out) = (root.path().join("models"), root.path().join("rig"));
    let rig = base().join("rig.toml");
    switchback()
        .args(["identify", "--method", "free", "--quiet", "--out"])
        .args([&models, &rig])
        .assert()
        .success();
    let plant = |model: &Path| {
        let mut command = switchback();
        command.args(["plant", "--quiet", "--effect", "backlash", "--out"]).args([&out, &rig]);
        command.arg("--model").arg(model).assert()
    };
    // One of records that are sampled otherwise.
    let file = fs::read_to_string(models.join("model.json")).unwrap();
    let other = root.path().join("other.json");
    let time = file.lines().find(|line| line.contains("\"sample_time\"")).unwrap();
    fs::write(&other, file.replace(time, "  \"sample_time\": 12.5,")).unwrap();
    plant(&other).code(2).stderr(contains("the model was identified at 12.5 s a sample"));
    assert!(!out.exists());
    plant(&models.join("model.json")).success();
    assert!(outputs(&out) != outputs(&base()));
}
