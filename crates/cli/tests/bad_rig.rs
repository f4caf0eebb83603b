//! Everything that can be wrong with a rig: one clear message with file, place and remedy, exit code 2, nothing written.

use crate::common::Folder;
use std::fs;

/// Spoils a good rig, identifies it with an output folder, and checks what is said and that nothing is left behind.
#[track_caller]
fn refused(spoil: impl Fn(&Folder), reported: &[&str]) {
    let folder = Folder::with_good_rig();
    spoil(&folder);
    let before = folder.listing();
    let output = folder.switchback(&["identify", "rig.toml", "--out", "report"]).output().expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(output.stdout.is_empty(), "nothing is printed on stdout");
    assert!(stderr.starts_with("error: ") && stderr.contains("\nhelp: "), "{stderr}");
    assert_eq!(stderr.matches("error: ").count(), 1, "one message: {stderr}");
    for text in reported {
        assert!(stderr.contains(text), "`{text}` is not in:\n{stderr}");
    }
    assert_eq!(folder.listing(), before, "nothing is written");
}

#[track_caller]
fn refused_rig(line: usize, with: &str, reported: &[&str]) {
    refused(|folder| folder.replace_line("rig.toml", line, with), reported);
}

#[track_caller]
fn refused_row(line: usize, with: &str, reported: &[&str]) {
    refused(|folder| folder.replace_line("descendant.csv", line, with), reported);
}

#[test]
fn an_unknown_key_is_named_with_what_was_meant() {
    refused_rig(
        3,
        "oder = 2",
        &["rig.toml:3:1: unknown key `oder`", "3 | oder = 2", "did you mean `order`?"],
    );
    refused_rig(8, "rule = \"free\"", &["rig.toml:8:1: unknown key `rule`", "did you mean `role`?"]);
}

#[test]
fn a_missing_key_is_named() {
    refused_rig(1, "", &["rig.toml:1:1", "missing key `name`", "add `name = …`"]);
    refused_rig(9, "", &["rig.toml:6:", "missing key `use`", "add `use = …`"]);
    // A `role` beside it is no misspelt `file`.
    refused_rig(7, "", &["rig.toml:6:", "missing key `file`", "add `file = …`"]);
}

#[test]
fn a_value_of_the_wrong_type_is_shown() {
    refused_rig(2, "sample_time = \"fast\"", &["rig.toml:2:15", "\"fast\"", "expected a number"]);
    refused_rig(3, "order = 2.5", &["rig.toml:3:9", "2.5", "expected a whole number"]);
    refused_rig(4, "interval = [-1, 0, 1]", &["rig.toml:4:12", "3 numbers", "[h_m, h_M]"]);
}

#[test]
fn impossible_values_are_refused() {
    refused_rig(1, "name = \" \"", &["rig.toml:1:8", "`name` is empty"]);
    for bad in ["0", "-0.01", "nan", "inf"] {
        refused_rig(
            2,
            &format!("sample_time = {bad}"),
            &[
                "rig.toml:2:15",
                &format!("sample_time = {}", if bad == "nan" { "NaN" } else { bad }),
                "positive number",
            ],
        );
    }
    refused_rig(3, "order = 0", &["rig.toml:3:9", "`order = 0`", "from 1"]);
    refused_rig(3, "order = -1", &["rig.toml:3:9", "`order = -1`", "from 1"]);
    refused_rig(4, "interval = [1.0, -1.0]", &["rig.toml:4:12", "[1, -1]", "lower end"]);
    refused_rig(4, "interval = [nan, 1.0]", &["rig.toml:4:12", "interval"]);
}

#[test]
fn an_unknown_role_or_use_lists_the_known_ones() {
    refused_rig(8, "role = \"decendant\"", &["rig.toml:8:8", "`decendant`", "did you mean `descendant`?"]);
    refused_rig(9, "use = \"train\"", &["rig.toml:9:7", "`train`", "`fit`", "`holdout`"]);
}

#[test]
fn broken_toml_points_at_its_place() {
    refused_rig(2, "sample_time = = 1", &["rig.toml:2:15"]);
    refused_rig(1, "name = \"a\"\nname = \"b\"", &["rig.toml:2:1", "duplicate key"]);
    refused(|folder| folder.write("rig.toml", "{\"name\": \"a\"}"), &["rig.toml:1:1", "looks like JSON"]);
    refused(|folder| folder.write("rig.toml", ""), &["rig.toml:1:1", "missing key `name`"]);
}

#[test]
fn a_rig_needs_records_and_one_to_fit() {
    refused(
        |folder| folder.edit("rig.toml", |text| text[..text.find("[[").unwrap_or(0)].to_owned()),
        &["rig.toml:1:", "no record", "[[record]]"],
    );
    refused(
        |folder| folder.edit("rig.toml", |text| text.replace("\"fit\"", "\"holdout\"")),
        &["rig.toml:7:", "no record has `use = \"fit\"`", "at least one record"],
    );
}

#[test]
fn a_record_is_listed_once() {
    refused_rig(17, "file = \"./descendant.csv\"", &["rig.toml:17:8", "listed twice", "hold-out"]);
}

#[test]
fn a_missing_record_is_reported_where_it_is_named() {
    refused_rig(
        7,
        "file = \"nowhere.csv\"",
        &["rig.toml:7:8", "nowhere.csv does not exist", "relative to the folder"],
    );
    refused_rig(7, "file = \".\"", &["rig.toml:7:8", "is a folder"]);
}

#[test]
fn columns_that_are_missing_or_in_doubt_are_named() {
    refused_row(1, "t,a,y_SIM", &["descendant.csv: the column `y_SIM` is not known"]);
    refused_row(1, "t,v", &["descendant.csv:1: the header has 2 cells, the rows 3"]);
    let named = |folder: &Folder| {
        folder.replace_line("rig.toml", 1, "name = \"small\"\ncolumns = { input = \"vv\", output = \"y\" }");
    };
    refused(named, &["descendant.csv: there is no column `vv`", "did you mean `v`?"]);
}

#[test]
fn a_misspelt_prediction_is_not_ignored() {
    refused(
        |folder| {
            folder.edit("descendant.csv", |text| text.replace('\n', ",0\n").replace("t,v,y,0", "t,v,y,ysim"))
        },
        &["descendant.csv: the column", "`ysim`", "`y_sim`"],
    );
}

#[test]
fn text_nan_and_infinity_in_a_cell_are_named_with_line_and_column() {
    refused_row(5, "0.03,one,1", &["descendant.csv:5: column `v`: `one` is not a number", "finite number"]);
    refused_row(
        5,
        "0.03,1,NaN",
        &["descendant.csv:5: column `y`: the cell is empty or NaN", "must be whole"],
    );
    refused_row(5, "0.03,-inf,1", &["descendant.csv:5: column `v`: `-inf` is not finite"]);
    refused_row(5, "0.03,1,1e999", &["descendant.csv:5: column `y`: `1e999` is not finite"]);
    refused_row(5, "0.03,,1", &["descendant.csv:5: column `v`: the cell is empty"]);
}

#[test]
fn blank_lines_do_not_shift_the_line_numbers() {
    refused(
        |folder| {
            folder.replace_line("descendant.csv", 5, "0.03,one,1");
            folder.edit("descendant.csv", |text| text.replacen('\n', "\r\n\r\n\r\n", 1));
        },
        &["descendant.csv:7: column `v`: `one`"],
    );
}

#[test]
fn a_ragged_row_is_named() {
    refused_row(5, "0.03,1", &["descendant.csv:5: the row has 2 cells, but the table has 3 columns"]);
    refused_row(
        5,
        "0,03,1,1",
        &["descendant.csv:5: the row has 4 cells, but the table has 3 columns", "decimal comma"],
    );
}

#[test]
fn time_must_increase() {
    refused_row(
        5,
        "0.02,1,1",
        &["descendant.csv:6: column `t`: 0.02 is followed by 0.04, a step of 0.02 s", "must be whole"],
    );
    refused_row(5, "0.01,1,1", &["descendant.csv:5: column `t`: the time stamp 0.01"]);
}

#[test]
fn a_gap_in_time_is_named_with_its_line() {
    let without_line_7 = |text: &str| -> String {
        text.lines().enumerate().filter(|(k, _)| *k != 6).map(|(_, line)| format!("{line}\n")).collect()
    };
    refused(
        |folder| folder.edit("descendant.csv", without_line_7),
        &["descendant.csv:7: column `t`:", "0.04 is followed by 0.06", "a step of 0.02 s", "must be whole"],
    );
}

#[test]
fn another_sample_time_is_named_with_the_one_to_write() {
    refused_rig(
        2,
        "sample_time = 0.02",
        &["descendant.csv: column `t`", "0.01 s on average", "`sample_time = 0.01`"],
    );
    refused_rig(2, "sample_time = 0.0105", &["descendant.csv: column `t`", "`sample_time = 0.01`"]);
}

#[test]
fn an_empty_or_short_record_is_refused() {
    refused(
        |folder| folder.write("descendant.csv", ""),
        &["descendant.csv: the file is empty", "one row a sample"],
    );
    refused(|folder| folder.write("descendant.csv", "t,v,y\n"), &["descendant.csv: no table was found"]);
    refused(
        |folder| folder.write("descendant.csv", "t,v,y\n0,1,1\n0.01,0,1\n"),
        &["descendant.csv: the record has 2 samples; at least 10", "longer record"],
    );
}

#[test]
fn a_prediction_with_gaps_is_refused() {
    refused(
        |folder| {
            folder.edit("descendant.csv", |text| {
                text.replace('\n', ",1\n")
                    .replace("t,v,y,1", "t,v,y,y_sim")
                    .replacen("0.05,1,", "0.05,1,,", 0)
            });
            folder.edit("descendant.csv", |text| {
                let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
                lines[7] = lines[7].strip_suffix('1').unwrap_or_default().to_owned();
                lines.join("\n")
            });
        },
        &["descendant.csv:8: column `y_sim`: the cell is empty", "cover every sample"],
    );
}

#[test]
fn an_input_that_never_moves_is_refused() {
    let still = |text: &str| -> String {
        let rows = text.lines().skip(1).map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            format!("{},0.5,{}\n", cells[0], cells[2])
        });
        std::iter::once("t,v,y\n".to_owned()).chain(rows).collect()
    };
    refused(
        |folder| {
            folder.edit("descendant.csv", still);
            folder.edit("ascendant.csv", still);
        },
        &["rig.toml:7:8", "never moves", "`v` rises and falls"],
    );
}

#[test]
fn a_letter_of_another_encoding_is_shown_as_it_reads_there() {
    refused(
        |folder| fs::write(folder.path("descendant.csv"), b"t,v,y\n0,1,1\n0.01,\xff,1\n").expect("writable"),
        &["descendant.csv:3: column `v`: `ÿ` is not a number"],
    );
}

#[test]
fn a_record_that_is_no_pulse_experiment_is_refused() {
    refused_row(
        40,
        "0.38,0.123,1",
        &["rig.toml: the method efficient", "record descendant", "--method free"],
    );
}

/// Another thing than a rig file in its place.
#[track_caller]
fn refused_file(name: &str, text: &str, reported: &[&str]) {
    let folder = Folder::with_good_rig();
    if !text.is_empty() {
        folder.write(name, text);
    }
    let output = folder.switchback(&["identify", name]).output().expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    for text in reported {
        assert!(stderr.contains(text), "`{text}` is not in:\n{stderr}");
    }
}

#[test]
fn something_else_than_a_rig_file_is_reported_as_such() {
    refused_file("nowhere.toml", "", &["nowhere.toml: no such file", "help: "]);
    refused_file(".", "", &["is a folder", "./rig.toml"]);
    refused_file("rig.json", "{\"name\": \"a\"}", &["looks like JSON"]);
    refused_file(
        "study.toml",
        "study = \"consistency\"\nseed = 1\n",
        &["this is a scenario", "`switchback study.toml`"],
    );
}

#[test]
fn an_unwritable_output_folder_is_refused_before_anything_is_computed() {
    let folder = Folder::with_good_rig();
    let before = folder.listing();
    let output =
        folder.switchback(&["identify", "rig.toml", "--out", "rig.toml/report"]).output().expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(output.stdout.is_empty());
    assert!(stderr.contains("rig.toml/report: cannot be an output folder: rig.toml is a file"), "{stderr}");
    assert!(stderr.contains("help: give the path of a folder"), "{stderr}");
    assert_eq!(folder.listing(), before);
}

#[test]
fn all_that_is_wrong_in_a_rig_file_and_its_records_is_reported_by_line() {
    let folder = Folder::with_good_rig();
    folder.write("rig.toml", "");
    let reported = |folder: &Folder| {
        let output = folder.switchback(&["gap", "rig.toml"]).output().expect("it runs");
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let empty = reported(&folder);
    for word in ["3 things are wrong", "missing key `name`", "no record", "missing key `sample_time`"] {
        assert!(empty.contains(word), "`{word}` is not in: {empty}");
    }
    folder.write(
        "rig.toml",
        "name = \"a\"\norder = 0\n[[record]]\nfile = \"nowhere.csv\"\nuse = \"fit\"\n[[record]]\nfile = \"again.csv\"\n\
         columns = { input = \"vv\" }\nuse = \"holdout\"\nholdout = 2\n",
    );
    let all = reported(&folder);
    let places = [
        "4 things are wrong",
        "rig.toml:2:9",
        "nowhere.csv does not exist",
        "no column `vv`",
        "rig.toml:10:11",
    ];
    let found: Vec<usize> = places
        .iter()
        .map(|place| all.find(place).unwrap_or_else(|| panic!("`{place}` is not in: {all}")))
        .collect();
    assert!(found.is_sorted(), "{all}");
}
