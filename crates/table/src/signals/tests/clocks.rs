//! Clocks of numbers without a unit.

use super::*;
use crate::table::TableError;

fn timed(time: impl Fn(usize) -> f64, sample_time: Option<f64>) -> Measured {
    let machine = Machine::new(1);
    let stamps: Vec<f64> = (0..SAMPLES).map(time).collect();
    let columns: [(&str, &[f64]); 3] =
        [("timestamp", &stamps), ("travel", &machine.input), ("force", &machine.output)];
    read(&columns, &ColumnNames::default(), sample_time).expect("a good clock")
}

#[test]
fn whole_numbers_count_in_the_unit_of_a_likely_rate_and_that_is_doubted() {
    for (step, unit, seconds) in
        [(2500, "us", 0.0025), (1000, "us", 0.001), (5, "ms", 0.005), (20, "ms", 0.02), (100, "ms", 0.1)]
    {
        let measured = timed(|k| f64::from(84_213 + step * k as i32), None);
        assert_eq!(measured.sample_time, seconds, "{step}");
        let said = format!("`timestamp` has no unit and is taken as {unit}");
        assert!(measured.doubts.iter().any(|doubt| doubt.contains(&said)), "{:?}", measured.doubts);
    }
}

#[test]
fn large_whole_numbers_that_are_no_date_count_in_the_unit_of_a_likely_rate() {
    for (start, step, unit, seconds) in
        [(5.123_456_789e12, 1e7, "ns", 0.01), (5.0e11, 1e7, "ns", 0.01), (1.2e11, 5e3, "us", 0.005)]
    {
        let measured = timed(|k| start + step * k as f64, None);
        assert!((measured.sample_time / seconds - 1.0).abs() < 1e-9, "{step}: {}", measured.sample_time);
        let said = format!("`timestamp` has no unit and is taken as {unit}");
        assert!(measured.doubts.iter().any(|doubt| doubt.contains(&said)), "{:?}", measured.doubts);
    }
    for (step, seconds) in [(10.0, 0.01), (10_000.0, 10.0)] {
        let dated = timed(|k| 1.683_195_121e12 + step * k as f64, None);
        assert!((dated.sample_time / seconds - 1.0).abs() < 1e-9, "{step}: {}", dated.sample_time);
        assert!(dated.table.notes.iter().any(|note| note.contains("milliseconds since 1970")));
    }
}

/// What is inferred of a machine whose rows stand behind a date and a time of day.
fn dated(
    head: &str,
    date: impl Fn(usize) -> String,
    time: impl Fn(usize) -> String,
) -> Result<Measured, String> {
    let Machine { input, output } = Machine::new(1);
    let row = |k: usize| {
        let (date, time) = (date(k), time(k));
        format!("\"Data\",\"{date}\",\"{time}\",{},{}\n", input[k], output[k])
    };
    let rows: String = (0..SAMPLES).map(row).collect();
    let text = format!("{head}\"Header:\",\"Date\",\"Time\",\"command\",\"feedback\"\n{rows}");
    let table = Table::parse(&text, 2).map_err(|_| "no table".to_owned())?;
    let input_form = InputForm::CommandLine("switchback init log.csv".to_owned());
    let names = ColumnNames::default();
    let request =
        Request { names: &names, sampling: Sampling::default(), input_form: &input_form, needs_output: true };
    Measured::of(table, request).map_err(|problems| match &problems[0] {
        TableError::Data(error) => error.to_string(),
        TableError::File(error) => error.to_string(),
    })
}

#[test]
fn a_date_beside_the_time_of_day_belongs_to_the_clock() {
    let written = |k: usize| {
        let ms = 10 * k;
        format!("10:12:{:02};{:03}", ms / 1000, ms % 1000)
    };
    let today = |_: usize| "5/4/2023".to_owned();
    let measured = dated("", today, written).expect("a clock");
    let time = measured.selection.time.map(|k| measured.table.columns[k].name.clone());
    assert_eq!((measured.sample_time, time.as_deref()), (0.01, Some("Time")));
    let changing = |k: usize| (20_230_504 + k / 500).to_string();
    let measured = dated("", changing, written).expect("a clock");
    assert_eq!((measured.sample_time, measured.selection.time), (0.01, Some(2)));
    let unread = |k: usize| format!("10h12 {k}");
    let problem = dated("", today, unread).expect_err("no clock");
    assert!(problem.contains("the times of `Time`, as `10h12 0`, cannot be read"), "{problem}");
    let stated = dated("\"Sample Rate:\",\"10 Milliseconds\"\n", today, unread).expect("a sample time");
    assert_eq!(stated.sample_time, 0.01);
    let still = dated("", today, |_| "noon".to_owned()).expect_err("no clock");
    assert!(!still.contains("cannot be read"), "{still}");
}

#[test]
fn a_sample_time_that_was_given_settles_the_unit() {
    for (step, seconds) in [(2500, 0.0025), (10, 10.0), (10, 0.01), (500, 0.5)] {
        let measured = timed(|k| f64::from(step * k as i32), Some(seconds));
        assert_eq!(measured.sample_time, seconds);
        assert!(!measured.doubts.iter().any(|doubt| doubt.contains("no unit")), "{:?}", measured.doubts);
    }
}

#[test]
fn seconds_stay_seconds() {
    let second = timed(|k| k as f64, None);
    assert_eq!(second.sample_time, 1.0);
    let said = "`timestamp` has no unit and is taken as seconds, which makes 1 Hz";
    assert!(second.doubts.iter().any(|doubt| doubt.contains(said)), "{:?}", second.doubts);
    assert_eq!(timed(|k| 0.5 * k as f64, None).sample_time, 0.5);
    let machine = Machine::new(1);
    let stamps: Vec<f64> = (0..SAMPLES).map(|k| 10.0 * k as f64).collect();
    let own: [(&str, &[f64]); 3] = [("t", &stamps), ("v", &machine.input), ("y", &machine.output)];
    let measured = read(&own, &ColumnNames::default(), None).expect("the program's own form");
    assert_eq!((measured.sample_time, measured.doubts.len()), (10.0, 0));
}

#[test]
fn times_of_day_in_one_number_are_read_over_the_minute() {
    let clock = |k: usize| {
        let second = 43_195.0 + 0.02 * k as f64;
        let (hour, minute) = ((second / 3600.0).floor(), (second / 60.0).floor() % 60.0);
        printed(10_000.0 * hour + 100.0 * minute + second % 60.0)
    };
    let measured = timed(clock, None);
    assert!((measured.sample_time - 0.02).abs() < 1e-9 && measured.pieces.len() == 1);
    assert!(measured.table.notes.iter().any(|note| note.contains("HHMMSS")), "{:?}", measured.table.notes);
}

/// Reads the two signals of a machine between two other columns.
fn beside(first: (&str, &[f64]), last: (&str, &[f64])) -> Result<Measured, String> {
    let machine = Machine::new(1);
    let columns = [first, ("ref [mm]", &machine.input[..]), ("x_meas [mm]", &machine.output[..]), last];
    read(&columns, &ColumnNames::default(), None)
}

#[test]
fn a_clock_increases_and_durations_are_none() {
    let even: Vec<f64> = (0..SAMPLES).map(|k| printed(0.005 * k as f64)).collect();
    let took = bystander(2.0, 9);
    for name in ["task/turnaroundTime", "Time of task", "Zykluszeit [ms]", "dead time"] {
        let measured = beside(("xAxis", &even), (name, &took)).expect(name);
        assert_eq!((measured.selection.time, measured.sample_time), (Some(0), 0.005), "{name}");
        assert_taken(&measured, ["ref", "x_meas"], None);
    }
    let refused = beside(("travel", &even), ("time", &took)).unwrap_err();
    assert!(refused.contains("`--time travel`, which increases evenly"), "{refused}");
}

#[test]
fn speeds_show_the_unit_of_the_clock_of_their_positions() {
    let machine = Machine::new(1);
    let count: Vec<f64> = (1..=SAMPLES).map(|k| k as f64).collect();
    let place = &machine.output;
    let between = |k: usize| place[(k + 1).min(SAMPLES - 1)] - place[k.saturating_sub(1)];
    for (unit, said) in [(1e-3, Some("taken as ms, in which `q[1]` changes")), (1.0, None)] {
        let speed: Vec<f64> = (0..SAMPLES).map(|k| 0.5 * between(k) / unit).collect();
        let columns: [(&str, &[f64]); 4] =
            [("time", &count), ("q_d[1]", &machine.input), ("q[1]", place), ("dq[1]", &speed)];
        let measured = read(&columns, &ColumnNames::default(), None).expect("a good clock");
        assert_eq!(measured.sample_time, unit);
        assert_taken(&measured, ["q_d[1]", "q[1]"], said);
    }
}
