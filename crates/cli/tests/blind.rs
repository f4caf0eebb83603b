//! The blind study, with examiners that are easy to foresee in place of the diagnosis.

use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use switchback_diagnose::{
    DiagnoseError, Diagnosis, Effect, Figure, Gap, Model, ResidualPicture, Settings, Status, Verdict,
};
use switchback_io::output::sha256;
use switchback_lab::examination::{
    Bases, Case, Design, Examination, Examiner, Expect, KEY_FILE, Kind, Sealed, Study, key_file, read,
};
use switchback_lab::generate::Plan;
use switchback_model::rig::Rig;
use switchback_report::examination::report;
use switchback_study::journal::{Journal, SEALED_FILE};

/// Effects put in.
const FIRST: [&str; 20] = [
    "input_delay",
    "input_noise",
    "backlash",
    "gradual_transition",
    "rate_dependence",
    "creep",
    "border_wear",
    "stribeck",
    "extra_pole",
    "resonance",
    "gain_drift",
    "coloured_noise",
    "output_noise",
    "outliers",
    "periodic_disturbance",
    "sensor_drift",
    "sensor_saturation",
    "sensor_quantisation",
    "sensor_nonlinearity",
    "border_resolution",
];

fn study() -> Study {
    Study {
        name: "small".to_owned(),
        question: "?".to_owned(),
        design: Design::Laboratory,
        seed: 5,
        systems: 2,
        sizes: vec![1.0],
        effects: FIRST.to_vec(),
        seeds: 2,
        none: 3,
        outside: 6,
        pairs: 3,
        slice: Some(30),
        plan: Plan { step: 120, periods: 8, sweep: 400, drive: 200, repeat_periods: 3 },
        expect: Expect::new(),
        rigs: None,
        folder: PathBuf::new(),
        made: 0,
        resampled: 0,
    }
}

/// The study by the program's own diagnosis.
fn examination(study: &Study) -> Examination<'static> {
    Examination::without_bases(study.clone())
}

fn sealed(study: &Study) -> Vec<Sealed> {
    let examination = examination(study);
    examination.seal(examination.tickets(), "", &|| ()).unwrap()
}

fn silent(status: Status) -> Diagnosis {
    let nothing = Figure { estimate: 0.0, ci90: [0.0, 0.0] };
    Diagnosis {
        differences: None,
        verdict: Verdict {
            status,
            effects: vec![],
            class: vec![],
            stage: None,
            probability: 0.9,
            calibrated: true,
            corrected_by: None,
            refit: None,
            held_out_error_ratio: None,
        },
        classification: None,
        gap: Gap {
            before: nothing,
            after: nothing,
            closure: None,
            noise_floor: 0.0,
            identified_anew: None,
            predictive_gain: 0.0,
            per_record: vec![],
        },
        where_: vec![],
        candidates: vec![],
        probability_none: 0.9,
        probability_unexplained: 0.1,
        left: 0.0,
        samples: 1,
        passes: 0,
        together: None,
        next_experiment: None,
        series: vec![],
        residuals_before: ResidualPicture::default(),
        residuals_after: ResidualPicture::default(),
        limitations: vec![],
        models: None,
        evidence: None,
    }
}

fn quiet(_: &Rig, _: Model, _: &Settings) -> Result<Diagnosis, DiagnoseError> {
    Ok(silent(Status::None))
}

fn examined(study: &Study, sealed: &[Sealed], examiner: Examiner) -> Vec<Case> {
    let bases = Bases::default();
    let examination = Examination::of(examiner, study.clone(), &bases);
    sealed.par_iter().map(|rig| examination.judge(rig).unwrap()).collect()
}

fn run(threads: usize) -> (String, BTreeMap<String, Vec<u8>>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let study = study();
        let sealed = sealed(&study);
        let key = key_file(&sealed);
        let cases = examined(&study, &sealed, quiet);
        let files = report(&examination(&study), &sha256(&key), &cases).files;
        (key, files.iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect())
    })
}

#[test]
fn key_and_report_are_the_same_at_any_thread_count() {
    assert_eq!(run(1), run(3));
}

#[test]
fn the_report_carries_the_hash_of_the_key() {
    let (key, files) = run(2);
    let results: serde_json::Value = serde_json::from_slice(&files["results.json"]).unwrap();
    assert_eq!(results["key_sha256"], sha256(&key));
    assert_eq!(key.lines().count(), 30);
}

#[test]
fn who_says_nothing_is_never_wrong_and_never_right() {
    let (_, files) = run(2);
    let results: serde_json::Value = serde_json::from_slice(&files["results.json"]).unwrap();
    let reached = |key: &str| {
        results["measures"].as_array().unwrap().iter().find(|m| m["key"] == key).unwrap()["reached"].clone()
    };
    assert_eq!(reached("exact"), 0.0);
    assert_eq!(reached("outside_named"), 0.0);
    assert!(reached("precision").is_null());
}

#[test]
fn an_examiner_sees_what_a_users_folder_holds_and_never_the_withheld_effect() {
    let mut study = study();
    study.slice = None;
    study.seeds = 0;
    let sealed = sealed(&study);
    let withheld: Vec<_> = sealed.iter().filter_map(|s| s.ticket().withheld).collect();
    assert_eq!(withheld.len(), 3);
    let watched = |rig: &Rig, model: Model, settings: &Settings| {
        assert!(rig.records.iter().all(|r| r.predicted.is_none()));
        assert!(!format!("{} {} {}", rig.name, rig.input_label, rig.output_label).contains('_'));
        assert!(matches!(model, Model::Identify));
        let all = Effect::ALL.len();
        assert!(settings.effects.len() >= all - 1);
        Ok(silent(if settings.effects.len() < all { Status::Unexplained } else { Status::None }))
    };
    let cases = examined(&study, &sealed, watched);
    let status = |case: &Case| case.answers[0].reply.status;
    let unexplained: Vec<&Case> = cases.iter().filter(|case| status(case) == "unexplained").collect();
    assert_eq!(unexplained.len(), 3);
    assert!(unexplained.iter().all(|case| case.kind == Kind::Outside));
}

#[test]
fn a_refused_rig_counts_as_failed() {
    let mut study = study();
    study.slice = Some(3);
    let sealed = sealed(&study);
    let refuse = |_: &Rig, _: Model, _: &Settings| Err(DiagnoseError::ConstantInput);
    let cases = examined(&study, &sealed, refuse);
    assert!(cases.iter().all(|case| case.answers[0].reply.status == "failed"));
    let scores = examination(&study).score(&cases);
    let reached = |key: &str| scores.measures.iter().find(|m| m.key == key).unwrap().reached;
    assert_eq!((scores.claims.count, reached("false_alarm").unwrap_or(0.0)), (0, 0.0));
}

fn keep(journal: &mut Journal<Case>, rigs: &[Sealed], cases: &[Case]) {
    rigs.iter().zip(cases).for_each(|(rig, case)| journal.keep(&rig.key_line(), case).unwrap());
}

#[test]
fn what_was_judged_is_taken_up_by_the_same_program_and_by_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let mut study = study();
    study.slice = Some(4);
    let sealed = sealed(&study);
    let cases = examined(&study, &sealed, quiet);
    let mut journal = Journal::<Case>::open(folder.path(), "one").unwrap();
    assert!(sealed.iter().all(|rig| journal.recall(&rig.key_line()).is_none()));
    keep(&mut journal, &sealed[..2], &cases[..2]);
    drop(journal);

    // Interrupted within a line, and taken up.
    let path = folder.path().join("unfinished.jsonl");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, &text[..text.len() - 9]).unwrap();
    let mut journal = Journal::<Case>::open(folder.path(), "one").unwrap();
    let known: Vec<_> = sealed.iter().map(|rig| journal.recall(&rig.key_line())).collect();
    assert_eq!(known, [Some(&cases[0]), None, None, None]);
    keep(&mut journal, &sealed[1..3], &cases[1..3]);
    drop(journal);

    let known = |program: &str| {
        let journal = Journal::<Case>::open(folder.path(), program).unwrap();
        sealed.iter().filter(|rig| journal.recall(&rig.key_line()).is_some()).count()
    };
    assert_eq!([known("one"), known("another")], [3, 0]);
    Journal::<Case>::open(folder.path(), "one").unwrap().close().unwrap();
    assert_eq!(known("one"), 0);
}

#[test]
fn keys_are_taken_up_by_the_program_that_sealed_them_and_by_no_other() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("new");
    let mut study = study();
    study.slice = Some(4);
    let file = key_file(&sealed(&study));
    assert!(Journal::<Case>::open(&folder, "one").unwrap().keys().is_empty());
    std::fs::write(folder.join(KEY_FILE), &file).unwrap();
    // Neither a file that nobody vouches for nor one that something else wrote.
    assert!(Journal::<Case>::open(&folder, "one").unwrap().keys().is_empty());
    std::fs::write(folder.join(SEALED_FILE), &file).unwrap();
    assert!(Journal::<Case>::open(&folder, "one").is_err());
    std::fs::remove_file(folder.join(SEALED_FILE)).unwrap();
    let is_known = |program: &str| !Journal::<Case>::open(&folder, program).unwrap().keys().is_empty();
    Journal::<Case>::open(&folder, "one").unwrap().keep_keys(&file).unwrap();
    assert_eq!([is_known("one"), is_known("another")], [true, false]);
    let keys = Journal::<Case>::open(&folder, "one").unwrap().keys();
    let examination = examination(&study);
    let again = examination.seal(examination.tickets(), &keys, &|| ()).unwrap();
    assert_eq!(key_file(&again), file);
    // A file that was changed since.
    std::fs::write(folder.join(SEALED_FILE), file.replacen("size", "sice", 1)).unwrap();
    assert!(!is_known("one"));
    Journal::<Case>::open(&folder, "one").unwrap().close().unwrap();
    assert!(!folder.join(SEALED_FILE).exists());
}

#[test]
fn a_sample_is_the_beginning_of_a_larger_one() {
    let ids = |slice: usize| {
        let study = Study { slice: Some(slice), ..study() };
        examination(&study).tickets().iter().map(|t| t.id).collect::<Vec<_>>()
    };
    assert_eq!(ids(9), ids(20)[..9]);
    assert!(!ids(20).is_sorted());
}

#[test]
fn the_shipped_scenarios_can_be_read_and_the_full_one_is_as_large_as_it_must_be() {
    let scenarios = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    let tickets = |name: &str| examination(&read(&scenarios.join(name)).unwrap()).tickets();
    let full = tickets("blind.toml");
    let count = |kind: Kind| full.iter().filter(|t| t.kind == kind).count();
    assert_eq!(count(Kind::Injected), 20 * 3 * 4 * 20);
    assert_eq!([Kind::Bare, Kind::Outside, Kind::Pair].map(count), [300, 300, 200]);
    assert_eq!(tickets("blind-slice.toml").len(), 100);
}
