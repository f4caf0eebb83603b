//! A plan as words and as JSON.

use super::{Costs, Forecast, Plan};
use serde::Serialize;
use std::fmt::Write;
use switchback_io::output::{columns, stamped};

/// What a plan says of a study of that name: the constants, a table over numbers of tasks, where more stop helping, and how many are done in time.
pub fn to_text(name: &str, plan: &Plan<'_>, (tasks, within): (usize, Option<f64>)) -> String {
    let costs = &plan.costs;
    let mut text = format!(
        "{name}: {} {}, {} on one thread of this machine in one run, report included\n\n",
        costs.pieces,
        plural(costs),
        time(plan.of_one_run())
    );
    text += &columns(&constants(costs));
    text += "\n";
    let head = ["tasks", "longest task", "merge", "report after", "processor time", "over one run", "disk"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(plan.table(tasks).iter().map(|forecast| row(forecast, plan)));
    text += &columns(&rows);
    let enough = plan.enough();
    let _ = writeln!(
        text,
        "\nEach task is given one thread and {} of memory. `report after` is with a processor for each task, nothing waiting.\n\
         From {enough} tasks on, twice as many save less than a tenth of that time.",
        size(costs.memory)
    );
    match within.map(|seconds| (seconds, plan.within(seconds))) {
        None => {}
        Some((seconds, Some(forecast))) => {
            let tasks = if forecast.tasks == 1 { "task" } else { "tasks" };
            let _ = writeln!(
                text,
                "Within {}: {} {tasks} or more, with a processor for each; {} on disk.",
                time(seconds),
                forecast.tasks,
                size(forecast.disk)
            );
        }
        Some((seconds, None)) => {
            let _ = writeln!(text, "Within {}: no number of tasks is enough.", time(seconds));
        }
    }
    text
}

#[derive(Serialize)]
struct Told<'a> {
    name: &'a str,
    /// Seconds and bytes that were measured.
    costs: &'a Costs,
    /// Seconds of one run.
    one_run: f64,
    forecasts: Vec<Forecast>,
    /// From how many tasks on twice as many save less than a tenth of the time.
    enough: usize,
    /// What is done within the time asked for.
    within: Option<Forecast>,
}

/// The same as one JSON object.
pub fn to_json(name: &str, plan: &Plan<'_>, (tasks, within): (usize, Option<f64>)) -> String {
    let told = Told {
        name,
        costs: &plan.costs,
        one_run: plan.of_one_run(),
        forecasts: plan.table(tasks),
        enough: plan.enough(),
        within: within.and_then(|seconds| plan.within(seconds)),
    };
    stamped("switchback/plan/1", &told)
}

fn plural(costs: &Costs) -> String {
    if costs.piece == "batch" { "batches".to_owned() } else { format!("{}s", costs.piece) }
}

/// What was measured, a line each.
fn constants(costs: &Costs) -> Vec<[String; 3]> {
    let error = if costs.per_piece_error > 0.0 {
        format!("± {}", time(costs.per_piece_error))
    } else {
        String::new()
    };
    let mut rows = vec![
        ["start".to_owned(), time(costs.start), String::new()],
        [format!("a {}", costs.piece), time(costs.per_piece), error],
    ];
    for part in costs.of_a_piece.iter().filter(|part| part.count > 1.0) {
        let of = format!("× {:.3e} a {}", part.count, costs.piece);
        rows.push([format!("  {}", part.name), time(part.seconds), of]);
    }
    rows.push(["a megabyte out".to_owned(), time(1e6 * costs.per_byte_out), String::new()]);
    rows.push(["a megabyte in".to_owned(), time(1e6 * costs.per_byte_in), String::new()]);
    if costs.per_byte_added > 0.0 {
        rows.push(["a megabyte added".to_owned(), time(1e6 * costs.per_byte_added), String::new()]);
    }
    rows.push(["report".to_owned(), time(costs.report), String::new()]);
    rows
}

fn row(forecast: &Forecast, plan: &Plan<'_>) -> [String; 7] {
    [
        forecast.tasks.to_string(),
        time(forecast.longest),
        time(forecast.merge),
        time(forecast.at_once),
        time(forecast.processor),
        format!("{:.2}", forecast.processor / plan.of_one_run()),
        size(forecast.disk),
    ]
}

/// Seconds in a unit that suits them, to three digits.
fn time(seconds: f64) -> String {
    let units = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"), (1e-3, "ms"), (1e-6, "µs")];
    let unit = units.into_iter().find(|(unit, _)| seconds >= 2.0 * unit || (*unit == 1.0 && seconds >= 1.0));
    let (unit, name) = unit.unwrap_or((1e-9, "ns"));
    format!("{} {name}", three_digits(seconds / unit))
}

/// Bytes in a unit that suits them, to three digits.
fn size(bytes: f64) -> String {
    let (unit, name) =
        [(1e9, "GB"), (1e6, "MB")].into_iter().find(|(unit, _)| bytes >= *unit).unwrap_or((1e3, "kB"));
    format!("{} {name}", three_digits(bytes / unit))
}

fn three_digits(x: f64) -> String {
    let before = if x >= 1.0 { x.log10().floor() as usize + 1 } else { 1 };
    format!("{x:.digits$}", digits = 3_usize.saturating_sub(before))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_and_a_unit() {
        assert_eq!(
            [0.0, 3.21e-9, 4.5e-5, 0.0123, 1.5, 90.0, 150.0, 7300.0, 2e6].map(time),
            ["0.00 ns", "3.21 ns", "45.0 µs", "12.3 ms", "1.50 s", "90.0 s", "2.50 min", "2.03 h", "23.1 d"]
        );
        assert_eq!([500.0, 2.5e6, 3.4567e10].map(size), ["0.50 kB", "2.50 MB", "34.6 GB"]);
    }
}
