//! Clocks: stamps that shake, dates, two clocks in a file, time that begins anew.

use super::*;

/// Numbers between −1 and 1 that look like noise.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    }
}

#[test]
fn stamps_that_shake_about_even_samples_are_distinguished_from_uneven_samples() {
    for shake in [0.03, 0.3] {
        let mut noise = noise();
        let offsets: Vec<f64> = (0..SAMPLES).map(|_| 0.01 * shake * noise()).collect();
        let text = table("time,travel,force", |k, t, v, y| format!("{:.6},{v},{y}", t + offsets[k]));
        let loaded = load(text, &[]);
        assert!((loaded.rig.sample_time - 0.01).abs() < 1e-5, "{}", loaded.reported);
        assert!(loaded.reported.to_string().contains("are taken as even"), "{}", loaded.reported);
        assert_eq!(signals(&loaded)[0], truth().0);
    }
}

#[test]
fn a_counter_wins_over_stamps_that_come_late() {
    let mut noise = noise();
    let late: Vec<f64> = (0..SAMPLES).map(|_| 0.02 * noise().max(0.0).powi(4)).collect();
    let text = table("host_time,seq,travel,force", |k, t, v, y| {
        if k == 400 { String::new() } else { format!("{:.6},{},{v},{y}", t + late[k], k % 256) }
    });
    let loaded = load(text, &[]);
    assert!((loaded.rig.sample_time - 0.01).abs() < 1e-5, "{}", loaded.reported);
    assert!(loaded.reported.to_string().contains("`seq` counts the samples instead"), "{}", loaded.reported);
    assert_eq!(loaded.rig.records[0].record.len(), 400, "the count that is missing splits the record");
}

#[test]
fn days_of_spreadsheets_are_days() {
    for first in [46_340.8, 739_570.25] {
        let text = table("time,travel,force", |_, t, v, y| format!("{:.10},{v},{y}", first + t / 86_400.0));
        let loaded = load(text, &[]);
        assert!((loaded.rig.sample_time - 0.01).abs() < 1e-5, "{}", loaded.reported);
        assert!(loaded.reported.to_string().contains("`time` is taken as days"), "{}", loaded.reported);
    }
}

#[test]
fn the_name_of_a_clock_may_be_its_unit() {
    for (name, seconds) in
        [("ms", 1e-3), ("millis", 1e-3), ("TimeUS", 1e-6), ("t_micros", 1e-6), ("elapsed seconds", 1.0)]
    {
        let text = table(&format!("{name},travel,force"), |k, _, v, y| {
            format!("{:.6},{v},{y}", 0.01 * k as f64 / seconds)
        });
        is_the_record(text, &[], "0.01 s (100 Hz)");
    }
}

#[test]
fn a_rate_that_no_machine_has_is_doubted() {
    let text = table("time,travel,force", |k, _, v, y| format!("{:e},{v},{y}", 1e-8 * k as f64));
    let reported = load(text, &[]).reported.to_string();
    assert!(reported.contains("100000000 Hz, from `time`, is no likely sample rate"), "{reported}");
}

#[test]
fn seconds_and_nanoseconds_are_one_clock() {
    for [sec, nanosec] in
        [["header.stamp.sec", "header.stamp.nanosec"], ["secs", "nsecs"], ["stamp_sec", "stamp_nsec"]]
    {
        let text = table(&format!("{sec},{nanosec},travel,force"), |k, _, v, y| {
            format!("{},{},{v},{y}", 1_766_147_454 + k / 100, k % 100 * 10_000_000)
        });
        is_the_record(text, &[], "are one clock");
    }
}

#[test]
fn dates_of_all_countries_are_read() {
    let stamps: [fn(usize, usize) -> String; 4] = [
        |s, ms| format!("14.11.2026 19:13:{s:02},{ms:03}"),
        |s, ms| format!("11/14/2026 07:13:{s:02}.{ms:03} PM"),
        |s, ms| format!("14/11/2026 19:13:{s:02}.{ms:03}"),
        |s, ms| format!("14-Nov-2026 19:13:{s:02}.{ms:03}"),
    ];
    for stamp in stamps {
        let text =
            table("Zeit;Weg;Kraft", |k, _, v, y| format!("{};{v};{y}", stamp(50 + k / 100, k % 100 * 10)));
        is_the_record(text, &[], "semicolons");
    }
}

#[test]
fn nanoseconds_keep_their_digits() {
    let stamp = |k: usize| 1_766_147_454_233_218_075_u64 + 10_000_000 * k as u64 + (k % 2) as u64;
    let text = table("timestamp,travel,force", |k, _, v, y| format!("{},{v},{y}", stamp(k)));
    is_the_record(&text, &[], "nanoseconds since 1970");
    let bench = Bench::new().with("bench.csv", &text);
    assert!(
        bench
            .switchback(&["identify", "bench.csv", "--out", "found", "--quiet"])
            .output()
            .expect("it runs")
            .status
            .success()
    );
    let run = bench.switchback(&["simulate", "found/model.json", "bench.csv"]).output().expect("it runs");
    let printed = String::from_utf8_lossy(&run.stdout);
    assert!(printed.contains(&format!("\n{},", stamp(SAMPLES - 1))), "stamps are written as they stand");
}

#[test]
fn time_that_starts_anew_begins_a_record() {
    let text = table("time,travel,force", |k, _, v, y| format!("{},{v},{y}", (k % 200) as f64 / 100.0));
    let loaded = load(text, &[]);
    let lengths: Vec<usize> = loaded.rig.records.iter().map(|record| record.record.len()).collect();
    assert_eq!(lengths, [200, 200, 200], "{}", loaded.reported);
    assert!(
        loaded.reported.to_string().contains("`time` starts anew 2 times, first at line 202"),
        "{}",
        loaded.reported
    );
}

#[test]
fn of_one_instant_the_last_row_counts() {
    let text = table("time,travel,force", |k, t, v, y| match k {
        300 => format!("{t},99,99\n{t},{v},{y}"),
        _ => format!("{t},{v},{y}"),
    });
    is_the_record(text, &[], "stands still at 1 row, the first of them line 303");
}

#[test]
fn a_unit_that_changes_is_named_with_its_line() {
    let text = table("time [ms],travel,force", |_, t, v, y| {
        format!("{},{v},{y}", if t < 1.0 { 1000.0 * t } else { t })
    });
    let refused = refusal(text);
    assert!(refused.contains("bench.csv:102: column `time [ms]`: its unit changes"), "{refused}");
}
