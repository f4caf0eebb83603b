//! What people of the field bring: signals at rates of their own, clocks that shake, names and headers of all kinds. Each file is read at the first
//! attempt, and what was made of it is said.

use crate::common::bench_data::{Bench, SAMPLES, lines, point, rows, truth};
use std::fmt::Write;
use switchback_io::rig::{Loaded, RIG_FILE, manifest};
use switchback_model::Record;

/// Reads the bytes as a file, and again by the rig file that says what was inferred.
#[track_caller]
fn load(contents: impl AsRef<[u8]>, flags: &[&str]) -> Loaded {
    let bench = Bench::new().with("bench.csv", contents);
    let read = |words: &[&str]| {
        bench.load(words).unwrap_or_else(|error| panic!("{}", switchback_io::output::plain(&error)))
    };
    let loaded = read(&[&["bench.csv"], flags].concat());
    let folder = bench.path("");
    std::fs::write(bench.path(RIG_FILE), manifest(&loaded.plan, Some(&folder))).expect("a writable folder");
    let rig_file = bench.path(RIG_FILE).display().to_string();
    let again = read(&[rig_file.as_str()]);
    assert_eq!(again.rig.sample_time, loaded.rig.sample_time, "by its rig file");
    assert_eq!(signals(&again), signals(&loaded), "by its rig file");
    loaded
}

/// Inputs and outputs of all records, one after the other.
fn signals(loaded: &Loaded) -> [Vec<f64>; 2] {
    let all = |of: fn(&Record) -> &[f64]| -> Vec<f64> {
        loaded.rig.records.iter().flat_map(|record| of(&record.record).to_vec()).collect()
    };
    [all(Record::v), all(Record::y)]
}

/// Whether the file gives the record that was written, with a word on how.
#[track_caller]
fn is_the_record(contents: impl AsRef<[u8]>, flags: &[&str], said: &str) -> Loaded {
    let loaded = load(contents, flags);
    let (v, y) = truth();
    let [found_v, found_y] = signals(&loaded);
    assert_eq!(loaded.rig.sample_time, 0.01, "{}", loaded.reported);
    assert_eq!((found_v.len(), found_y.len()), (v.len(), y.len()), "{}", loaded.reported);
    assert_close(&found_v, &v, 1e-9);
    assert_close(&found_y, &y, 1e-9);
    assert!(loaded.reported.to_string().contains(said), "`{said}` is not in:\n{}", loaded.reported);
    loaded
}

#[track_caller]
fn assert_close(found: &[f64], wanted: &[f64], tolerance: f64) {
    assert_eq!(found.len(), wanted.len());
    let far = found.iter().zip(wanted).position(|(found, wanted)| (found - wanted).abs() > tolerance);
    assert_eq!(far, None, "{:?} instead of {:?}", far.map(|k| found[k]), far.map(|k| wanted[k]));
}

/// A header and rows of cells, each made of its number, time, input and output.
fn table(header: &str, row: impl Fn(usize, f64, f64, f64) -> String) -> String {
    let body = rows().enumerate().map(|(k, (t, v, y))| row(k, t, v, y) + "\n");
    std::iter::once(format!("{header}\n")).chain(body).collect()
}

/// The message about a file that is refused.
fn refusal(contents: impl AsRef<[u8]>) -> String {
    Bench::new().with("bench.csv", contents).refusal(&["bench.csv"])
}

mod rates {
    use super::*;

    /// The input at every `every`th row only, straight lines between.
    fn straight(every: usize) -> Vec<f64> {
        let (v, _) = truth();
        let value = |k: usize| {
            let (left, share) = (k / every * every, (k % every) as f64 / every as f64);
            v[left] + share * (v.get(left + every).unwrap_or(&0.0) - v[left])
        };
        (0..=(SAMPLES - 1) / every * every).map(value).collect()
    }

    #[test]
    fn blanks_of_a_slow_input_are_filled() {
        let blank = |k: usize, t: f64, v: f64, y: f64| {
            if k.is_multiple_of(4) { format!("{t},{v},{y}") } else { format!("{t},,{y}") }
        };
        let text = table("time,travel,force", blank);
        let loaded = load(&text, &[]);
        let reported = loaded.reported.to_string();
        assert!(reported.contains("`travel` at 25 Hz, `force` at 100 Hz"), "{reported}");
        assert!(reported.contains("interpolated linearly"), "{reported}");
        assert_close(&signals(&loaded)[0], &straight(4), 1e-9);
        let held = load(&text, &["--resample", "hold"]);
        assert!(held.reported.to_string().contains("held between its values"), "{}", held.reported);
    }

    #[test]
    fn runs_of_equal_values_are_a_slower_rate() {
        let (v, _) = truth();
        let text = table("time,travel,force", |k, t, _, y| format!("{t},{},{y}", v[k - k % 4]));
        let loaded = load(&text, &[]);
        let reported = loaded.reported.to_string();
        assert!(reported.contains("`travel` changes at every 4th row only, at 25 Hz"), "{reported}");
        assert_close(&signals(&loaded)[0], &straight(4), 1e-9);
    }

    #[test]
    fn an_input_that_the_machine_holds_is_held() {
        let (v, _) = truth();
        let mut y = 0.0;
        let responses: Vec<f64> = (0..SAMPLES)
            .map(|k| {
                let before = k.saturating_sub(1);
                y += 0.5 * (v[before - before % 4] - y);
                y
            })
            .collect();
        let text = table("time,travel,force", |k, t, _, _| format!("{t},{},{}", v[k - k % 4], responses[k]));
        let loaded = load(text, &[]);
        assert!(loaded.reported.to_string().contains("taken as held between"), "{}", loaded.reported);
        assert_eq!(signals(&loaded)[0][1], v[0]);
    }

    #[test]
    fn an_output_that_is_slower_sets_the_rate() {
        for is_held in [true, false] {
            let (_, y) = truth();
            let text = table("time,travel,force", |k, t, v, _| match (k % 3, is_held) {
                (0, _) => format!("{t},{v},{}", y[k]),
                (_, true) => format!("{t},{v},{}", y[k - k % 3]),
                (_, false) => format!("{t},{v},"),
            });
            let loaded = load(text, &[]);
            assert_eq!(loaded.rig.sample_time, 0.03, "{}", loaded.reported);
            assert!(loaded.reported.to_string().contains("33.33 Hz"), "{}", loaded.reported);
        }
    }

    #[test]
    fn signals_on_rows_of_their_own_are_joined() {
        let text = table("time,travel,force", |_, t, v, y| format!("{t:.4},{v},\n{:.4},,{y}", t + 0.0004));
        let loaded = load(text, &[]);
        assert_eq!(loaded.rig.sample_time, 0.01);
        assert!(signals(&loaded)[1].len() >= SAMPLES - 1, "{}", loaded.reported);
        assert!(loaded.reported.to_string().contains("at 100 Hz"), "{}", loaded.reported);
    }

    #[test]
    fn rows_in_which_nothing_changed_are_none() {
        let coarse = |x: f64| (x / 2.0).round();
        let (v, y) = truth();
        let kept = |k: usize| {
            k == 0 || k + 1 == SAMPLES || coarse(v[k]) != coarse(v[k - 1]) || coarse(y[k]) != coarse(y[k - 1])
        };
        let text: String = std::iter::once("time,travel,force\n".to_owned())
            .chain(
                rows()
                    .enumerate()
                    .filter(|(k, _)| kept(*k))
                    .map(|(_, (t, v, y))| format!("{t},{},{}\n", coarse(v), coarse(y))),
            )
            .collect();
        let loaded = load(text, &[]);
        assert!(
            loaded.reported.to_string().contains("nothing changed were not logged"),
            "{}",
            loaded.reported
        );
        assert_close(&signals(&loaded)[0], &v.iter().map(|v| coarse(*v)).collect::<Vec<_>>(), 1e-9);
    }

    #[test]
    fn signals_with_clocks_of_their_own_are_joined_on_time() {
        let (_, y) = truth();
        let text = table("u_time [ms],travel,y_time [ms],force", |k, t, v, _| {
            let late = 2 * k;
            match late < SAMPLES {
                true => format!("{},{v},{},{}", 1000.0 * t, 10 * late, y[late]),
                false => format!("{},{v},,", 1000.0 * t),
            }
        });
        let loaded = load(text, &[]);
        assert_eq!(loaded.rig.sample_time, 0.02);
        let (v, y) = truth();
        let every_second = |of: &[f64]| of.iter().step_by(2).copied().collect::<Vec<_>>();
        assert_close(&signals(&loaded)[0], &every_second(&v), 1e-9);
        assert_close(&signals(&loaded)[1], &every_second(&y), 1e-9);
        assert!(loaded.reported.to_string().contains("has a clock of its own"), "{}", loaded.reported);
    }
}

mod clocks {
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
    fn stamps_that_shake_about_even_samples_are_told_from_uneven_samples() {
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
        assert!(
            loaded.reported.to_string().contains("`seq` counts the samples instead"),
            "{}",
            loaded.reported
        );
        assert_eq!(loaded.rig.records[0].record.len(), 400, "the count that is missing splits the record");
    }

    #[test]
    fn days_of_spreadsheets_are_days() {
        for first in [46_340.8, 739_570.25] {
            let text =
                table("time,travel,force", |_, t, v, y| format!("{:.10},{v},{y}", first + t / 86_400.0));
            let loaded = load(text, &[]);
            assert!((loaded.rig.sample_time - 0.01).abs() < 1e-5, "{}", loaded.reported);
            assert!(loaded.reported.to_string().contains("`time` is taken as days"), "{}", loaded.reported);
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
            let text = table("Zeit;Weg;Kraft", |k, _, v, y| {
                format!("{};{v};{y}", stamp(50 + k / 100, k % 100 * 10))
            });
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
}

mod roles {
    use super::*;

    #[test]
    fn commands_and_responses_are_known_by_their_names() {
        for (header, input) in [
            ("time,pos_cmd,pos", 1),
            ("time,dof_pos,des_dof_pos", 2),
            ("time,actual,command", 2),
            ("time,q_ref,q", 1),
            ("time,Position Feedback,Position Command", 2),
            ("time,state,action", 2),
            ("time,goal_current,present_velocity", 1),
            ("time,Istwert,Sollwert", 2),
            ("time,measured force,demanded force", 2),
            ("time,pos (5),target pos (5)", 2),
            ("time,joint[2].effort,joint[2].reference", 2),
            ("time,ctrl/travel,ctrl/force", 1),
            ("time,rpm,voltage", 2),
        ] {
            let loaded = load(
                table(
                    header,
                    |_, t, v, y| if input == 1 { format!("{t},{v},{y}") } else { format!("{t},{y},{v}") },
                ),
                &[],
            );
            assert_eq!(signals(&loaded)[0], truth().0, "{header}: {}", loaded.reported);
            assert!(!loaded.reported.to_string().contains("no name says"), "{header}: {}", loaded.reported);
        }
    }

    #[test]
    fn without_names_the_input_is_the_one_that_the_other_follows() {
        for header in ["", "time,a,b\n", "time,Volt,Volt\n", "x-axis,1,2\nsecond,Volt,Volt\n"] {
            for is_first in [true, false] {
                let row = |(t, v, y): (f64, f64, f64)| match is_first {
                    true => format!("{t},{v},{y}\n"),
                    false => format!("{t},{y},{v}\n"),
                };
                let text: String = std::iter::once(header.to_owned()).chain(rows().map(row)).collect();
                let loaded = is_the_record(text, &[], "no name says which column is the input");
                assert_eq!(loaded.plan.columns.input, loaded.plan.columns.input, "{header}");
            }
        }
    }

    #[test]
    fn a_signal_in_volts_and_in_its_unit_is_taken_in_its_unit() {
        let text = table("time,Force (V),Force (N),Travel (V),Travel (mm),force_raw", |_, t, v, y| {
            format!("{t},{},{y},{},{v},{}", y / 20.0, v / 10.0, 100.0 * y)
        });
        let loaded = is_the_record(text, &[], "`Travel [V]`");
        assert_eq!([&loaded.rig.input_label, &loaded.rig.output_label], ["Travel [mm]", "Force [N]"]);
    }

    #[test]
    fn of_several_channels_the_one_that_moves_is_taken() {
        let text = table("time,target pos (3),pos (3),target pos (5),pos (5),load (5)", |_, t, v, y| {
            format!("{t},1747,1748,{v},{y},40")
        });
        let loaded = is_the_record(text, &[], "pos (5)");
        assert_eq!(loaded.rig.output_label, "pos (5)");
    }

    #[test]
    fn a_dead_log_is_refused_as_one() {
        let refused = refusal(table("time,frame,iq_mA,vq_mV,theta", |k, t, _, _| format!("{t},{k},0,0,0")));
        assert!(
            refused.contains("none of the columns ever moves: `iq [mA]`, `vq [mV]`, `theta`"),
            "{refused}"
        );
    }
}

mod counters {
    use super::*;

    #[test]
    fn an_angle_that_wraps_is_continued() {
        let text = table("time,command,angle [deg]", |_, t, v, y| {
            format!("{t},{v},{}", (8.0 * y + 300.0).rem_euclid(360.0))
        });
        let loaded = load(text, &[]);
        assert!(loaded.reported.to_string().contains("`angle [deg]` wraps at 360"), "{}", loaded.reported);
        let y = &signals(&loaded)[1];
        let off = y[0] - 8.0 * truth().1[0];
        assert_close(y, &truth().1.iter().map(|y| 8.0 * y + off).collect::<Vec<_>>(), 1e-6);
    }

    #[test]
    fn signs_in_a_bit_are_signs() {
        let coded = [
            (
                Box::new(|y: f64| if y < 0.0 { 32_768.0 - y } else { y }) as Box<dyn Fn(f64) -> f64>,
                "has its sign in bit 15",
            ),
            (Box::new(|y: f64| y.rem_euclid(65_536.0)), "is a two's complement of 16 bits"),
        ];
        for (code, said) in coded {
            let text =
                table("time,command,speed", |_, t, v, y| format!("{t},{v},{}", code((100.0 * y).round())));
            let loaded = load(text, &[]);
            assert!(loaded.reported.to_string().contains(said), "{}", loaded.reported);
            assert_eq!(
                signals(&loaded)[1],
                truth().1.iter().map(|y| (100.0 * y).round()).collect::<Vec<_>>()
            );
        }
    }

    #[test]
    fn a_letter_gives_a_magnitude_its_sign() {
        let text = table("time,travel,force,state", |_, t, v, y| {
            format!("{t},{v},{},{}", y.abs(), if y < 0.0 { "D" } else { "C" })
        });
        is_the_record(text, &[], "`force` is a magnitude, and `state` its sign");
    }
}

mod headers {
    use super::*;

    #[test]
    fn the_line_with_most_names_is_the_header() {
        for head in [
            "time,travel,force\ns,mm,N",
            "s,mm,N\ntime,travel,force",
            "x-axis,travel,force\nsecond,millimeter,Newton",
            "time,travel,force\ns,mm,N\nraw,raw,raw",
            "0,1,2",
            "# time  travel  force",
            "# name: time  name: travel  name: force\n# unit: s  unit: mm  unit: N",
        ] {
            let loaded = is_the_record(format!("{head}\n{}", lines(",", point)[0..].join("\n")), &[], "");
            let is_named = loaded.rig.input_label.contains("travel") || head == "0,1,2";
            assert!(is_named, "{head}: {}", loaded.rig.input_label);
        }
    }

    #[test]
    fn short_rows_and_commas_to_spare_are_empty_cells() {
        is_the_record(
            table("time,travel,force,Comment", |k, t, v, y| {
                if k == 0 { format!("{t},{v},{y},begin") } else { format!("{t},{v},{y}") }
            }),
            &[],
            "have fewer than 4 cells",
        );
        let preamble = format!("Range;10;20;30;40\n{}", lines(";", point).join("\n"));
        is_the_record(preamble, &[], "line 1 above the table left out");
        is_the_record(table("time,travel,force,", |_, t, v, y| format!("{t},{v},{y},")), &[], "");
        is_the_record(table("time,travel,force", |_, t, v, y| format!("{t},{v},{y},")), &[], "");
        is_the_record(table("time,travel,force,", |_, t, v, y| format!("{t},{v},{y}")), &[], "");
    }

    #[test]
    fn a_header_that_comes_again_is_no_row() {
        let again = |k: usize| if k > 0 && k.is_multiple_of(50) { "time,travel,force\n" } else { "" };
        let text = table("time,travel,force", |k, t, v, y| format!("{}{t},{v},{y}", again(k)));
        is_the_record(text, &[], "the header again at 11 lines, the first of them 52");
        let without_time = table("travel,force", |k, _, v, y| {
            format!("{}{v},{y}", if k == 300 { "travel,force\n" } else { "" })
        });
        let loaded = load(without_time, &["--rate", "100"]);
        assert_eq!(loaded.rig.records[0].record.len(), 300, "a record begins: {}", loaded.reported);
    }

    #[test]
    fn instruments_state_the_sample_time_above_the_table() {
        let rigol = format!(
            "X,CH1,CH2,Start,Increment,\nSequence,VOLT,VOLT,-1.2e+01,1.0e-02\n{}",
            rows().enumerate().fold(String::new(), |mut text, (k, (_, v, y))| {
                let _ = writeln!(text, "{k},{v},{y},,");
                text
            })
        );
        is_the_record(rigol, &[], "0.01 s (100 Hz), as stated above the table");
        for line in ["Sample rate;100", "Abtastzeit [ms];10", "Sampling frequency: 0.1 kHz"] {
            let text = format!("Bench 4\n{line}\n{}", table("travel;force", |_, _, v, y| format!("{v};{y}")));
            is_the_record(text, &[], "as stated above the table");
        }
    }

    #[test]
    fn a_measurement_file_of_labview_is_read() {
        let text = format!(
            "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n***End_of_Header***\t\n\t\t\t\nChannels\t2\t\t\nDelta_X\t0.01\t0.01\t\n***End_of_Header***\t\t\t\n{}",
            table("X_Value\tTravel\tForce\tComment", |_, t, v, y| format!("{t}\t{v}\t{y}"))
        );
        is_the_record(text, &[], "tabs between columns");
    }
}

mod plausibility {
    use super::*;

    #[test]
    fn records_in_other_units_are_told_with_the_factor() {
        let metres = table("time,travel,force", |_, t, v, y| format!("{t},{},{y}", v / 1000.0));
        let bench =
            Bench::new().with("a.csv", table("time,travel,force", |_, t, v, y| format!("{t},{v},{y}")));
        let loaded = bench.with("b.csv", metres).load(&["a.csv", "b.csv"]).expect("good files");
        let reported = loaded.reported.to_string();
        assert!(reported.contains("1000 times as much: check that both are in one unit"), "{reported}");
        let lengths = table("time,command [m],position [mm]", |_, t, v, y| format!("{t},{v},{y}"));
        let reported = load(lengths, &[]).reported.to_string();
        assert!(reported.contains("the gain holds a factor of 1000"), "{reported}");
    }

    #[test]
    fn strokes_that_are_all_alike_are_told() {
        let sine = |k: usize| 10.0 * (0.1 * k as f64).sin();
        let text = table("time,travel,force", |k, t, _, y| format!("{t},{},{}", sine(k), y + sine(k)));
        let reported = load(text, &[]).reported.to_string();
        assert!(reported.contains("strokes of `travel` run between -10 and 10"), "{reported}");
        let free = table("time,travel,force", |_, t, v, y| format!("{t},{v},{y}"));
        assert!(!load(free, &[]).reported.to_string().contains("strokes"));
    }

    #[test]
    fn outputs_outside_a_model_s_band_are_told() {
        let good = table("time,travel,force", |_, t, v, y| format!("{t},{v},{y}"));
        let other = table("time,travel,force", |_, t, v, y| format!("{t},{v},{}", y + 100.0));
        let bench = Bench::new().with("a.csv", good).with("b.csv", other);
        assert!(
            bench
                .switchback(&["identify", "a.csv", "--out", "found", "--quiet"])
                .output()
                .expect("it runs")
                .status
                .success()
        );
        let said = |file: &str| {
            let run = bench
                .switchback(&["simulate", "found/model.json", file, "--out", "run.csv", "--force"])
                .output();
            let run = run.expect("it runs");
            String::from_utf8_lossy(&[run.stdout, run.stderr].concat()).into_owned()
        };
        assert!(
            said("b.csv").contains("of the measured outputs lie within the 95 % band"),
            "{}",
            said("b.csv")
        );
        assert!(!said("a.csv").contains("outputs lie within"), "{}", said("a.csv"));
    }
}

mod long_files {
    use super::*;

    /// The record over and over, with a clock that goes on: 34 MB, which is long enough to be looked at part by part.
    fn long(last: &str) -> String {
        let (v, y) = truth();
        let mut text = String::from("time [s],travel [mm],force [N]\n");
        let mut row = 0;
        while text.len() < 34 << 20 {
            let (k, turn) = (row % SAMPLES, row / SAMPLES % 2);
            // There and back, so that nothing jumps.
            let k = if turn == 0 { k } else { SAMPLES - 1 - k };
            let _ = writeln!(text, "{:.2},{},{}", row as f64 / 100.0, v[k], y[k]);
            row += 1;
        }
        text + last
    }

    #[test]
    fn init_says_the_same_of_a_long_file_as_of_one_that_is_read_whole() {
        let bench = Bench::new().with("bench.csv", long(""));
        let survey = bench.survey("bench.csv").expect("a good file");
        let loaded = bench.load(&["bench.csv"]).expect("a good file");
        assert_eq!(manifest(&survey.plan, None), manifest(&loaded.plan, None));
        let samples: usize = loaded.rig.records.iter().map(|record| record.record.len()).sum();
        let reported = survey.reported.to_string();
        assert!(reported.contains(&format!("{samples} samples looked at in")), "{reported}");
    }

    #[test]
    fn a_fault_at_the_end_of_a_long_file_is_reported() {
        let bench = Bench::new().with("bench.csv", long("1e9,oops,1\n1e9,2,1\n"));
        let error = bench.survey("bench.csv").expect_err("a bad file");
        assert!(switchback_io::output::plain(&error).contains("`oops` is not a number"));
    }
}

/// Every file of the collection beside the repository, where it is there, ends as its description says.
#[test]
fn cases_of_the_field_are_read_at_the_first_attempt() {
    let cases = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases/make.py");
    let bench_file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/data/bench.csv");
    let bench = Bench::new();
    let made =
        std::process::Command::new("python3").arg(&cases).arg(bench_file).arg(bench.path("cases")).output();
    if !cases.exists() || !made.is_ok_and(|made| made.status.success()) {
        eprintln!("skipped: there is no ../shared/cases, or no python3");
        return;
    }
    let read = |name: &str| {
        let path = bench.path(&format!("cases/{name}")).display().to_string();
        bench.load(&[path.as_str()])
    };
    let bench_record: Vec<[f64; 2]> = {
        let text = std::fs::read_to_string(bench.path("cases/order/no-header.csv")).expect("a case");
        let row = |line: &str| -> Option<[f64; 2]> {
            let mut cells = line.split(',').skip(1).map(|cell| cell.parse().ok());
            let (y, v) = (cells.next()??, cells.next()??);
            Some([v, y])
        };
        text.lines().filter_map(row).collect()
    };
    // The whole record, in the units of the file, at 200 Hz.
    for (name, factors) in [
        ("nanoseconds/even.csv", [1.0, 1.0]),
        ("nanoseconds/sparse.csv", [1.0, 1.0]),
        ("labview/notes.lvm", [1.0, 1.0]),
        ("labview/comma.lvm", [1.0, 1.0]),
        ("tdm/dump.csv", [1.0, 1.0]),
        ("scope/increment.csv", [1.0, 1.0]),
        ("scope/names-units.csv", [1.0, 1.0]),
        ("scope/comments.csv", [1.0, 1.0]),
        ("scope/leading-semicolons.csv", [1.0, 1.0]),
        ("scope/six-digits.csv", [1.0, 1.0]),
        ("header/quoted-comma.csv", [1.0, 1.0]),
        ("header/repeated.csv", [1.0, 1.0]),
        ("order/actual-command.csv", [1.0, 1.0]),
        ("order/no-header.csv", [1.0, 1.0]),
        ("order/joint.csv", [1.0, 1.0]),
        ("counter/magnitude.csv", [1.0, 1.0]),
        ("events/back.csv", [1.0, 1.0]),
        ("episodes/one-file.csv", [1.0, 1.0]),
        ("episodes/continued.csv", [1.0, 1.0]),
        ("stamps/excel.csv", [1.0, 1.0]),
        ("stamps/ros.csv", [1.0, 1.0]),
        ("stamps/german.csv", [1.0, 1.0]),
        ("twice/dyno.csv", [1.0, 1000.0]),
        ("units/metres.csv", [0.001, 1000.0]),
    ] {
        let loaded =
            read(name).unwrap_or_else(|error| panic!("{name}: {}", switchback_io::output::plain(&error)));
        assert!((loaded.rig.sample_time - 0.005).abs() < 1e-6, "{name}: {}", loaded.reported);
        for (k, found) in signals(&loaded).iter().enumerate() {
            let wanted: Vec<f64> = bench_record.iter().map(|row| factors[k] * row[k]).collect();
            println!("{name}");
            assert_close(found, &wanted, 1e-3 * factors[k]);
        }
    }
    for (name, said) in [
        ("held/input-blank.csv", "`travel` at 20 Hz, `force` at 200 Hz"),
        ("held/input.csv", "changes at every 10th row only"),
        ("nanoseconds/interleaved.csv", "at 200 Hz"),
        ("clocks/two.csv", "joined on time"),
        ("counter/wrap.csv", "wraps at 360"),
        ("servo/steps.csv", "input `target pos (5)`, output `pos (5)`"),
        ("gaps/blank-rows.csv", "2 dropouts"),
        ("gaps/blank-values.csv", "2 dropouts"),
        ("sine/one-amplitude.csv", "strokes of `travel` run between"),
        ("constant/step.csv", "only rises in all that is fitted"),
    ] {
        let loaded =
            read(name).unwrap_or_else(|error| panic!("{name}: {}", switchback_io::output::plain(&error)));
        assert!(loaded.reported.to_string().contains(said), "{name}: {}", loaded.reported);
    }
    for (name, said) in [
        ("telemetry/all-zero.csv", "none of the columns ever moves"),
        ("constant/duty.csv", "the input `PWM` never moves"),
        ("scope/mixed-units.csv", "mixed-units.csv:202: column `time [ms]`: its unit changes"),
        ("units/no-time.csv", "the sample time is not known"),
    ] {
        let error = read(name).expect_err(name);
        assert!(switchback_io::output::plain(&error).contains(said), "{name}");
    }
}
