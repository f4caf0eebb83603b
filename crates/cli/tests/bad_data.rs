//! Files of measurements that are interrupted, in doubt or wrong: what is made of them, and what is said.

use crate::common::bench_data::{Bench, SAMPLES, lines, point, rows};
use switchback_model::rig::Usage;

fn table(header: &str, change: impl Fn(usize, String) -> Option<String>) -> String {
    let rows = lines(",", point).into_iter().enumerate().filter_map(|(k, line)| change(k, line));
    std::iter::once(header.to_owned()).chain(rows).map(|line| line + "\n").collect()
}

#[track_caller]
fn refused(contents: &str, flags: &[&str], reported: &[&str]) {
    let bench = Bench::new().with("bench.csv", contents);
    let message = bench.refusal(&[&["bench.csv"], flags].concat());
    println!("{message}");
    for text in reported {
        assert!(message.contains(text), "`{text}` is not in:\n{message}");
    }
    assert!(message.starts_with("error: ") && message.contains("\nhelp: "), "{message}");
}

#[test]
fn dropouts_split_the_record_and_are_reported() {
    // Line 102 is missing, an empty cell in line 202, a run of NaN from line 302 on.
    let text = table("time [s],travel,force", |k, line| match k {
        100 => None,
        200 => Some("2,,1".to_owned()),
        300..310 => Some(format!("{},NaN,nan", k as f64 / 100.0)),
        _ => Some(line),
    });
    let loaded = Bench::new().with("bench.csv", &text).load(&["bench.csv"]).expect("a good file");
    let lengths: Vec<usize> = loaded.rig.records.iter().map(|record| record.record.len()).collect();
    let names: Vec<&str> = loaded.rig.records.iter().map(|record| record.name.as_str()).collect();
    assert_eq!(lengths, [100, 99, 99, 94, 196]);
    assert_eq!(names, ["bench-part-1", "bench-part-2", "bench-part-3", "bench-part-4", "bench-held-out"]);
    let reported = loaded.reported.to_string();
    assert!(reported.contains("3 dropouts") && reported.contains("bench.csv:102"), "{reported}");
    assert_eq!(loaded.rig.holdout_records().count(), 1);
}

#[test]
fn short_pieces_are_dropped_and_reported() {
    let text = table("time,travel,force", |k, line| (k != 50 && k != 54).then_some(line));
    let loaded = Bench::new().with("bench.csv", &text).load(&["bench.csv"]).expect("a good file");
    let reported = loaded.reported.to_string();
    assert!(reported.contains("3 samples in pieces too short"), "{reported}");
    assert_eq!(loaded.rig.records.iter().map(|record| record.record.len()).sum::<usize>(), SAMPLES - 5);
}

#[test]
fn without_time_a_missing_cell_splits_too() {
    let text: String = std::iter::once("travel,force\n".to_owned())
        .chain(
            rows()
                .enumerate()
                .map(|(k, (_, v, y))| if k == 300 { ",\n".to_owned() } else { format!("{v},{y}\n") }),
        )
        .collect();
    let loaded = Bench::new().with("a.csv", &text).load(&["a.csv", "--rate", "100"]).expect("a good file");
    assert_eq!(loaded.rig.records[0].record.len(), 300);
    assert!(loaded.reported.to_string().contains("a.csv:302"), "{}", loaded.reported);
}

#[test]
fn a_last_line_that_is_cut_off_is_left_out() {
    let mut text = table("time,travel,force", |_, line| Some(line));
    text += "6,0.1";
    let loaded = Bench::new().with("a.csv", &text).load(&["a.csv"]).expect("a good file");
    assert!(loaded.reported.notes[0].contains("line 602, the last, is cut off"), "{}", loaded.reported);
}

#[test]
fn jitter_is_accepted_and_reported_up_to_one_percent() {
    // Samples where the stamps say they are.
    let shaken = |share: f64| {
        let all: Vec<(f64, f64, f64)> = rows().collect();
        let mut text = String::from("time,travel,force\n");
        for (k, (t, v, y)) in all.iter().enumerate() {
            let off = share * (k as f64 * 1.3).sin();
            let other = if off > 0.0 { (k + 1).min(SAMPLES - 1) } else { k.saturating_sub(1) };
            let (_, next, further) = all[other];
            let (v, y) = (v + off.abs() * (next - v), y + off.abs() * (further - y));
            text += &format!("{:.6},{v},{y}\n", t + 0.01 * off);
        }
        text
    };
    let loaded = Bench::new().with("a.csv", shaken(0.004)).load(&["a.csv"]).expect("a good file");
    assert!(
        loaded.reported.to_string().contains("whose steps differ from it by up to 0."),
        "{}",
        loaded.reported
    );
    assert!((loaded.rig.sample_time - 0.01).abs() < 1e-6);
    refused(&shaken(0.1), &[], &["bench.csv:3: column `time`: uneven sampling", "--resample"]);
    let even = Bench::new().with("a.csv", shaken(0.1)).load(&["a.csv", "--resample"]).expect("a good file");
    assert!(even.reported.to_string().contains("interpolated linearly"), "{}", even.reported);
}

#[test]
fn stamps_rounded_to_a_millisecond_describe_the_rate_resampled_or_not() {
    for rate in [30.0, 60.0, 300.0] {
        let mut text = String::from("time [s],travel,force\n");
        for (k, (_, v, y)) in rows().enumerate() {
            text += &format!("{:.3},{v},{y}\n", k as f64 / rate);
        }
        for flags in [&["a.csv"][..], &["a.csv", "--resample"]] {
            let loaded = Bench::new().with("a.csv", &text).load(flags).expect("a good file");
            assert_eq!(loaded.rig.sample_time, 1.0 / rate, "{flags:?}");
            assert!(loaded.reported.to_string().contains(&format!("({rate} Hz)")), "{}", loaded.reported);
        }
    }
}

#[test]
fn rows_without_time_need_a_rate() {
    let text: String = std::iter::once("travel,force\n".to_owned())
        .chain(rows().map(|(_, v, y)| format!("{v},{y}\n")))
        .collect();
    refused(&text, &[], &["bench.csv: the sample time is not known", "--sample-time 0.01", "--rate 100"]);
    let text: String = std::iter::once("Index,travel,force\n".to_owned())
        .chain(rows().enumerate().map(|(k, (_, v, y))| format!("{k},{v},{y}\n")))
        .collect();
    refused(&text, &[], &["`Index` only counts the samples", "--rate 100"]);
}

#[test]
fn stamps_too_coarse_for_the_rows_are_spread_and_can_be_left_out() {
    let text: String = std::iter::once("time,travel,force\n".to_owned())
        .chain(rows().map(|(t, v, y)| format!("{},{v},{y}\n", t.floor())))
        .collect();
    let spread = Bench::new().with("a.csv", &text).load(&["a.csv"]).expect("a good file");
    assert_eq!(spread.rig.sample_time, 0.01);
    assert!(spread.reported.to_string().contains("up to 100 rows share an instant"), "{}", spread.reported);
    let loaded = Bench::new().with("a.csv", &text).load(&["a.csv", "--time", "none", "--rate", "100"]);
    assert_eq!(loaded.expect("a good file").rig.sample_time, 0.01);
}

#[test]
fn columns_in_doubt_are_listed_with_the_line_to_type() {
    // Nothing in them follows anything else.
    let text = table("time [s],s1 [mm],s2 [mm],s3", |k, _| {
        Some(format!("{},{},{},{}", k as f64 / 100.0, k * k * 31 % 101, k * k * k % 103, k % 7))
    });
    refused(
        &text,
        &[],
        &[
            "which column is the input and which the output is ambiguous",
            "1 `time [s]`, 2 `s1 [mm]`, 3 `s2 [mm]`, 4 `s3`",
            "bench.csv --input NAME --output NAME",
        ],
    );
}

#[test]
fn a_voltage_and_a_motion_may_either_drive() {
    let text = table("time [s],voltage [V],displacement [um]", |_, line| Some(line));
    let tried = Bench::new().with("a.csv", &text).load(&["a.csv"]).expect("a good file");
    assert_eq!(tried.rig.input_label, "voltage [V]");
    let reported = tried.reported.to_string();
    assert!(reported.contains("no name says which column is the input"), "{reported}");
    assert!(reported.contains("--input displacement --output voltage"), "{reported}");
    let loaded =
        Bench::new().with("a.csv", &text).load(&["a.csv", "--input", "voltage"]).expect("a good file");
    assert_eq!(loaded.rig.output_label, "displacement [um]");
}

#[test]
fn a_misspelt_column_gets_a_suggestion_and_all_are_reported_at_once() {
    let text = table("time [s],travel [mm],force [N]", |_, line| Some(line));
    refused(
        &text,
        &["--input", "travl", "--output", "frce"],
        &["2 things are wrong", "no column `travl`", "did you mean `travel`?", "did you mean `force`?"],
    );
    refused(&text, &["--input", "travel", "--output", "Travel"], &["asked for as input and as output"]);
    let twice = table("time [s],travel,travel", |_, line| Some(line));
    refused(&twice, &["--input", "travel"], &["`travel` stands 2 times", "number"]);
}

#[test]
fn all_faulty_cells_are_reported_at_once() {
    let text = table("time,travel,force", |k, line| match k {
        9 => Some("0.09,one,1".to_owned()),
        19 => Some("0.19,1".to_owned()),
        29 => Some("0.29,1,1e999".to_owned()),
        _ => Some(line),
    });
    refused(
        &text,
        &[],
        &[
            "3 things are wrong",
            "bench.csv:11: column `travel`: `one` is not a number",
            "bench.csv:21: the row has 2 cells, but the table has 3 columns",
            "bench.csv:31: column `force`: `1e999` is not finite",
        ],
    );
}

#[test]
fn stamps_are_reported_as_they_stand_in_the_file() {
    let text = table("time,travel,force", |k, line| {
        let cells: Vec<&str> = line.split(',').collect();
        let second = if k == 99 { 5 } else { 7 };
        Some(format!("2024-03-05T12:00:{second:02}.{:06},{},{}", 100 * k, cells[1], cells[2]))
    });
    refused(
        &text,
        &[],
        &[
            "bench.csv:101: column `time`: the time stamp 2024-03-05T12:00:05.009900 does not lie after the one before it, \
             2024-03-05T12:00:07.009800",
        ],
    );
}

#[test]
fn times_that_are_none_lead_to_iso_or_to_none() {
    let text = table("timestamp,travel,force", |k, line| {
        let (_, rest) = line.split_once(',')?;
        Some(format!("day 65 at 12:00:00.{:06},{rest}", 100 * k))
    });
    refused(
        &text,
        &[],
        &["`day 65 at 12:00:00.000000`, cannot be read", "2024-03-05T12:00:00.01", "--time none --rate HZ"],
    );
    refused(
        &text,
        &["--time", "timestamp"],
        &["bench.csv:2: column `timestamp`", "is no time that can be read", "ISO 8601"],
    );
}

#[test]
fn decimal_signs_that_do_not_agree_are_named() {
    let text: String = std::iter::once("time;travel;force\n".to_owned())
        .chain(rows().map(|(t, v, y)| format!("{t};{};{y}\n", format!("{v:.3}").replace('.', ","))))
        .collect();
    let cell = format!("{:.3}", rows().next().expect("a row").1).replace('.', ",");
    refused(
        &text,
        &[],
        &[
            "bench.csv:2: column `travel`",
            &format!("`{cell}` is a comma, but not that of other columns"),
            "597 more cells",
        ],
    );
    let message = Bench::new().with("a.csv", &text).refusal(&["a.csv"]);
    assert_eq!(message.matches("help: ").count(), 1, "a remedy is reported once: {message}");
    let comma = |x: f64| format!("{x:.3}").replace('.', ",");
    let twice: String = std::iter::once("time,travel,force\n".to_owned())
        .chain(rows().map(|(t, v, y)| format!("{},{},{}\n", comma(t), comma(v), comma(y))))
        .collect();
    refused(&twice, &[], &["bench.csv:1: the comma separates columns and decimals both"]);
}

#[test]
fn remedies_are_those_of_the_command_line() {
    let good = table("time [s],travel,force", |_, line| Some(line));
    let message = Bench::new().with("a.csv", &good).refusal(&["a.csv", "--rate", "103"]);
    assert!(message.contains("`--rate 100`") && !message.contains("sample_time ="), "{message}");
    let message = Bench::new().with("a.csv", &good).refusal(&["a.csv", "--time", "none"]);
    assert!(
        message.contains("--time none --rate 100") && !message.contains("there is no time column"),
        "{message}"
    );
    let slow: String = std::iter::once("time [s],travel,force\n".to_owned())
        .chain(rows().map(|(t, v, y)| format!("{},{v},{y}\n", 2.0 * t)))
        .collect();
    let bench = Bench::new().with("a.csv", &good).with("b.csv", &slow);
    assert!(bench.refusal(&["a.csv", "b.csv", "--resample"]).contains("`--resample --rate 100`"));
    assert!(bench.load(&["a.csv", "b.csv", "--resample", "--rate", "100"]).is_ok());
}

#[test]
fn a_file_that_holds_no_table_is_reported() {
    refused("", &[], &["the file is empty"]);
    refused("Dear reader,\nthis is a letter.\n", &[], &["no table was found"]);
    refused("force\n1\n2\n3\n", &[], &["no table was found", "two columns"]);
    refused("time,force\n0,1.5\n0.1,2\n0.2,4\n", &[], &["the input", "an input and an output"]);
    refused("t,v\n0,1,2\n0.1,2,3\n", &[], &["bench.csv:1: the header has 2 cells, the rows 3"]);
    refused("t,v,y,w\n0,1,2\n0.1,2,3\n", &[], &["the record has 2 samples; at least 10"]);
    refused("t,v,y\n0,1,2\n0.1,2,3\n", &[], &["the record has 2 samples; at least 10"]);
}

#[test]
fn a_record_that_stands_still_is_reported() {
    let text: String =
        std::iter::once("t,v,y\n".to_owned()).chain(rows().map(|(t, _, y)| format!("{t},1,{y}\n"))).collect();
    refused(&text, &[], &["the input `v` never moves", "rises and falls"]);
}

#[test]
fn an_output_that_never_changes_is_reported_by_its_name() {
    let text =
        table("time,travel,force", |_, line| line.rsplit_once(',').map(|(rest, _)| format!("{rest},3")));
    refused(&text, &[], &["the output `force` never changes", "check the sensor"]);
    refused("t,v,y\n0,1,2\n", &[], &["the record has 1 sample;"]);
    let short: String = table("time,travel,force", |k, line| (k < 40).then_some(line));
    let bench = Bench::new().with("a.csv", short);
    for verb in ["gap", "identify"] {
        let output = bench.switchback(&[verb, "a.csv"]).output().expect("it runs");
        let reported = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!reported.contains("in the rig file") && !reported.contains("knots or"), "{reported}");
    }
}

#[test]
fn values_that_cannot_have_been_measured_are_warned_of_and_used() {
    let with = |k: usize, cell: &str| -> String {
        let text = table("time,travel,force", |row, line| match (row == k, line.rsplit_once(',')) {
            (true, Some((rest, _))) => Some(format!("{rest},{cell}")),
            _ => Some(line),
        });
        let loaded = Bench::new().with("a.csv", text).load(&["a.csv"]).expect("a usable file");
        loaded.reported.warnings.join("\n")
    };
    assert_eq!(with(98, "60"), "");
    let far = with(98, "1e300");
    assert!(far.contains("a.csv:100: `force` is 1e300, ") && far.contains("leave the cell empty"), "{far}");
    let sentinel = with(98, "-9999");
    assert!(sentinel.contains("a.csv:100: `force` is -9999, "), "{sentinel}");
}

#[test]
fn flags_that_do_not_go_together_are_refused() {
    let good = table("t,v,y", |_, line| Some(line));
    refused(&good, &["--holdout", "1.5"], &["--holdout 1.5 is no share"]);
    refused(&good, &["--holdout", "bench.csv"], &["all is held out"]);
    refused(&good, &["bench.csv"], &["is given twice"]);
    refused(&good, &["missing.csv"], &["missing.csv: no such file"]);
    let bench = Bench::new()
        .with("a.csv", &good)
        .with("rig.toml", "name = \"a\"\n[[record]]\nfile = \"a.csv\"\nuse = \"fit\"\n");
    assert!(bench.load(&["rig.toml"]).is_ok(), "a rig file may leave the sample time to the time column");
    assert!(bench.refusal(&["rig.toml", "a.csv"]).contains("cannot be given together"));
    assert!(
        bench.refusal(&["rig.toml", "--input", "v"]).contains("--input belongs to files of measurements")
    );
}

#[test]
fn files_must_agree() {
    let slow: String = std::iter::once("t,v,y\n".to_owned())
        .chain(rows().map(|(t, v, y)| format!("{},{v},{y}\n", 2.0 * t)))
        .collect();
    let good = table("t,v [mm],y", |_, line| Some(line));
    let metres = table("t,v [m],y", |_, line| Some(line));
    let bench = Bench::new().with("a.csv", &good).with("b.csv", &slow).with("c.csv", &metres);
    let message = bench.refusal(&["a.csv", "b.csv", "c.csv"]);
    assert!(message.contains("2 things are wrong"), "{message}");
    assert!(message.contains("b.csv: the sample time is 0.02 s here, but 0.01 s in a.csv"), "{message}");
    assert!(message.contains("c.csv: the column is `v [m]` here, but `v [mm]` in a.csv"), "{message}");
}

#[test]
fn what_is_held_out_can_be_said() {
    let good = table("t,v,y", |_, line| Some(line));
    let bench = Bench::new().with("a.csv", &good).with("b.csv", &good);
    let uses = |words: &[&str]| -> Vec<(String, Usage, usize)> {
        let rig = bench.load(words).expect("good files").rig;
        rig.records.into_iter().map(|record| (record.name, record.usage, record.record.len())).collect()
    };
    let of = |name: &str, usage, samples| (name.to_owned(), usage, samples);
    assert_eq!(uses(&["a.csv", "b.csv"]), [of("a", Usage::Fit, 600), of("b", Usage::Holdout, 600)]);
    assert_eq!(
        uses(&["b.csv", "--holdout", "a.csv"]),
        [of("b", Usage::Fit, 600), of("a", Usage::Holdout, 600)]
    );
    assert_eq!(
        uses(&["a.csv", "--holdout", "0.25"]),
        [of("a", Usage::Fit, 450), of("a-held-out", Usage::Holdout, 150)]
    );
}

#[test]
fn everything_wrong_in_a_rig_file_is_reported_at_once() {
    let bench = Bench::new().with(
        "rig.toml",
        "name = \"a\"\nsample_time = \"fast\"\noder = 2\norder = 99\n[[record]]\nfile = \"a.csv\"\nrule = \"free\"\nuse = \"fit\"\n",
    );
    let message = bench.refusal(&["rig.toml"]);
    println!("{message}");
    for reported in [
        "5 things are wrong",
        "rig.toml:2:15",
        "unknown key `oder`",
        "`order = 99`",
        "a.csv does not exist",
        "unknown key `rule`",
    ] {
        assert!(message.contains(reported), "`{reported}` is not in:\n{message}");
    }
    let bench = bench.with("rig.toml", "name = \"a\"\n[[record]]\nfile = \"a.csv\"\nuse = \"fit\"\n[[record]]\nfile = \"b.csv\"\nuse = \"holdout\"\n");
    let message = bench.refusal(&["rig.toml"]);
    assert!(
        message.contains("a.csv does not exist") && message.contains("b.csv does not exist"),
        "{message}"
    );
}
