//! Input that is hostile, or only wrong: reported in the user's words, bounded, and never obeyed.

use crate::common::{BLIND, Folder, STUDY};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// Runs: the exit code, and what is reported.
fn run(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String) {
    let output = folder.switchback(arguments).output().expect("it runs");
    (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
}

#[track_caller]
fn refused(folder: &Folder, arguments: &[&str], reported: &[&str]) {
    let (code, message) = run(folder, arguments);
    println!("{message}");
    assert_eq!(code, Some(2), "{message}");
    assert!(message.starts_with("error: ") && message.contains("\nhelp: "), "{message}");
    for words in reported {
        assert!(message.contains(words), "`{words}` is not in:\n{message}");
    }
    assert!(message.len() < 1500, "{} bytes", message.len());
    for words in ["usize", "i64", "u64", "i128", "struct", "invalid type", "Wire", "panicked"] {
        assert!(!message.contains(words), "`{words}` is in:\n{message}");
    }
    assert!(!folder.path("out").exists(), "nothing is written");
}

/// A scenario with one line changed is refused.
#[track_caller]
fn refused_scenario(scenario: &str, (line, with): (&str, &str), reported: &[&str]) {
    let folder = Folder::with_good_rig();
    assert!(scenario.contains(line), "the scenario has no `{line}`");
    folder.write("a.toml", &scenario.replace(line, with));
    refused(&folder, &["a.toml", "--threads", "1", "--out", "out"], reported);
}

#[test]
fn sizes_beyond_sense_are_refused_with_the_limit() {
    const MAX: &str = "9223372036854775807";
    let study = |line: &str, with: &str, reported: &[&str]| refused_scenario(STUDY, (line, with), reported);
    study("[3]", &format!("[{MAX}]"), &["a.toml:17:11", "points", "1000 or less"]);
    study("1000]", &format!("{MAX}]"), &["a.toml:16:17", "samples", "100000000 or less"]);
    study("= 40", &format!("= {MAX}"), &["a.toml:4:14", "replicates", "1000000000 or less"]);
    let case = |key: &str| format!("[[case]]\nname = \"c\"\n{key} = {MAX}\n[sweep]");
    study("[sweep]", &case("spacing"), &["spacing", "1000000 or less"]);
    study("[sweep]", &case("order"), &["order", "20 or less"]);
    let blind = |line: &str, key: &str| {
        let with = format!("{key} = 1000000000000000");
        refused_scenario(BLIND, (line, &with), &["a.toml:", key, "1000000 or less"]);
    };
    blind("none = 2", "none");
    blind("pairs = 0", "pairs");
    blind("seeds = 1", "seeds");
    blind("outside = 0", "outside");
    blind("systems = 1", "systems");
    refused_scenario(BLIND, ("systems = 1", "systems = 1000000"), &["rigs in all", "1000000 or less"]);
}

const FIELD: &str = "study = \"field\"\nquestion = \"?\"\nseed = 1\nsizes = [2.0]\nseeds = 1\nmade = 1\nnone = 1\noutside = 0\n";

#[test]
fn a_field_examination_is_bounded_too() {
    let field = |line: &str, reported: &[&str]| {
        let key = line.split(' ').next().unwrap_or_default();
        refused_scenario(FIELD, (line, &format!("{key} = 1000000000000000")), reported);
    };
    field("made = 1", &["a.toml:6:8", "made", "5000 or less"]);
    field("none = 1", &["a.toml:7:8", "none", "5000 or less"]);
    field("seeds = 1", &["a.toml:5:9", "seeds", "1000000 or less"]);
    field("outside = 0", &["a.toml:8:11", "outside", "1000000 or less"]);
}

#[test]
fn more_than_a_day_is_reported_and_refused() {
    let long =
        |scenario: &str, line, with, reported| refused_scenario(scenario, (line, with), &[reported, "--yes"]);
    let years = STUDY.replace("1000]", "100000000]");
    long(&years, "= 40", "= 1000000000", "this would take about 4 years on 1 thread");
    // The error of a standard deviation needs 5e7 replicates: 1.4e-9 · 1e8 · 5e7 s.
    let precise = "= 40\nmax_replicates = 1000000000\nprecision = { sd_relative_mcse = 1e-4 }";
    long(&years, "= 40", precise, "this would take about 81 days on 1 thread");
    let rigs = BLIND.replace("slice = 1", "slice = 50000");
    long(&rigs, "none = 2", "none = 100000", "this would take about 3 days on 1 thread");
    let field = FIELD.replace("outside = 0", "outside = 0\nslice = 20000");
    long(&field, "seeds = 1", "seeds = 10000", "this would take about 3 days on 1 thread");
}

#[cfg(unix)]
#[test]
fn more_than_a_day_is_run_if_asked_for() {
    let folder = Folder::with_good_rig();
    folder.write("a.toml", &STUDY.replace("1000]", "10000000]").replace("= 40", "= 1000000000"));
    let mut process = Command::new(env!("CARGO_BIN_EXE_switchback"))
        .args(["a.toml", "--yes", "--threads", "1", "--out", "out"])
        .current_dir(folder.path("."))
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut reported = String::new();
    let read = BufReader::new(process.stderr.take().expect("piped")).read_line(&mut reported);
    let sent = Command::new("kill").args(["-INT", &process.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    assert_eq!(process.wait().expect("it ends").code(), Some(3), "{reported}");
    read.expect("UTF-8");
    assert_eq!(reported, "this takes about 162 days on 1 thread\n");
}

#[test]
fn messages_are_in_the_words_of_who_wrote_the_file() {
    let study = |line: &str, with: &str, reported: &str| {
        refused_scenario(STUDY, (line, with), &["a.toml:", reported])
    };
    let (whole, large) = ("expected a whole number, 0 or more", "99999999999999999999999");
    study("= 40", &format!("= {large}"), &format!("{whole}, found `{large}`"));
    study("= 40", "= \"x\"", whole);
    study("[3]", "3", "expected a list, found `3`");
    study(
        "interval = [-1.0, 1.0]",
        "interval = [-1.0, 0.0, 1.0]",
        "expected two numbers, [low, high], found 3 entries",
    );
    study("interval = [-1.0, 1.0]", "interval = 1.0", "expected a list, found `1.0`");
    let folder = Folder::with_good_rig();
    folder.replace_line("rig.toml", 8, "role = 4");
    refused(
        &folder,
        &["gap", "rig.toml"],
        &["rig.toml:8:8", "expected one of the names known here, as text"],
    );
    folder.replace_line("rig.toml", 8, "role = \"free\"");
    folder.replace_line("rig.toml", 3, &format!("order = {large}"));
    refused(
        &folder,
        &["gap", "rig.toml"],
        &["rig.toml:3:9", &format!("expected a whole number, found `{large}`")],
    );
}

#[test]
fn a_line_of_70000_letters_is_not_reported_whole() {
    let folder = Folder::with_good_rig();
    folder.replace_line("rig.toml", 3, &format!("order = \"{}\"", "x".repeat(70_000)));
    refused(&folder, &["gap", "rig.toml"], &["rig.toml:3:9", "…"]);
    folder.replace_line("rig.toml", 3, "order = 2");
    folder.replace_line("descendant.csv", 5, &format!("0.03,{},1", "x".repeat(70_000)));
    refused(&folder, &["gap", "rig.toml"], &["descendant.csv:5", "is not a number", "…"]);
}

#[test]
fn names_are_neither_markup_nor_formulas() {
    let folder = Folder::with_good_rig();
    let named = STUDY
        .replace("name = \"spring\"", "name = \"=1+<script>|`x`\"")
        .replace("question = \"Is it", "question = \"<script>\\u001B[2J Is it");
    folder.write("a`b.toml", &named);
    let output = folder.switchback(&["a`b.toml", "--out", "out"]).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b));
    let read = |name: &str| fs::read_to_string(folder.path("out").join(name)).expect("a report");
    let page = read("report.md");
    // Within the fenced table a name is text already.
    let outside: String = page.split("```").step_by(2).collect();
    assert!(!outside.contains("<script>") && !page.contains('\u{1b}'), "{page}");
    assert!(
        page.starts_with("# a\\`b\n") && page.contains("Made by `` switchback a`b.toml `` with"),
        "{page}"
    );
    assert!(read("table.csv").contains(",'=1+<script>|`x`,"));
    assert!(!read("table.csv").contains(",=1+"));
}

#[test]
fn control_characters_reach_neither_terminal_nor_picture() {
    let folder = Folder::with_good_rig();
    let labels = "order = 2\ninput = \"tra\\u001B[31mvel\\u0000 [mm]\"\noutput = \"for\\nce <&> [N]\"";
    folder.replace_line("rig.toml", 3, labels);
    let output = folder.switchback(&["identify", "rig.toml", "--out", "out"]).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for reported in [output.stdout, output.stderr] {
        assert!(
            !reported.contains(&0x1b) && !reported.contains(&0),
            "{}",
            String::from_utf8_lossy(&reported)
        );
    }
    let pictures =
        crate::common::listing(&folder.path("out")).into_iter().filter(|name| name.ends_with(".svg"));
    let mut labelled = 0;
    for name in pictures {
        let svg = fs::read_to_string(folder.path("out").join(&name)).expect("a picture");
        assert!(svg.chars().all(|c| !c.is_control() || c == '\n' || c == '\t'), "{name}");
        assert!(!svg.contains("<&>"), "{name}");
        labelled += usize::from(svg.contains("tra␛[31mvel␀"));
    }
    assert!(labelled > 0, "no picture has the label");
    folder.replace_line("rig.toml", 1, "name = \"a\\u001Bb\"");
    fs::remove_dir_all(folder.path("out")).expect("it is there");
    refused(&folder, &["gap", "rig.toml"], &["rig.toml:1:8", "control character"]);
    refused_scenario(STUDY, ("\"spring\"", "\"two\\nlines\""), &["a.toml:10:8", "control character"]);
}

#[test]
fn records_that_are_unlikely_are_reported_with_place_and_remedy() {
    let folder = Folder::with_good_rig();
    let reported = |folder: &Folder| {
        let (code, reported) = run(folder, &["init", "rig.toml"]);
        (code, reported)
    };
    let (code, plain) = reported(&folder);
    assert_eq!(code, Some(0), "{plain}");
    assert!(!plain.contains("warning"), "{plain}");

    fs::remove_file(folder.path("again.csv")).expect("it is there");
    fs::copy(folder.path("descendant.csv"), folder.path("again.csv")).expect("a copy");
    let (_, copied) = reported(&folder);
    assert!(copied.contains("warning: again.csv holds the same samples as descendant.csv"), "{copied}");

    folder.edit("rig.toml", |text| text.replace("[-1.0, 1.0]", "[-0.001, 0.001]"));
    let (_, outside) = reported(&folder);
    assert!(outside.contains("warning: descendant.csv:"), "{outside}");
    assert!(outside.contains("far outside the declared interval [-0.001, 0.001]"), "{outside}");

    let ramp = |k: usize| format!("{},{},{}\n", k as f64 / 100.0, k, (k * k) % 7);
    folder.write("ramp.csv", &("t,v,y\n".to_owned() + &(0..300).map(ramp).collect::<String>()));
    let (_, one_way) = run(&folder, &["init", "ramp.csv"]);
    assert!(one_way.contains("`v` only rises in all that is fitted"), "{one_way}");
    assert!(one_way.contains("fit to a record in which it falls too"), "{one_way}");
}

#[test]
fn a_diagnosis_takes_orders_up_to_the_highest() {
    let folder = Folder::with_good_rig();
    let noise = |t: usize| ((t as f64 * 12.9898).sin() * 43_758.545_3).fract() - 0.5;
    let record = |phase: f64| {
        let (mut text, mut y, mut before) = ("v,y\n".to_owned(), 0.0, 0.0);
        for t in 0..600 {
            let v = (0.17 * t as f64 + phase).sin() + 0.6 * (0.031 * t as f64).cos();
            y = 0.6 * y + 0.4 * (v + 0.3 * (v - before).signum()) + 0.02 * noise(t);
            before = v;
            text += &format!("{v},{y}\n");
        }
        text
    };
    folder.write("a.csv", &record(0.0));
    folder.write("b.csv", &record(1.0));
    for order in [12, 20] {
        let rig = format!(
            "name = \"high\"\nsample_time = 1.0\norder = {order}\n\
             [[record]]\nfile = \"a.csv\"\nrole = \"free\"\nuse = \"fit\"\n\
             [[record]]\nfile = \"b.csv\"\nrole = \"free\"\nuse = \"holdout\"\n"
        );
        folder.write("high.toml", &rig);
        let without: Vec<&str> = ["--without", "border_wear", "--without", "border_resolution"].to_vec();
        let (code, message) = run(&folder, &[&["gap", "high.toml", "--quiet"], &without[..]].concat());
        assert_eq!(code, Some(0), "order {order}: {message}");
    }
}

/// A record of a loop before one pole, `v,y` a line; `change` alters a sample by its number.
fn loop_record(samples: usize, phase: f64, change: impl Fn(usize, f64, f64) -> (f64, f64)) -> String {
    let noise = |t: usize| ((t as f64 * 12.9898 + phase).sin() * 43_758.545_3).fract() - 0.5;
    let (mut text, mut y, mut u, mut before) = ("v,y\n".to_owned(), 0.0, 0.0, 0.0);
    for t in 0..samples {
        let v = (0.17 * t as f64 + phase).sin() + 0.6 * (0.031 * t as f64).cos();
        y = 0.6 * y + 0.4 * u + 0.02 * noise(t);
        u = v + 0.3 * (v - before).signum();
        before = v;
        let (v, y) = change(t, v, y);
        text += &format!("{v},{y}\n");
    }
    text
}

const LOOP: &str = "name = \"loop\"\nsample_time = 1.0\norder = 1\n\
    [[record]]\nfile = \"a.csv\"\nrole = \"free\"\nuse = \"fit\"\n\
    [[record]]\nfile = \"b.csv\"\nrole = \"free\"\nuse = \"holdout\"\n";

#[test]
fn what_no_sensor_of_the_fit_records_can_have_read_shows_no_cause() {
    let folder = Folder::with_good_rig();
    folder.write("loop.toml", LOOP);
    folder.write("a.csv", &loop_record(600, 0.0, |_, v, y| (v, y)));
    for (record, signal) in [
        (loop_record(600, 1.0, |_, v, y| (v, 1e160 * y)), "y = "),
        (loop_record(600, 1.0, |t, v, y| (v, if t == 300 { 1e300 } else { y })), "y = 1e300 at sample 300"),
        (loop_record(600, 1.0, |t, v, y| (if t == 300 { -1e12 } else { v }, y)), "v = -1e12 at sample 300"),
    ] {
        folder.write("b.csv", &record);
        refused(&folder, &["gap", "loop.toml", "--quiet"], &["record \"b\"", signal, "correct its unit"]);
    }
    // The same in a fit record.
    folder.write("b.csv", &loop_record(600, 1.0, |_, v, y| (v, y)));
    folder.write("a.csv", &loop_record(600, 0.0, |t, v, y| (v, if t == 300 { -1e200 } else { y })));
    refused(&folder, &["gap", "loop.toml", "--quiet"], &["record \"a\"", "y = -1e200 at sample 300"]);
}

#[test]
fn an_outlier_of_the_input_is_reported_with_the_verdict() {
    let folder = Folder::with_good_rig();
    folder.write("loop.toml", LOOP);
    folder.write("a.csv", &loop_record(600, 0.0, |t, v, y| (if t == 300 { -9999.0 } else { v }, y)));
    folder.write("b.csv", &loop_record(600, 1.0, |_, v, y| (v, y)));
    let effects: Vec<&str> =
        ["border_wear", "border_resolution"].iter().flat_map(|e| ["--without", e]).collect();
    let arguments = [&["gap", "loop.toml", "--quiet", "--out", "out"], &effects[..]].concat();
    let (code, message) = run(&folder, &arguments);
    assert_eq!(code, Some(0), "{message}");
    let reported = fs::read_to_string(folder.path("out/gap.json")).expect("a report");
    assert!(reported.contains("a.csv:302: `v` is -9999"), "{reported}");
}

#[test]
fn a_sensor_that_stands_still_is_reported_with_rows_and_remedy() {
    let folder = Folder::with_good_rig();
    folder.write("loop.toml", LOOP);
    let good = loop_record(600, 0.0, |_, v, y| (v, y));
    let reported = |fit: &str, held_out: &str| {
        folder.write("a.csv", fit);
        folder.write("b.csv", held_out);
        let (code, reported) = run(&folder, &["init", "loop.toml"]);
        assert_eq!(code, Some(0), "{reported}");
        reported
    };
    assert!(
        !reported(&good, &loop_record(600, 1.0, |_, v, y| (v, y))).contains("warning"),
        "nothing stands still"
    );
    let stuck = |text: &str, signal: &str, from: usize, to: usize| {
        let words = format!("b.csv: `{signal}` stands still at 0.25 from line {from} to line {to}");
        assert!(text.contains(&words) && text.contains("check its sensor"), "{text}");
    };
    stuck(&reported(&good, &loop_record(600, 1.0, |_, v, _| (v, 0.25))), "y", 2, 601);
    stuck(&reported(&good, &loop_record(600, 1.0, |_, _, y| (0.25, y))), "v", 2, 601);
    let while_stuck = |t: usize| (200..400).contains(&t);
    let y = loop_record(600, 1.0, |t, v, y| (v, if while_stuck(t) { 0.25 } else { y }));
    stuck(&reported(&good, &y), "y", 202, 401);
    let v = loop_record(600, 1.0, |t, v, y| (if while_stuck(t) { 0.25 } else { v }, y));
    stuck(&reported(&good, &v), "v", 202, 401);
}

#[test]
fn short_records_and_records_without_noise_are_consistent_with_a_model_that_lacks_nothing() {
    let folder = Folder::with_good_rig();
    folder.write("loop.toml", LOOP);
    let exact = |samples: usize, phase: f64| {
        let (mut text, mut y, mut u) = ("v,y\n".to_owned(), 0.0, 0.0);
        let mut before: f64 = 0.0;
        for t in 0..samples {
            let v = (0.17 * t as f64 + phase).sin() + 0.6 * (0.031 * t as f64).cos();
            y = 0.6 * y + 0.4 * u;
            u = v + 0.3 * (v - before).signum();
            before = v;
            text += &format!("{v},{y}\n");
        }
        text
    };
    for (fit, held_out) in [
        (loop_record(110, 0.0, |_, v, y| (v, y)), loop_record(100, 1.0, |_, v, y| (v, y))),
        (exact(600, 0.0), exact(400, 1.0)),
    ] {
        folder.write("a.csv", &fit);
        folder.write("b.csv", &held_out);
        let output = folder.switchback(&["gap", "loop.toml", "--quiet", "--json"]).output().expect("it runs");
        let reported = String::from_utf8(output.stdout).expect("text");
        assert!(reported.contains("\"status\": \"none\""), "{reported}");
        let output = folder.switchback(&["gap", "loop.toml"]).output().expect("it runs");
        let reported = String::from_utf8(output.stdout).expect("text").replace('\n', " ");
        assert!(reported.contains("the records are consistent with it"), "{reported}");
    }
}

#[test]
fn texts_open_no_links_in_a_report() {
    let folder = Folder::with_good_rig();
    let links = "[x](javascript:alert(1)) ![y](http://a/b) <javascript:b> \\\\[z](c)";
    let text =
        STUDY.replace("\"Is it", &format!("\"{links} Is it")).replace("\"spring\"", "\"[s](javascript:d)\"");
    folder.write("a.toml", &text);
    assert_eq!(run(&folder, &["a.toml", "--out", "out", "--quiet"]).0, Some(0));
    let page = fs::read_to_string(folder.path("out/report.md")).expect("a report");
    let outside: String = page.split("```").step_by(2).collect();
    assert!(outside.contains("&#91;x](javascript:alert(1))"), "{outside}");
    for open in ["[x]", "[y]", "[z]", "[s]", "<javascript"] {
        assert!(!outside.contains(open), "{open}: {outside}");
    }
}

#[test]
fn numbers_far_from_one_have_an_exponent() {
    for (of_v, of_y) in [(1e150, 1.0), (1e-200, 1e120), (1.0, 1e-150)] {
        let folder = Folder::with_good_rig();
        folder.write("loop.toml", LOOP);
        for (name, phase) in [("a.csv", 0.0), ("b.csv", 1.0)] {
            folder.write(name, &loop_record(300, phase, |_, v, y| (of_v * v, of_y * y)));
        }
        let output = folder.switchback(&["identify", "loop.toml", "--out", "out"]).output().expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let mut texts = vec![("stdout".to_owned(), output.stdout), ("stderr".to_owned(), output.stderr)];
        let names = crate::common::listing(&folder.path("out"));
        texts.extend(names.into_iter().map(|name| {
            let bytes = fs::read(folder.path("out").join(&name)).expect("a file");
            (name, bytes)
        }));
        for (name, bytes) in texts {
            let longest = bytes.split(|byte| !byte.is_ascii_digit()).map(<[u8]>::len).max().unwrap_or(0);
            // A hash has sixty-four.
            assert!(longest < 65, "{name} has a number of {longest} digits");
        }
    }
}

#[test]
fn a_held_out_share_needs_no_use() {
    let folder = Folder::with_good_rig();
    folder.write(
        "loop.toml",
        "name = \"l\"\nsample_time = 1.0\norder = 1\n[[record]]\nfile = \"a.csv\"\nholdout = 0.3\n",
    );
    folder.write("a.csv", &loop_record(400, 0.0, |_, v, y| (v, y)));
    let output = folder.switchback(&["identify", "loop.toml", "--json"]).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(page["fit_percent"].as_object().map(|by_record| by_record.len()), Some(2), "{page:#}");
}
