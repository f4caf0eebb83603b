//! One replicate alone.

use crate::common::{Folder, STUDY, listing};
use serde_json::Value;
use std::fs;

fn run(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = folder.switchback(arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

fn study(methods: &str) -> Folder {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &STUDY.replace("[\"efficient\"]", methods).replace("40", "12"));
    let (code, _, reported) = run(&folder, &["study.toml", "--quiet", "--out", "out"]);
    assert_eq!(code, Some(0), "{reported}");
    folder
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn replicates_alone_are_those_of_the_study() {
    let folder = study("[\"efficient\", \"joint\", \"free\"]");
    let results = json(&fs::read_to_string(folder.path("out/results.json")).expect("results"));
    let cells = results["cells"].as_array().expect("cells");
    let mut sums: Vec<Vec<f64>> = vec![Vec::new(); cells.len()];
    for replicate in 0..12 {
        let (code, page, reported) = run(&folder, &["replay", "out", &replicate.to_string(), "--json"]);
        assert_eq!(code, Some(0), "{reported}");
        let page = json(&page);
        assert_eq!(page["cells"].as_array().expect("cells").len(), cells.len());
        for (sums, cell) in sums.iter_mut().zip(page["cells"].as_array().expect("cells")) {
            let errors = cell["parameters"].as_array().expect("parameters").iter();
            let errors: Vec<f64> = errors.map(|p| p["error"].as_f64().expect("a number")).collect();
            sums.resize(errors.len(), 0.0);
            sums.iter_mut().zip(&errors).for_each(|(sum, error)| *sum += error);
        }
    }
    for (cell, sums) in cells.iter().zip(&sums) {
        for (parameter, sum) in cell["parameters"].as_array().expect("parameters").iter().zip(sums) {
            let number = |key: &str| parameter[key].as_f64().expect("a number");
            let off = number("mean_estimate") - number("truth") - sum / 12.0;
            assert!(off.abs() < 1e-12, "{parameter}: {sum}");
        }
    }
}

#[test]
fn a_replicate_is_reported_and_its_records_are_written() {
    let folder = study("[\"efficient\", \"free\"]");
    let (code, reported, _) = run(&folder, &["replay", "out/results.json", "0:3", "--out", "records"]);
    assert_eq!(code, Some(0));
    assert!(reported.contains("replicate 3 of ") && reported.contains("F_desc(V3)"), "{reported}");
    assert_eq!(listing(&folder.path("records")), [".switchback.sha256", "ascendant.csv", "descendant.csv"]);
    // The same noise at each N, longer.
    let short = fs::read_to_string(folder.path("records/ascendant.csv")).expect("a record");
    let cells = json(&run(&folder, &["replay", "out", "3", "--json"]).1);
    let of = |method: &str, samples: u64| {
        let is_it = |cell: &&Value| cell["method"] == method && cell["samples"] == samples;
        cells["cells"].as_array().expect("cells").iter().find(is_it).expect("a cell")["cell"].to_string()
    };
    let id = format!("{}:3", of("efficient", 1000));
    assert_eq!(run(&folder, &["replay", "out", &id, "--quiet", "--out", "long"]).0, Some(0));
    let long = fs::read_to_string(folder.path("long/ascendant.csv")).expect("a record");
    assert!(long.starts_with(&short) && long.lines().count() == short.lines().count() + 800);
    // What the method saw gives its estimate again.
    let id = format!("{}:3", of("free", 1000));
    assert_eq!(run(&folder, &["replay", "out", &id, "--quiet", "--out", "free"]).0, Some(0));
    assert_eq!(listing(&folder.path("free")), [".switchback.sha256", "record.csv"]);
}

#[test]
fn what_cannot_be_replayed_is_reported() {
    let folder = study("[\"efficient\"]");
    let refused = |arguments: &[&str], words: &str| {
        let (code, _, reported) = run(&folder, arguments);
        assert_eq!(code, Some(2), "{reported}");
        assert!(reported.contains(words), "`{words}` is missing in: {reported}");
    };
    refused(&["replay", "out", "99:0"], "99:0: the results have 2 cells, counted from 0");
    refused(&["replay", "out", "0:12"], "0:12: the study has 12 replicates, counted from 0");
    refused(&["replay", "out", "12"], "12: the study has 12 replicates, counted from 0");
    refused(&["replay", "out", "first"], "write CELL:REPLICATE as in 17:118");
    refused(&["replay", "out", "3", "--out", "x"], "name the cell too, as in 0:3");
    refused(&["replay", "none", "3"], "none");
}
