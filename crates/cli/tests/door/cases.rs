//! The collection beside the repository.

use super::*;

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
