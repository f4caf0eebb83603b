//! A field examination of made bases, with an examiner that is easy to foresee in place of the diagnosis.

use crate::common::Folder;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use switchback_diagnose::{DiagnoseError, Diagnosis, Model, Settings};
use switchback_io::output::sha256;
use switchback_lab::examination::{
    Bases, Case, Examination, Kind, Part, Ticket, answers, key_file, merged, read,
};
use switchback_model::rig::Rig;
use switchback_study::Shard;

const FIELD: &str = r#"study = "field"
question = "?"
seed = 4
effects = ["sensor_drift", "gain_drift"]
sizes = [2.0]
seeds = 1
made = 2
none = 1
outside = 0
slice = 4
"#;

/// Two bases with two faults each and one without, of which two run.
fn folder() -> Folder {
    let folder = Folder::with_good_rig();
    folder.write("field.toml", FIELD);
    folder
}

fn bases(scenario: &Path) -> Bases {
    Bases::load(&read(scenario).expect("a scenario"), true).expect("bases")
}

/// Refuses every rig: of what is judged only the replies differ then.
fn refuse(_: &Rig, _: Model, _: &Settings) -> Result<Diagnosis, DiagnoseError> {
    Err(DiagnoseError::ConstantInput)
}

fn field<'b>(scenario: &Path, bases: &'b Bases) -> Examination<'b> {
    Examination::of(refuse, read(scenario).expect("a scenario"), bases)
}

/// Makes and judges the rigs of a part: key file and cases.
fn judged(field: &Examination<'_>, shard: Shard) -> (String, Vec<Case>) {
    let tickets = field.tickets().into_iter().enumerate();
    let tickets = tickets.filter(|(k, _)| shard.holds(*k)).map(|(_, ticket)| ticket).collect();
    let sealed = field.seal(tickets, "", &|| ()).expect("rigs");
    let mut cases: Vec<Case> = sealed.par_iter().map(|rig| field.judge(rig).expect("a case")).collect();
    cases.sort_by_key(|case| case.id);
    (key_file(&sealed), cases)
}

fn report(scenario: &Path, keys: &str, cases: &[Case]) -> BTreeMap<String, Vec<u8>> {
    let field = Examination::without_bases(read(scenario).expect("a scenario"));
    let report = switchback_report::examination::report(&field, &sha256(keys), cases);
    report.files.iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect()
}

#[test]
fn parts_merged_are_the_bytes_of_one_run_at_any_thread_count() {
    let folder = folder();
    let scenario = folder.path("field.toml");
    let bases = bases(&scenario);
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let (keys, cases) = pool(2).install(|| judged(&field(&scenario, &bases), Shard { number: 1, of: 1 }));
    let parted = field(&scenario, &bases);
    let parts = [2, 1].map(|number| {
        let shard = Shard { number, of: 2 };
        let (keys, cases) = pool(1).install(|| judged(&parted, shard));
        let answers = answers(parted.study().design, &cases);
        let part = Part::new(&scenario, FIELD.to_owned(), (shard, "program"), keys, cases);
        let place = folder.path(&number.to_string());
        fs::create_dir(&place).expect("a folder");
        for (name, bytes) in part.artefacts(answers).iter() {
            fs::write(place.join(name), bytes).expect("a file");
        }
        Part::read(&place).expect("a part")
    });
    let whole = merged(parts.into()).expect("a whole");
    assert_eq!((whole.keys.as_str(), whole.cases.as_slice()), (keys.as_str(), cases.as_slice()));
    let files = report(&scenario, &keys, &cases);
    assert_eq!(report(&whole.scenario, &whole.keys, &whole.cases), files);
    for file in
        ["answers.csv", "cases.jsonl", "results.json", "summary.md", "confusion.svg", "calibration.svg"]
    {
        assert!(files.contains_key(file), "{file} is missing in {:?}", files.keys());
    }
    let text = |name: &str| String::from_utf8_lossy(&files[name]).into_owned();
    // Every rig is diagnosed with the model and without.
    assert_eq!(text("answers.csv").lines().count(), 1 + 2 * cases.len());
    assert!(text("summary.md").contains("NO MEASURED BASE"));
    let results: serde_json::Value = serde_json::from_str(&text("results.json")).expect("JSON");
    assert_eq!((&results["key_sha256"], &results["failed"]), (&sha256(&keys).into(), &4.into()));
}

#[test]
fn keys_that_were_written_are_taken_up_and_give_the_same_rigs() {
    let folder = folder();
    let scenario = folder.path("field.toml");
    let bases = bases(&scenario);
    let field = field(&scenario, &bases);
    let tickets = || -> Vec<_> {
        let all = field.tickets().into_iter();
        all.filter(|ticket| ticket.kind == Kind::Injected).take(1).collect()
    };
    let keys = key_file(&field.seal(tickets(), "", &|| ()).expect("rigs"));
    // What is written counts, or the size would be searched for again.
    let size = |keys: &str| -> f64 {
        let key: serde_json::Value = serde_json::from_str(keys).expect("a key");
        key["fault"]["size"].as_f64().expect("a size")
    };
    let marked = keys.replace(&format!("\"size\":{}", size(&keys)), "\"size\":1.75");
    let again = |before: &str| field.seal(tickets(), before, &|| ()).expect("rigs");
    assert_eq!(size(&again(&marked)[0].key_line()), 1.75);
    // That of another rig does not.
    let foreign = marked.replacen("\"seed\":", "\"seed\":1", 1);
    assert_eq!(key_file(&again(&foreign)), keys);
}

#[test]
fn what_cannot_be_examined_is_refused_in_one_message() {
    let folder = folder();
    let run = |text: &str, arguments: &[&str]| {
        folder.write("field.toml", text);
        let arguments = [&["field.toml", "--out", "none"], arguments].concat();
        let output = folder.switchback(&arguments).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2));
        assert!(!folder.path("none").exists());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let reported = run(&FIELD.replace("[2.0]", "[1.0]"), &[]);
    assert!(reported.contains("field.toml:5:9") && reported.contains("no size reaches 2"), "{reported}");
    let reported = run(&FIELD.replace("gain_drift", "gain_drfit"), &[]);
    assert!(reported.contains("did you mean `gain_drift`?"), "{reported}");
    let reported = run(FIELD, &["--engine", "direct"]);
    assert!(reported.contains("has no engines"), "{reported}");
    let reported = run(&FIELD.replace("made = 2", "rigs = \"nowhere\"\nmade = 0"), &[]);
    assert!(reported.contains("NO MEASURED BASES: the folder nowhere exists neither"), "{reported}");
    assert!(reported.contains("nowhere: holds no measured rig"), "{reported}");
    // Rigs that were made are no measured ones, wherever they lie.
    folder.switchback(&["rig", "--seed", "3", "--out", "rigs/made-3"]).assert().success();
    let reported = run(&FIELD.replace("made = 2", "rigs = \"rigs\"\nmade = 0"), &[]);
    assert!(reported.contains("rigs: holds no measured rig"), "{reported}");
}

#[test]
fn a_slice_is_the_beginning_of_a_larger_one_and_has_the_measured_bases_it_needs() {
    let folder = folder();
    folder.switchback(&["rig", "--seed", "3", "--field", "--out", "rigs/press"]).assert().success();
    let designed = |slice: &str| {
        folder.write(
            "field.toml",
            &FIELD.replace("made = 2", "rigs = \"rigs\"\nmade = 2").replace("slice = 4", slice),
        );
        let study = read(&folder.path("field.toml")).expect("a scenario");
        Examination::new(study, &bases(&folder.path("field.toml"))).tickets()
    };
    let ids = |slice: &str| designed(slice).iter().map(|ticket| ticket.id).collect::<Vec<_>>();
    let whole = ids("");
    // Two effects in three bases, a measured base as it is and a made one without fault.
    assert_eq!(whole.len(), 2 * 3 + 2);
    assert!(!whole.is_sorted());
    for slice in 1..=whole.len() {
        let tickets = designed(&format!("slice = {}", 2 * slice));
        assert!(ids(&format!("slice = {}", 2 * slice)).starts_with(&whole[..slice]));
        let has = |of: &dyn Fn(&Ticket) -> bool| tickets.iter().any(of);
        assert!(
            !has(&|ticket| ticket.base == 0) || has(&|ticket| ticket.base == 0 && ticket.kind == Kind::Bare)
        );
    }
}

#[test]
fn the_shipped_scenarios_can_be_read() {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let full = read(&scenarios.join("field.toml")).expect("a scenario");
    let slice = read(&scenarios.join("field-slice.toml")).expect("a scenario");
    assert_eq!((full.slice, slice.slice, &full.effects), (None, Some(40), &slice.effects));
    assert!(!full.effects.contains(&"coloured_noise"));
}
