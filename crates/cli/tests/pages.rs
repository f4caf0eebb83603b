//! `index.html` beside every report, and `switchback report`, as a user runs it.

use crate::common::{BLIND, Folder, STUDY, listing};
use std::fs;
use std::path::Path;
use switchback_io::input::gzip;
use switchback_io::output::sha256;
use switchback_study::results::{self, COMPRESSED, condensed};

/// Runs a command that must do its work.
fn done(folder: &Folder, arguments: &[&str]) {
    let output = folder.switchback(arguments).output().expect("it runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Runs a command that must be refused: exit code 2 and a message with every word.
fn refused(folder: &Folder, arguments: &[&str], words: &[&str]) {
    let output = folder.switchback(arguments).output().expect("it runs");
    let reported = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {reported}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    for word in words {
        assert!(reported.contains(word), "`{word}` is missing in: {reported}");
    }
}

fn page(folder: &Folder, report: &str) -> String {
    fs::read_to_string(folder.path(report).join("index.html")).expect("a page")
}

/// Every file of a folder with its hash.
fn bytes(folder: &Path) -> Vec<(String, String)> {
    let hash = |name: String| (name.clone(), sha256(fs::read(folder.join(&name)).expect("a file")));
    listing(folder).into_iter().map(hash).collect()
}

/// That a page is drawn again, byte for byte, once it is removed; that it is one file, that its parts have names of their own.
fn is_redrawn(folder: &Folder, report: &str, sections: &[&str]) {
    let (place, before) = (folder.path(report), page(folder, report));
    let all = bytes(&place);
    for section in sections {
        assert!(before.contains(&format!("<section id=\"{section}\"")), "{section} is missing in {report}");
    }
    let names = before.matches("\"http://www.w3.org/").count();
    assert_eq!(before.matches("://").count(), names, "a page fetches nothing");
    assert!(
        !before.contains("unsafe-inline") && !before.contains(" style="),
        "nothing runs but the page's own script"
    );
    let mut ids: Vec<&str> =
        before.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "ids are there once");
    assert!(!before.contains(&*place.to_string_lossy()), "no path of this machine");
    done(folder, &["report", report]);
    assert_eq!(bytes(&place), all, "drawn again it is the same");
    fs::remove_file(place.join("index.html")).expect("it was there");
    done(folder, &["report", report]);
    assert_eq!(bytes(&place), all, "drawn again it is the same though it was removed");
}

#[test]
fn a_study_has_a_page_that_is_drawn_again() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    done(&folder, &["study.toml", "--out", "out"]);
    let sections = ["verdicts", "curves", "borders", "cells", "unresolved", "made"];
    assert!(page(&folder, "out").contains("Is it consistent?"));
    is_redrawn(&folder, "out", &sections);
}

#[test]
fn a_diagnosis_has_a_page_that_is_drawn_again() {
    let folder = Folder::with_good_rig();
    done(&folder, &["gap", "rig.toml", "--out", "out"]);
    let html = page(&folder, "out");
    for stage in ["input", "operator", "dynamics", "disturbance", "sensor"] {
        assert!(html.contains(&format!("<h3>{stage}</h3>")), "{stage}");
    }
    assert!(html.contains("Loop of again") && html.contains("data-series=\"augmented, 95 % band\""));
    let sections =
        ["stages", "loop", "outputs", "where", "candidates", "closure", "residuals", "next", "model", "care"];
    is_redrawn(&folder, "out", &sections);
}

#[test]
fn an_identification_has_a_page_that_is_drawn_again() {
    let folder = Folder::with_good_rig();
    for method in ["efficient", "free"] {
        done(&folder, &["identify", "rig.toml", "--method", method, "--out", method]);
        let html = page(&folder, method);
        for chart in [
            "data-series=\"descending border (v falls)\"",
            "Loop of again",
            "Outputs of again",
            "Bode diagram, gain",
            "Step response",
            "Poles and zeros",
            "Autocorrelation",
        ] {
            assert!(html.contains(chart), "{method}: {chart}");
        }
        let sections =
            ["fit", "borders", "loop", "outputs", "coefficients", "linear", "residuals", "others", "model"];
        is_redrawn(&folder, method, &sections);
    }
}

#[test]
fn an_examination_has_a_page_that_is_drawn_again() {
    let folder = Folder::with_good_rig();
    folder.write("blind.toml", BLIND);
    let output = folder.switchback(&["blind.toml", "--out", "out"]).output().expect("it runs");
    assert!(output.status.code().is_some_and(|code| code < 2), "{}", String::from_utf8_lossy(&output.stderr));
    is_redrawn(&folder, "out", &["measures", "confusion", "calibration", "rules", "made"]);
}

#[test]
fn what_is_no_report_is_refused() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    done(&folder, &["study.toml", "--out", "study"]);
    done(&folder, &["gap", "rig.toml", "--out", "gap"]);
    refused(&folder, &["report", "nowhere"], &["nowhere: there is no such folder", "--out"]);
    refused(&folder, &["report", "study/results.json"], &["this is a file", "the folder that it lies in"]);
    fs::create_dir(folder.path("empty")).expect("a folder");
    refused(&folder, &["report", "empty"], &["empty: there is no report in this folder"]);
    assert_eq!(listing(&folder.path("empty")), [""; 0], "nothing is written");
    // Two reports in one folder.
    fs::copy(folder.path("gap/gap.json"), folder.path("study/gap.json")).expect("a copy");
    refused(
        &folder,
        &["report", "study"],
        &["the results of a study and a diagnosis", "a folder of its own"],
    );
    fs::remove_file(folder.path("study/gap.json")).expect("it was there");
    // A file that was changed since, and one of another run where nothing says what belongs together.
    let text = fs::read_to_string(folder.path("gap/augmented.json")).expect("a model");
    folder.write("gap/augmented.json", &text.replace("\"rig\": \"small\"", "\"rig\": \"other\""));
    refused(&folder, &["report", "gap"], &["augmented.json has changed"]);
    fs::remove_file(folder.path("gap/.switchback.sha256")).expect("a list");
    refused(&folder, &["report", "gap"], &["gap.json is of small, but augmented.json of other"]);
    folder.write("gap/augmented.json", &text);
}

#[test]
fn other_formats_and_foreign_figures_are_refused() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", STUDY);
    done(&folder, &["study.toml", "--out", "study"]);
    done(&folder, &["gap", "rig.toml", "--out", "gap"]);
    for report in ["gap", "study"] {
        fs::remove_file(folder.path(report).join(".switchback.sha256")).expect("a list");
    }
    let changed = |file: &str, from: &str, to: &str, words: &[&str]| {
        let text = fs::read_to_string(folder.path(file)).expect("a file");
        assert!(text.contains(from), "{from} is not in {file}");
        folder.write(file, &text.replacen(from, to, 1));
        refused(&folder, &["report", file.split('/').next().expect("a folder"), "--force"], words);
        folder.write(file, &text);
    };
    changed(
        "gap/gap.json",
        "switchback/gap/1",
        "switchback/gap/0",
        &["gap.json", "`switchback/gap/0`", "`switchback/gap/1`"],
    );
    changed("gap/gap.json", "\"rig\": \"small\"", "\"rig\": 3", &["gap.json:3", "`rig`"]);
    changed("gap/gap.json", "{", "", &["gap.json:2", "no JSON"]);
    changed("gap/series.csv", ",nominal_band,augmented_band", "", &["series.csv:1", "runs and their bands"]);
    changed(
        "gap/augmented.json",
        "switchback/model/1",
        "switchback/model/7",
        &["augmented.json", "switchback/model/7"],
    );
    changed(
        "gap/where.svg",
        "<rect",
        "<script>alert(1)</script><rect",
        &["where.svg: is no drawing of this program", "an element `script`"],
    );
    for (attack, why) in [
        ("<svg/onload=\"document.title='PWNED'\" width=\"9\" height=\"9\"></svg>", "it is no XML"),
        ("<svg a=\">\" onload=\"document.title='PWNED'\" width=\"9\" height=\"9\"></svg>", "element `svg`"),
        (
            "<svg a=\"'\" onload=document.title=`PWNED` b=\"'\" width=\"9\" height=\"9\"></svg>",
            "it is no XML",
        ),
    ] {
        let drawn = fs::read_to_string(folder.path("gap/where.svg")).expect("a figure");
        folder.write("gap/where.svg", attack);
        refused(&folder, &["report", "gap", "--force"], &["where.svg: is no drawing of this program", why]);
        folder.write("gap/where.svg", &drawn);
    }
    changed("study/results.json", "\"schema\":1", "\"schema\":99", &["results layout 99"]);
    fs::remove_file(folder.path("gap/series.csv")).expect("it was there");
    refused(&folder, &["report", "gap"], &["gap: series.csv is missing"]);
    // A page of somebody else stays.
    folder.write("study/index.html", "mine");
    refused(&folder, &["report", "study"], &["index.html"]);
    assert_eq!(fs::read_to_string(folder.path("study/index.html")).expect("it is there"), "mine");
}

/// A folder `kept` with nothing but the condensed table of a study in it; the bytes of that.
fn condensed_study(folder: &Folder) -> Vec<u8> {
    folder.write("study.toml", STUDY);
    done(folder, &["study.toml", "--out", "study"]);
    let results = results::read(&folder.path("study")).expect("results");
    let compressed = gzip::compressed(&condensed::to_json(&results));
    fs::create_dir(folder.path("kept")).expect("a folder");
    fs::write(folder.path("kept").join(COMPRESSED), &compressed).expect("it can be written");
    compressed
}

#[test]
fn a_condensed_study_is_compared_replayed_and_drawn_into_another_folder() {
    let folder = Folder::with_good_rig();
    condensed_study(&folder);
    done(&folder, &["compare", "kept", "study"]);
    done(&folder, &["compare", "study", "kept/results.json.gz"]);
    done(&folder, &["replay", "kept", "0:3"]);
    refused(&folder, &["report", "kept"], &["kept: holds figures rounded to 3 significant digits", "--out"]);
    assert_eq!(listing(&folder.path("kept")), [COMPRESSED], "nothing is written");
    done(&folder, &["report", "kept", "--out", "drawn"]);
    let text = fs::read_to_string(folder.path("drawn/report.md")).expect("a report");
    assert!(text.contains("ROUNDED: figures have 3 significant digits"), "{text}");
    assert!(page(&folder, "drawn").contains("ROUNDED: figures have 3 significant digits"));
    for file in ["results.json", "table.csv", "bias-efficient.svg", "borders-efficient.svg", "zip.svg"] {
        assert!(folder.path("drawn").join(file).is_file(), "{file}");
    }
    done(&folder, &["compare", "drawn", "study"]);
}

#[test]
fn a_condensed_study_that_is_cut_off_is_refused() {
    let folder = Folder::with_good_rig();
    let whole = condensed_study(&folder);
    fs::write(folder.path("kept").join(COMPRESSED), &whole[..whole.len() / 2]).expect("it can be written");
    let words = ["results.json.gz: is cut off or damaged", "beyond byte", "copy the file again"];
    refused(&folder, &["compare", "kept", "study"], &words);
    refused(&folder, &["replay", "kept", "0:3"], &words);
    refused(&folder, &["report", "kept", "--out", "drawn"], &words);
    assert!(!folder.path("drawn").exists());
}

#[test]
fn names_are_text_on_a_page() {
    let folder = Folder::with_good_rig();
    folder.write("study.toml", &STUDY.replace("name = \"spring\"", "name = \"<script>alert(1)</script>\""));
    done(&folder, &["study.toml", "--out", "study"]);
    folder.replace_line(
        "rig.toml",
        1,
        "name = \"<script>alert(1)</script>\"\ninput = \"v <b> [mm]\"\noutput = \"javascript: onload=1 [N]\"",
    );
    done(&folder, &["gap", "rig.toml", "--out", "gap"]);
    done(&folder, &["identify", "rig.toml", "--out", "identify"]);
    for report in ["study", "gap", "identify"] {
        let html = page(&folder, report);
        assert_eq!(html.matches("<script>").count(), 1, "{report}: only the page's own script");
        assert!(html.contains("&lt;script&gt;alert(1)"), "{report}");
        assert!(!html.contains("<b>"), "{report}");
    }
}
