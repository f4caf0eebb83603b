//! The power of a rig's records as a page for a person.

use super::{Context, Finding, LARGEST, Outcome, Power, SIZES};
use crate::generate::InjectedFault;
use std::fmt::Write;
use switchback_io::diagnosis::{Units, digits};
use switchback_io::output::{columns, wrapped};

/// Sizes in the table's columns.
const CLASSES: [(&str, f64, f64); 4] =
    [("below 1", 0.0, 1.0), ("1 to 2", 1.0, 2.0), ("2 to 4", 2.0, 4.0), ("4 and more", 4.0, f64::INFINITY)];

/// A line an effect, a sentence on each, and what sizes mean.
pub fn words(power: &Power, context: &Context<'_>) -> String {
    let units = Units::of(context.rig());
    let mut page = format!("{}\n\n", context.rig().name);
    page.push_str(&table(power));
    page.push_str(&wrapped(
        "found of put in, by size; `no fault`: reported where there is none. Found: named, or in a class or shortlist of at most three effects.",
        "",
    ));
    page.push('\n');
    for finding in &power.findings {
        page.push_str(&wrapped(&format!("{}: {}", finding.effect, sentence(finding, &units)), "  "));
    }
    let _ = write!(page, "\n{}", wrapped(&meaning(power, context, &units), ""));
    page
}

fn table(power: &Power) -> String {
    let mut head = vec!["effect", "found from", "90 % interval"];
    head.extend(CLASSES.map(|(name, ..)| name));
    head.push("no fault");
    let mut rows: Vec<[String; 8]> = vec![row(head.into_iter().map(str::to_owned))];
    for finding in &power.findings {
        let outcome = finding.outcome();
        let [low, high] = finding.conclusion.interval;
        let interval = match outcome {
            Outcome::NotInjected(_) => "–".to_owned(),
            _ if low > LARGEST => end(low),
            _ => format!("[{}, {}]", end(low), end(high)),
        };
        let shares = CLASSES.map(|(_, low, high)| {
            let answers = finding.answers(low, high);
            if answers.of == 0 { "–".to_owned() } else { format!("{}/{}", answers.found(), answers.of) }
        });
        let reported = format!("{}/{}", finding.without_fault, power.bare.len());
        let first = [finding.effect.to_owned(), in_brief(&outcome), interval];
        rows.push(row(first.into_iter().chain(shares).chain([reported])));
    }
    columns(&rows)
}

fn row(cells: impl Iterator<Item = String>) -> [String; 8] {
    let mut cells = cells;
    std::array::from_fn(|_| cells.next().unwrap_or_default())
}

fn in_brief(outcome: &Outcome) -> String {
    match outcome {
        Outcome::From(size) => digits(*size, 2),
        Outcome::NotUpTo(size) => format!("not up to {}", digits(*size, 2)),
        Outcome::Undecided => "undecided".to_owned(),
        Outcome::NotInjected(_) => "not planted".to_owned(),
    }
}

/// An end of an interval of sizes.
fn end(size: f64) -> String {
    match size {
        size if size > LARGEST => format!("> {LARGEST}"),
        size if size < SIZES[0] => format!("< {}", SIZES[0]),
        size => digits(size, 2),
    }
}

fn sentence(finding: &Finding, units: &Units) -> String {
    let all = finding.answers(0.0, f64::INFINITY);
    let mut parts = Vec::new();
    match finding.outcome() {
        Outcome::From(size) => {
            parts.push(format!("from size {} on nine in ten are found", digits(size, 2)));
            parts.extend(finding.closest_to(size).and_then(|fault| in_words(units, fault)));
        }
        Outcome::NotUpTo(size) => parts.push(format!(
            "not found nine times in ten up to {} (there at most {:.0} % of them)",
            digits(size, 2),
            100.0 * finding.found_at_most
        )),
        Outcome::Undecided => parts.push(format!(
            "too few draws to show (`--draws` takes more); at {}, the largest size reached, about {:.0} % are found",
            digits(finding.reached(), 2),
            100.0 * finding.found_next
        )),
        Outcome::NotInjected(reason) => return format!("cannot be planted: {reason}"),
    }
    parts.push(format!("named in {}, in a class or shortlist in {} of {}", all.named, all.in_class, all.of));
    if let Some((answer, count)) = finding.instead() {
        parts.push(format!(
            "missed, the commonest answer was: {answer} ({count} of {})",
            all.of - all.found()
        ));
    }
    if finding.without_fault > 0 {
        parts.push("reported where there is no fault, too, so that finding it proves little".to_owned());
    }
    parts.join("; ")
}

/// What a size and a silence mean.
fn meaning(power: &Power, context: &Context<'_>, units: &Units) -> String {
    let residual = power.findings.iter().flat_map(Finding::diagnosed).map(|(fault, _)| fault.residual).next();
    let one = residual.map_or_else(String::new, |r| format!(" (here {} {} rms)", digits(r, 2), units.output));
    format!(
        "Size 1 is a fault that leaves as much on held-out records, after the model is identified anew, as the {} misses there without it{one}. \
         An effect with a size in the column `found from` that `switchback gap` does not report these records is, nine times in ten, smaller \
         than that here; of every other effect its silence says little.",
        context.source().model()
    )
}

/// A magnitude in the units of the records: lengths along the input in the input's unit, samples in seconds.
pub(super) fn of_magnitude(units: &Units, fault: &InjectedFault) -> (f64, String) {
    match fault.unit {
        crate::generate::INTERVAL_WIDTHS => (fault.magnitude * units.stroke, units.input.clone()),
        "samples" => (fault.magnitude * units.sample_time, "s".to_owned()),
        unit => (fault.magnitude, unit.to_owned()),
    }
}

/// The same in words; none where the magnitude counts the noise and so has no meaning in the field.
fn in_words(units: &Units, fault: &InjectedFault) -> Option<String> {
    let (magnitude, unit) = of_magnitude(units, fault);
    let quantity = fault.quantity.map_or_else(String::new, |quantity| format!("{quantity} "));
    let words = format!(
        "size {} was {quantity}{} {unit} ({})",
        digits(fault.size, 2),
        digits(magnitude, 2),
        fault.law
    );
    (fault.unit != "noise sd").then_some(words)
}
