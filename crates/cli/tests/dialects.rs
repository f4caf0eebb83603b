//! The same record in the dialects that loggers, spreadsheets and laboratories write, read without a word of explanation.

use crate::common::bench_data::{Bench, SAMPLES, comma, lines, point, rows, truth};
use switchback_io::rig::Loaded;
use switchback_model::rig::Usage;

/// Whether the file gives the record that was written: every sample, the sample time, the labels, a third held out.
#[track_caller]
fn is_the_record(loaded: &Loaded, labels: [&str; 2]) {
    let rig = &loaded.rig;
    let (v, y) = truth();
    let all = |of: fn(&switchback_model::Record) -> &[f64]| -> Vec<f64> {
        rig.records.iter().flat_map(|record| of(&record.record).to_vec()).collect()
    };
    assert_eq!(all(|record| record.v()), v);
    assert_eq!(all(|record| record.y()), y);
    assert_eq!(rig.sample_time, 0.01);
    assert_eq!([rig.input_label.as_str(), rig.output_label.as_str()], labels);
    let uses: Vec<(Usage, usize)> =
        rig.records.iter().map(|record| (record.usage, record.record.len())).collect();
    assert_eq!(uses, [(Usage::Fit, SAMPLES - SAMPLES / 3), (Usage::Holdout, SAMPLES / 3)]);
    println!("{}", loaded.reported);
}

/// Reads the bytes as a file, with flags if any, and compares.
#[track_caller]
fn reads(contents: impl AsRef<[u8]>, flags: &[&str], labels: [&str; 2]) -> Loaded {
    let bench = Bench::new().with("bench.csv", contents);
    let loaded = bench.load(&[&["bench.csv"], flags].concat()).unwrap_or_else(|error| {
        panic!("{}", switchback_io::output::plain(&error));
    });
    is_the_record(&loaded, labels);
    loaded
}

fn with_header(header: &str, delimiter: &str, print: fn(f64) -> String, end: &str) -> String {
    let mut text = header.to_owned();
    for line in lines(delimiter, print) {
        text += end;
        text += &line;
    }
    text + end
}

const MM_N: [&str; 2] = ["travel [mm]", "force [N]"];

#[test]
fn plain_commas() {
    let loaded = reads(with_header("t,v,y", ",", point, "\n"), &[], ["input v", "output y"]);
    assert_eq!(loaded.reported.notes, [""; 0], "nothing unusual, nothing noted");
}

#[test]
fn semicolons_and_decimal_commas() {
    let text = with_header("time [s];travel [mm];force [N]", ";", comma, "\n");
    let loaded = reads(text, &[], MM_N);
    assert!(loaded.reported.notes[0].ends_with("semicolons between columns, decimal commas"));
}

#[test]
fn tabs_and_a_row_of_units() {
    reads(with_header("time\ttravel\tforce\ns\tmm\tN", "\t", point, "\n"), &[], MM_N);
}

#[test]
fn bars() {
    reads(with_header("time_s | travel_mm | force_N", " | ", point, "\n"), &[], MM_N);
}

#[test]
fn runs_of_blanks_with_the_header_in_a_comment() {
    let body: String = rows().map(|(t, v, y)| format!("{t:>12.5}{v:>14.6}{y:>14.6}\n")).collect();
    reads(format!("# simulated bench\n# time travel force\n{body}"), &[], ["travel", "force"]);
}

#[test]
fn a_byte_order_mark_crlf_and_a_quoted_header() {
    let text = with_header("\u{feff}\"Time (s)\",\"travel (mm)\",\"force (N)\"", ",", point, "\r\n");
    reads(text, &[], MM_N);
}

#[test]
fn carriage_returns_alone() {
    reads(with_header("time / s,travel / mm,force / N", ",", point, "\r"), &[], MM_N);
}

#[test]
fn an_instrument_s_preamble_comments_and_units() {
    let preamble = "Test bench 4, file exported 2024-05-01 10:00:00\nOperator;M. Miller\nChannels;3\nRange;10;20\n\n% calibrated\n";
    let table = with_header("Time;travel;force\n[s];[mm];[N]\n// begin", ";", point, "\n");
    let loaded = reads(format!("{preamble}{table}"), &[], MM_N);
    assert!(loaded.reported.notes[0].contains("lines 1 to"), "{}", loaded.reported);
}

#[test]
fn no_header_at_all() {
    let loaded = reads(lines(",", point).join("\n"), &[], ["input v", "output y"]);
    assert!(loaded.reported.notes[0].ends_with("no header"));
    let two: String = rows().map(|(_, v, y)| format!("{v} {y}\n")).collect();
    reads(two, &["--rate", "100"], ["input v", "output y"]);
}

#[test]
fn latin_letters_and_milliseconds() {
    let header = b"Zeit [ms];Weg [\xb5m];Kraft [N];Winkel [\xb0]\n".to_vec();
    let body: String = rows()
        .map(|(t, v, y)| {
            format!("{};{};{};{}\n", comma((1000.0 * t).round()), comma(v), comma(y), comma((3.0 * t).sin()))
        })
        .collect();
    let loaded = reads([header, body.into_bytes()].concat(), &[], ["Weg [µm]", "Kraft [N]"]);
    assert!(loaded.reported.notes[0].contains("Windows-1252"), "{}", loaded.reported);
    assert!(
        loaded.reported.to_string().contains("`Winkel [°]`"),
        "the other input is offered: {}",
        loaded.reported
    );
}

#[test]
fn sixteen_bit_letters() {
    let text = with_header("\u{feff}time [s]\ttravel [mm]\tforce [N]", "\t", point, "\r\n");
    let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let loaded = reads(little, &[], MM_N);
    assert!(loaded.reported.notes[0].contains("UTF-16LE"), "{}", loaded.reported);
    reads(big, &[], MM_N);
}

#[test]
fn iso_stamps_among_text_and_other_columns() {
    let stamp = |t: f64| format!("2024-05-01T23:59:58.{:03}", (1000.0 * t).round() as u64 % 1000);
    let body: String = rows()
        .map(|(t, v, y)| {
            let second = 58 + t.floor() as u64;
            let (day, clock) = if second < 60 {
                (1, format!("23:59:{second}"))
            } else {
                (2, format!("00:00:{:02}", second - 60))
            };
            let stamp = format!("2024-05-{day:02}T{clock}{}", &stamp(t)[19..]);
            format!("{stamp},OK,21.5,{y},{v}\n")
        })
        .collect();
    reads(format!("Timestamp,status,temperature [degC],force [N],travel [mm]\n{body}"), &[], MM_N);
}

#[test]
fn quoted_decimal_commas_between_commas() {
    let body: String =
        rows().map(|(t, v, y)| format!("\"{}\",\"{}\",\"{}\"\n", comma(t), comma(v), comma(y))).collect();
    reads(format!("\"time [s]\",\"travel [mm]\",\"force [N]\"\n{body}"), &[], MM_N);
}

#[test]
fn a_counter_and_a_delimiter_at_the_end_of_every_row() {
    let body: String = rows().enumerate().map(|(k, (_, v, y))| format!("{k},{v},{y},\n")).collect();
    reads(format!("Index,travel [mm],force [N]\n{body}"), &["--sample-time", "0.01"], MM_N);
}

#[test]
fn columns_are_named_without_unit_in_any_case_or_by_number() {
    let text = with_header("s1 [s],s2 [mm],s3 [N]", ",", point, "\n");
    for (input, output) in [("s2", "s3"), ("S2 [mm]", "S3"), ("2", "3"), ("s2_mm", "s3 (N)")] {
        reads(&text, &["--input", input, "--output", output], ["s2 [mm]", "s3 [N]"]);
    }
}

#[test]
fn the_manifest_that_init_writes_gives_the_same_rig() {
    let text = with_header("time [s];travel [mm];load [N];force [N]", ";", comma, "\n");
    // A fourth column, so that something must be chosen.
    let text: String = text
        .lines()
        .enumerate()
        .map(|(k, line)| if k == 0 { format!("{line}\n") } else { format!("{line};{}\n", k % 7) })
        .collect();
    let bench = Bench::new().with("a.csv", &text).with("b.csv", &text);
    for words in [
        &["a.csv"][..],
        &["a.csv", "b.csv"],
        &["a.csv", "b.csv", "--holdout", "0.25"],
        &["a.csv", "--resample"],
    ] {
        let direct = bench.load(words).expect("good files");
        let manifest = switchback_io::rig::manifest(&direct.plan, Some(&bench.path("")));
        println!("{manifest}");
        std::fs::write(bench.path("rig.toml"), &manifest).expect("writable");
        let again = bench.load(&["rig.toml"]).unwrap_or_else(|error| panic!("{error}\n{manifest}"));
        assert_eq!(again.rig, direct.rig, "{manifest}");
    }
}

#[test]
fn columns_that_are_called_otherwise_in_another_file_are_named_there() {
    let first = with_header("time [s],travel [mm],force [N]", ",", point, "\n");
    let second = with_header("t,position [mm],load [N],pos 2", ",", point, "\n");
    let second: String = second
        .lines()
        .enumerate()
        .map(|(k, line)| match k {
            0 => format!("{line}\n"),
            _ => format!("{line},{}\n", k % 5),
        })
        .collect();
    let bench = Bench::new().with("a.csv", first).with("b.csv", second);
    let direct = bench.load(&["a.csv", "b.csv"]).expect("good files");
    let manifest = switchback_io::rig::manifest(&direct.plan, Some(&bench.path("")));
    assert!(
        manifest.contains("columns = { time = \"t\", input = \"position\", output = \"load\" }"),
        "{manifest}"
    );
    std::fs::write(bench.path("rig.toml"), &manifest).expect("writable");
    let again = bench.load(&["rig.toml"]).unwrap_or_else(|error| panic!("{error}\n{manifest}"));
    assert_eq!(again.rig, direct.rig, "{manifest}");
}

/// The table with its time printed otherwise.
fn timed(name: &str, time: impl Fn(usize) -> String) -> String {
    let body: String = rows().enumerate().map(|(k, (_, v, y))| format!("{},{v},{y}\n", time(k))).collect();
    format!("{name},travel [mm],force [N]\n{body}")
}

#[test]
fn counts_since_1970_are_reported_by_their_size() {
    type Printed = fn(usize) -> String;
    let epochs: [(&str, Printed); 4] = [
        ("seconds", |k| format!("{:.2}", 1_700_000_000.0 + k as f64 / 100.0)),
        ("milliseconds", |k| (1_700_000_000_000 + 10 * k).to_string()),
        ("microseconds", |k| (1_700_000_000_000_000 + 10_000 * k).to_string()),
        ("nanoseconds", |k| (1_700_000_000_000_000_000 + 10_000_000 * k).to_string()),
    ];
    for (unit, time) in epochs {
        let loaded = reads(timed("timestamp", time), &[], MM_N);
        let reported = loaded.reported.to_string();
        assert_eq!(
            reported.contains(&format!("is taken as {unit} since 1970")),
            unit != "seconds",
            "{reported}"
        );
    }
}

#[test]
fn whole_numbers_without_a_unit_are_reported() {
    let text = timed("time", |k| (10 * k).to_string());
    let loaded = Bench::new().with("a.csv", &text).load(&["a.csv"]).expect("a good file");
    assert_eq!(loaded.rig.sample_time, 0.01);
    let reported = loaded.reported.to_string();
    assert!(reported.contains("`time` has no unit and is taken as ms, which makes 100 Hz"), "{reported}");
    assert!(reported.contains("write the unit into the header, as in `time [ms]`"), "{reported}");
    assert!(reported.contains("--time none --rate HZ"), "{reported}");
}

#[test]
fn a_clock_without_dates_goes_on_past_midnight() {
    let text = timed("time", |k| {
        let hundredths = (23 * 3600 + 59 * 60 + 58) * 100 + k;
        let (s, h) = (hundredths / 100 % 86_400, hundredths % 100);
        format!("{:02}:{:02}:{:02}.{h:02}0000", s / 3600, s / 60 % 60, s % 60)
    });
    let loaded = reads(text, &[], MM_N);
    assert!(
        loaded.reported.to_string().contains("passes midnight at line 202 and is continued"),
        "{}",
        loaded.reported
    );
}

#[test]
fn the_program_goes_from_raw_files_to_an_answer() {
    let header = "Prüfstand 4\nZeit [ms];Weg [mm];Kraft [N]\n";
    let body: String =
        rows().map(|(t, v, y)| format!("{};{};{}\r\n", (1000.0 * t).round(), comma(v), comma(y))).collect();
    let latin: Vec<u8> = format!("{header}{body}")
        .chars()
        .map(|letter| u8::try_from(u32::from(letter)).expect("Latin-1"))
        .collect();
    let bench = Bench::new().with("bench.csv", latin);
    let output = bench.switchback(&["identify", "bench.csv", "--json"]).output().expect("it runs");
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("one JSON object alone on stdout");
    for line in [
        "columns: input `Weg [mm]`",
        "sample time: 0.01 s (100 Hz), from the time column",
        "held out: the last third of bench.csv (200 of 600 samples",
    ] {
        assert!(stderr.contains(line), "`{line}` is not in:\n{stderr}");
    }

    let written = bench.switchback(&["init", "bench.csv", "--out", "rig.toml"]).output().expect("it runs");
    assert_eq!(written.status.code(), Some(0));
    let from_manifest = bench.switchback(&["identify", "rig.toml", "--json"]).output().expect("it runs");
    assert_eq!(from_manifest.stdout, output.stdout, "the rig file says the same");
    let again = bench.switchback(&["init", "bench.csv", "--out", "rig.toml"]).output().expect("it runs");
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("is there already"));
    let forced =
        bench.switchback(&["init", "bench.csv", "--out", "rig.toml", "--force"]).output().expect("it runs");
    assert_eq!(forced.status.code(), Some(0));
}
