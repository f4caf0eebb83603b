//! The schemas in `docs/schemas` are those of the types that are serialised, every JSON object that the program writes is what its schema
//! says, and no schema allows a key that it does not describe.

use crate::common::{BLIND, Folder, STUDY};
use crate::foreign::study;
use jsonschema::Validator;
use schemars::Schema;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use switchback_diagnose::Status;
use switchback_io::output::schema_text;
use switchback_lab::selftest::{Figure, Finding, json as selftest_json};
use switchback_study::foreign::Answer;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// The schemas by their title, as they are written.
fn schemas() -> BTreeMap<String, Value> {
    let files = fs::read_dir(root().join("docs/schemas")).expect("docs/schemas");
    let schema = |path: PathBuf| {
        let schema = parsed(&fs::read_to_string(&path).expect("a schema"));
        let title = schema["title"].as_str().expect("a title").to_owned();
        assert!(path.ends_with(file_name(&title)), "{} holds {title}", path.display());
        (title, schema)
    };
    files.map(|file| schema(file.expect("a readable entry").path())).collect()
}

/// The file of a schema.
fn file_name(title: &str) -> String {
    title.replace("switchback/", "").replace('/', "-") + ".json"
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("one JSON object")
}

/// The validators of all schemas.
struct Layouts(BTreeMap<String, Validator>);

impl Layouts {
    fn read() -> Self {
        let validator =
            |schema: &Value| jsonschema::draft202012::new(schema).expect("a schema of draft 2020-12");
        Self(schemas().iter().map(|(title, schema)| (title.clone(), validator(schema))).collect())
    }

    /// What of an object its schema does not allow; `from` is where it comes from.
    fn complaints(&self, Written { from, layout, object }: &Written) -> Vec<String> {
        let Some(validator) = self.0.get(layout) else { return vec![format!("{from}: no schema {layout}")] };
        let reported = |wrong: jsonschema::ValidationError<'_>| {
            format!("{from} ({layout}){}: {wrong}", wrong.instance_path())
        };
        validator.iter_errors(object).take(3).map(reported).collect()
    }
}

/// An object that the program wrote.
struct Written {
    from: String,
    /// The title of its schema.
    layout: String,
    object: Value,
}

impl Written {
    /// One that says what it is.
    fn of(from: impl Into<String>, text: &str) -> Self {
        let object = parsed(text);
        let layout = match &object["schema"] {
            Value::String(layout) => layout.clone(),
            Value::Number(version) => format!("switchback/results/{version}"),
            _ => String::new(),
        };
        Self { from: from.into(), layout, object }
    }

    /// The lines of a file, whose kind its folder shows.
    fn lines(path: &Path, layout: &str) -> Vec<Self> {
        let text = fs::read_to_string(path).expect("a readable file");
        let line =
            |line| Self { from: path.display().to_string(), layout: layout.to_owned(), object: parsed(line) };
        text.lines().map(line).collect()
    }

    /// All objects in the folder of a report.
    fn in_report(folder: &Path) -> Vec<Self> {
        let mut written = Vec::new();
        let files: Vec<PathBuf> = fs::read_dir(folder)
            .expect("a folder")
            .map(|file| file.expect("a readable entry").path())
            .collect();
        for path in files.iter().filter(|path| path.extension().is_some_and(|ending| ending == "json")) {
            written.push(Self::of(path.display().to_string(), &fs::read_to_string(path).expect("a file")));
        }
        let kind = written
            .iter()
            .find_map(|w| w.object["study"].as_str().map(str::to_owned))
            .unwrap_or("blind".to_owned());
        for (file, layout) in [("key.jsonl", format!("{kind}-key")), ("cases.jsonl", "case".to_owned())] {
            if folder.join(file).is_file() {
                written.extend(Self::lines(&folder.join(file), &format!("switchback/{layout}/1")));
            }
        }
        written
    }
}

/// Fails where an object is not what its schema says.
fn check(written: &[Written]) {
    let layouts = Layouts::read();
    let wrong: Vec<String> = written.iter().flat_map(|one| layouts.complaints(one)).collect();
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

/// This schema is kept by hand.
#[test]
fn a_case_may_have_every_answer() {
    let schema = &schemas()["switchback/case/1"];
    let names = &schema["$defs"]["reply"]["properties"]["status"]["enum"];
    let known: BTreeSet<&str> = names.as_array().expect("names").iter().filter_map(Value::as_str).collect();
    assert_eq!(known, Status::ALL.into_iter().map(Status::name).chain(["failed"]).collect());
}

/// What a command prints.
fn printed(folder: &Folder, arguments: &[&str]) -> Written {
    let output = folder.switchback(arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {reported}");
    Written::of(arguments.join(" "), &String::from_utf8_lossy(&output.stdout))
}

/// Runs a command that prints a JSON object and writes a folder.
fn printed_and_written(folder: &Folder, arguments: &[&str], out: &str) -> Vec<Written> {
    let arguments = [arguments, &["--json", "--quiet", "--out", out]].concat();
    let printed = printed(folder, &arguments);
    let path = folder.path(out);
    let mut written = if path.is_dir() { Written::in_report(&path) } else { Vec::new() };
    written.push(printed);
    written
}

fn identifications() -> Vec<Written> {
    let folder = Folder::with_good_rig();
    let methods = ["efficient", "free", "memoryless", "linear-arx"];
    let identify =
        |method: &str| printed_and_written(&folder, &["identify", "rig.toml", "--method", method], method);
    let mut written: Vec<Written> = methods.into_iter().flat_map(identify).collect();
    written.push(printed(&folder, &["simulate", "free/model.json", "again.csv", "--json"]));
    written.push(printed(&folder, &["design", "--from", "rig.toml", "--precision", "1%", "--json"]));
    written
}

fn diagnoses() -> Vec<Written> {
    let folder = Folder::with_good_rig();
    let bench = root().join("scenarios/data/bench.csv").display().to_string();
    let mut written = printed_and_written(&folder, &["gap", &bench], "bench");
    written.extend(printed_and_written(&folder, &["gap", "rig.toml"], "small"));
    written.push(printed(
        &folder,
        &["gap", "rig.toml", "--power", "--effects", "sensor_saturation", "--draws", "1", "--json"],
    ));
    written
}

/// Models with one effect of each form that a model file knows, all others left out of the search.
fn models() -> Vec<Written> {
    let effects = [
        "input_delay",
        "input_noise",
        "gradual_transition",
        "rate_dependence",
        "creep",
        "border_wear",
        "stribeck",
        "extra_pole",
        "gain_drift",
        "coloured_noise",
        "outliers",
        "periodic_disturbance",
        "sensor_drift",
        "sensor_saturation",
        "sensor_quantisation",
        "sensor_nonlinearity",
    ];
    let folder = Folder::with_good_rig();
    let mut written = Vec::new();
    for effect in effects {
        let made = format!("made-{effect}");
        written.push(printed(
            &folder,
            &["rig", "--order", "1", "--effect", effect, "--size", "3", "--out", &made, "--json"],
        ));
        let others = switchback_diagnose::Effect::ALL
            .map(switchback_diagnose::Effect::name)
            .into_iter()
            .filter(|other| *other != effect);
        let without: Vec<&str> = others.flat_map(|other| ["--without", other]).collect();
        let rig = format!("{made}/rig.toml");
        let gap = [&["gap", rig.as_str()], &without[..]].concat();
        written.extend(printed_and_written(&folder, &gap, effect));
    }
    written
}

fn studies() -> Vec<Written> {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    folder.write("blind.toml", BLIND);
    for (scenario, out, more) in
        [("study.toml", "study", ""), ("study.toml", "part", "1/2"), ("blind.toml", "judged", "1/1")]
    {
        let shard: &[&str] = if more.is_empty() { &[] } else { &["--shard", more] };
        let arguments = [&[scenario, "--quiet", "--out", out], shard].concat();
        let status = folder.switchback(&arguments).output().expect("it runs").status.code();
        assert!(matches!(status, Some(0 | 1)), "{arguments:?}");
    }
    let mut written: Vec<Written> = ["study", "part", "judged"]
        .into_iter()
        .flat_map(|out| Written::in_report(&folder.path(out)))
        .collect();
    written.push(printed(&folder, &["replay", "study", "0:3", "--json"]));
    written.push(printed(&folder, &["compare", "study", "study", "--json"]));
    let bench = ["bench", "study.toml", "joint", "memoryless", "--history", "kept.jsonl", "--label", "v1"];
    written.extend(printed_and_written(&folder, &bench, "bench"));
    written.extend(Written::lines(&folder.path("kept.jsonl"), "switchback/bench-history/1"));
    written
}

/// Both sides of a conversation with a method of others, and the study that came out.
fn conversations() -> Vec<Written> {
    let folder = Folder::with_good_rig();
    let program = env!("CARGO_BIN_EXE_switchback");
    folder.write("listen.sh", &format!("tee requests | '{program}' method joint | tee answers\n"));
    folder.write("study.toml", &study(&["sh", "listen.sh"], "workers = 1"));
    let output = folder.switchback(&["study.toml", "--quiet", "--out", "study"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let mut written = Written::in_report(&folder.path("study"));
    for (file, kind) in [("requests", "request"), ("answers", "answer")] {
        let mut lines = Written::lines(&folder.path(file), &format!("switchback/method-{kind}/1"));
        assert!(lines.len() > 40, "{file} holds {} lines", lines.len());
        lines[0].layout = "switchback/method-greeting/1".to_owned();
        written.extend(lines);
    }
    let failed = Answer { id: 7, estimate: None, se: None, failed: Some("singular".to_owned()) };
    let object = serde_json::to_value(&failed).expect("JSON");
    written.push(Written {
        from: "a failure".to_owned(),
        layout: "switchback/method-answer/1".to_owned(),
        object,
    });
    written
}

fn the_rest() -> Vec<Written> {
    let folder = Folder::with_good_rig();
    let design = [
        "design",
        "--order",
        "2",
        "--points",
        "4",
        "--interval",
        "-1,1",
        "--rate",
        "100",
        "--out",
        "plan",
        "--json",
    ];
    let failed = Finding {
        check: "noise",
        wrong: "it is not white",
        figures: Ok(vec![Figure::at_most("apart", 2.0, 1.0)]),
    };
    let refused = Finding { check: "coverage", wrong: "-", figures: Err("no estimate".to_owned()) };
    vec![
        printed(&folder, &design),
        printed(&folder, &["rig", "--list", "--json"]),
        printed(
            &folder,
            &[
                "plant",
                "rig.toml",
                "--effect",
                "output_noise",
                "--size",
                "2",
                "--out",
                "planted",
                "--json",
                "--quiet",
            ],
        ),
        Written::of("selftest", &selftest_json(&[failed, refused], 3)),
    ]
}

/// The reports of the repository, but for that of the benchmarks in other tools.
fn committed() -> Vec<Written> {
    let folders = fs::read_dir(root().join("reports")).expect("reports/");
    let folders = folders.map(|folder| folder.expect("a readable entry").path());
    folders
        .filter(|folder| !folder.ends_with("speed"))
        .flat_map(|folder| Written::in_report(&folder))
        .collect()
}

/// Set to write the schemas anew.
const WRITE: &str = "SWITCHBACK_WRITE_SCHEMAS";

#[test]
fn schemas_are_those_of_the_types() {
    let folder = Folder::with_good_rig();
    let output = folder.switchback(&["schemas"]).output().expect("it runs");
    let all: Vec<Schema> = serde_json::from_slice(&output.stdout).expect("a list of schemas");
    for schema in all {
        let title = schema.get("title").and_then(Value::as_str).expect("a title");
        let (path, text) = (root().join("docs/schemas").join(file_name(title)), schema_text(&schema));
        if std::env::var_os(WRITE).is_some() {
            fs::write(&path, &text).expect("it can be written");
        }
        let committed = fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == text, "{} differs from its type; {WRITE}=1 writes it anew", path.display());
    }
}

#[test]
fn whatever_is_written_is_what_its_schema_says() {
    let makers = [identifications, diagnoses, models, studies, conversations, the_rest, committed];
    let written: Vec<Written> = thread::scope(|scope| {
        let runs = makers.map(|make| scope.spawn(make));
        runs.into_iter().flat_map(|run| run.join().expect("it does not panic")).collect()
    });
    check(&written);
    let tried: BTreeSet<&str> = written.iter().map(|one| one.layout.as_str()).collect();
    let all = schemas();
    let all: BTreeSet<&str> = all.keys().map(String::as_str).collect();
    assert_eq!(tried, all, "schemas that nothing was held against, or the reverse");
}

/// Every object below a schema that lists keys.
fn objects<'a>(schema: &'a Value, found: &mut Vec<&'a Value>) {
    if schema["properties"].is_object() {
        found.push(schema);
    }
    match schema {
        Value::Object(fields) => fields.values().for_each(|value| objects(value, found)),
        Value::Array(list) => list.iter().for_each(|value| objects(value, found)),
        _ => {}
    }
}

#[test]
fn no_schema_allows_a_key_that_it_does_not_describe() {
    for (title, schema) in schemas() {
        let mut found = Vec::new();
        objects(&schema, &mut found);
        // The condition on parts of a study and of an examination only says which keys go together.
        let open = found
            .iter()
            .filter(|object| object["additionalProperties"] != false && object.get("type").is_some());
        assert_eq!(open.count(), 0, "{title}");
        assert!(schema["description"].is_string(), "{title}");
        assert!(!schema.to_string().contains("[`"), "{title}: a link to the source in a description");
    }
}

#[test]
fn a_key_too_many_and_one_too_few_are_seen() {
    let layouts = Layouts::read();
    let text = fs::read_to_string(root().join("reports/quick/results.json")).expect("the results");
    let good = Written::of("quick", &text);
    assert!(layouts.complaints(&good).is_empty());
    let spoilt: [fn(&mut Value); 4] = [
        |page| page["cells"][0]["colour"] = 1.into(),
        |page| drop(page.as_object_mut().and_then(|fields| fields.remove("seed"))),
        |page| page["cells"][0]["parameters"][0]["sd"] = "0.1".into(),
        |page| page["summaries"][0]["verdict"] = "perhaps".into(),
    ];
    for (k, spoil) in spoilt.into_iter().enumerate() {
        let mut bad = Written::of("quick", &text);
        spoil(&mut bad.object);
        assert_eq!(layouts.complaints(&bad).len(), 1, "{k}");
    }
}
