//! The differences between a machine and what was compared with it, in sentences and as a table.

use super::probability::probability;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_diagnose::Status;
use switchback_diagnose::differences::{Basis, Differences, RowKind, is_imitation};
use switchback_io::diagnosis::{Report, ReportedDifference, Source, Units, digits, whole_percent};
use switchback_io::output::{columns, wrapped};
use switchback_model::alignment::unit_factor;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Difference {
    /// The quantity.
    pub what: String,
    /// `parameter`: both sides have it; `effect`: an effect of either side.
    pub kind: String,
    /// The effect whose parameter it is; null for a parameter.
    pub effect: Option<String>,
    /// Its value in what was compared with the machine, a delay relative to the machine's; zero for the strength of an effect that this lacks, null for its shape.
    pub in_a: Option<f64>,
    /// Its value in the machine.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub in_b: f64,
    /// Standard error of `in_b`.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub se: f64,
    /// Unit of these; empty for a pure number.
    pub unit: String,
    /// Probability that the values differ.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability: f64,
    /// Whether they do.
    pub differs: bool,
    /// Share of the gap that would stay without aligning this one, all others fitted again.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    pub closure: f64,
    /// The attribute of a MuJoCo joint that it is, where it is one.
    pub attribute: Option<String>,
}

/// Every row in the user's units, those that differ first.
pub(crate) fn reported(report: &Report, differences: &Differences) -> Vec<ReportedDifference> {
    let units = Units::of(&report.rig);
    differences.rows.iter().map(|row| ReportedDifference::of(row, &units)).collect()
}

/// The rows as they are written.
pub(super) fn written(report: &Report) -> Vec<Difference> {
    let Some(found) = &report.diagnosis.differences else { return Vec::new() };
    let one = |row: ReportedDifference| Difference {
        what: row.what,
        kind: match row.kind {
            RowKind::Parameter => "parameter".to_owned(),
            RowKind::Effect => "effect".to_owned(),
        },
        effect: row.effect.map(str::to_owned),
        in_a: Some(row.in_a).filter(|x| x.is_finite()),
        in_b: row.in_b,
        se: row.se,
        unit: row.unit,
        probability: row.probability,
        differs: row.differs,
        closure: row.closure,
        attribute: row.attribute.map(str::to_owned),
    };
    reported(report, found).into_iter().map(one).collect()
}

/// `transition length`.
fn name(row: &ReportedDifference) -> String {
    row.what.replace('_', " ")
}

/// The same with the attribute of MuJoCo that it is.
fn with_attribute(row: &ReportedDifference) -> String {
    match row.attribute {
        Some(attribute) => format!("{} (MuJoCo: `{attribute}`)", name(row)),
        None => name(row),
    }
}

/// Decimals of a value that its standard error bears, two digits of that.
fn rounded(value: f64, se: f64) -> String {
    if !(se > 0.0 && se.is_finite()) {
        return digits(value, 4);
    }
    let decimals = (1.0 - se.log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.replace('-', "") } else { text.replace('-', "−") }
}

fn with_unit(text: String, unit: &str) -> String {
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

/// Digits of a value of the source where the machine's is far more certain, or nothing.
fn of_source(row: &ReportedDifference) -> String {
    if row.in_a.is_nan() { "–".to_owned() } else { rounded(row.in_a, row.se) }
}

fn of_machine(row: &ReportedDifference) -> String {
    with_error(row.in_b, row.se)
}

/// `0.0050 ± 0.0003`: both with the decimals that the error bears.
fn with_error(value: f64, se: f64) -> String {
    format!("{} ± {}", rounded(value, se), rounded(se, se))
}

/// The answer in sentences: what differs, what does not, what to set, and what then remains.
pub(super) fn sentences(report: &Report, differences: &Differences) -> Vec<String> {
    let rows = reported(report, differences);
    let source = report.source.in_words();
    let (off, same): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row.differs);
    if differences.basis == Basis::Nominal {
        return vec![format!(
            "On these records {source} runs as the model without effects that fits them best, so that the cause is what this model lacks, too. Single values that \
             differ from the machine's ({}, in the table) make up for it.",
            off.len()
        )];
    }
    let is_imitation = differences.basis == Basis::Errors && is_imitation(&differences.rows);
    let mut sentences = Vec::new();
    match report.diagnosis.verdict.status {
        Status::None if off.is_empty() => {
            sentences.push(format!("No value of {source} differs from the machine's, and nothing is missing in it."));
        }
        _ if off.is_empty() => sentences.push(format!(
            "No value of {source} differs from the machine's and no effect known here is missing in it, and yet it misses more than the noise."
        )),
        _ => {
            let largest: Vec<String> = off.iter().take(SHOWN).map(|row| difference(row, source)).collect();
            let largest = largest.join("; ");
            sentences.push(match off.len() {
                count if is_imitation => format!(
                    "Only {count} differences together bring {source} near the machine: they imitate a cause, and none of them is one. The \
                     largest (the table has all): {largest}."
                ),
                count if count > SHOWN => format!("What differs: {largest}; {} more in the table.", count - SHOWN),
                _ => format!("What differs: {largest}."),
            });
        }
    }
    if let Some(known) = off.iter().find_map(|row| known_factor(row)) {
        sentences.push(known);
    }
    let alike: Vec<String> = same.iter().filter(|row| is_listed(row)).map(|row| the_same(row)).collect();
    if !alike.is_empty() {
        sentences.push(format!("The same on both sides: {}.", alike.join(", ")));
    }
    if !off.is_empty() && !is_imitation {
        sentences.push(advice(report, &off));
        sentences.extend(closed(report));
    }
    sentences
}

/// Differences in sentences; the table has all.
const SHOWN: usize = 4;

/// Shapes of effects that are not there are no values of either side.
fn is_listed(row: &ReportedDifference) -> bool {
    row.in_a.is_finite()
}

fn the_same(row: &ReportedDifference) -> String {
    match row.what.as_str() {
        "gain" | "offset" | "delay" => name(row),
        _ => format!("{} {}", name(row), with_unit(of_machine(row), &row.unit)),
    }
}

fn difference(row: &ReportedDifference, source: &str) -> String {
    let closes =
        format!("without it {} % of the gap would stay", whole_percent(100.0 * row.closure.clamp(0.0, 1.0)));
    match row.what.as_str() {
        "delay" => {
            let by = with_unit(with_error(row.in_a.abs(), row.se), &row.unit);
            let side = if row.in_a > 0.0 { "later" } else { "earlier" };
            format!("{source} answers {by} {side} than the machine ({closes})")
        }
        "gain" if row.in_b < 0.0 => format!(
            "the sign of {source} is turned: its gain is {} times the machine's ({closes})",
            rounded(1.0 / row.in_b, row.se / (row.in_b * row.in_b))
        ),
        "gain" => format!("the machine's gain is {} times that of {source} ({closes})", of_machine(row)),
        "offset" => format!(
            "the machine's zero lies {} from that of {source} ({closes})",
            with_unit(of_machine(row), &row.unit)
        ),
        _ if row.kind == RowKind::Effect && row.in_a == 0.0 => format!(
            "{source} lacks {}: {} {} ({closes})",
            row.effect.unwrap_or_default().replace('_', " "),
            name(row),
            with_unit(of_machine(row), &row.unit)
        ),
        _ if row.in_a.is_nan() => {
            format!("with a {} of {}", name(row), with_unit(of_machine(row), &row.unit))
        }
        _ => format!(
            "{} is {} in {source} and {} in the machine ({closes})",
            name(row),
            with_unit(of_source(row), &row.unit),
            with_unit(of_machine(row), &row.unit)
        ),
    }
}

/// A factor that units make, where the gain is one.
fn known_factor(row: &ReportedDifference) -> Option<String> {
    let factor = unit_factor(row.in_b).filter(|_| row.what == "gain")?.abs();
    (factor != 1.0).then(|| format!("A factor of 10^{:.0}: compare the units of both.", factor.log10()))
}

/// What to set, in an imperative.
fn advice(report: &Report, off: &[&ReportedDifference]) -> String {
    let one = |row: &&&ReportedDifference| match row.what.as_str() {
        "delay" => format!("take {} of delay out of it", with_unit(rounded(row.in_a, row.se), &row.unit)),
        "gain" => format!("multiply its output by {}", rounded(row.in_b, row.se)),
        "offset" => format!("add {} to its output", with_unit(rounded(row.in_b, row.se), &row.unit)),
        _ => {
            let plain = with_attribute(row);
            if row.kind == RowKind::Effect && row.in_a == 0.0 {
                format!("give it a {plain} of {}", with_unit(rounded(row.in_b, row.se), &row.unit))
            } else {
                format!(
                    "set its {plain} from {} to {}",
                    of_source(row),
                    with_unit(rounded(row.in_b, row.se), &row.unit)
                )
            }
        }
    };
    let steps: Vec<String> = off.iter().filter(|row| is_listed(row)).map(|row| one(&row)).collect();
    let what = match report.source {
        Source::Identified | Source::Given => "In the given model",
        Source::Predicted => "In the simulator",
        Source::Against => "To bring the other records to these",
    };
    format!("{what}: {}.", steps.join(", "))
}

/// How far that closes the gap, and what remains.
fn closed(report: &Report) -> Option<String> {
    let gap = &report.diagnosis.gap;
    let units = Units::of(&report.rig);
    let floor = format!("the noise floor (sd {})", with_unit(digits(gap.noise_floor, 2), &units.output));
    let share = gap.closure.as_ref().map(|closure| closure.estimate.clamp(0.0, 1.0));
    let closes = share.map(|share| format!("That closes {} % of the gap", whole_percent(100.0 * share)));
    let remains = match gap.after.ci90[0] <= 0.0 {
        true => format!("what remains is {floor}"),
        false => format!(
            "what remains, {} % of the output's variance, lies above {floor}",
            digits(100.0 * gap.after.estimate, 2)
        ),
    };
    Some(match closes {
        Some(closes) => format!("{closes}; {remains}."),
        None => format!("Then {remains}."),
    })
}

/// The table for a terminal.
pub(super) fn table(report: &Report, differences: &Differences) -> String {
    let head = ["", "quantity", "there", "in the machine", "unit", "probability", "closes %"];
    let mut lines = vec![head.map(str::to_owned)];
    for row in reported(report, differences) {
        lines.push([
            if row.differs { "differs" } else { "same" }.to_owned(),
            name(&row),
            of_source(&row),
            of_machine(&row),
            row.unit.clone(),
            probability(row.probability),
            if row.differs { whole_percent(100.0 * row.closure.clamp(0.0, 1.0)) } else { String::new() },
        ]);
    }
    let note = wrapped(
        "probability: that the values differ. A delay is that of the source against the machine; `closes`: the share of the gap that would stay without this value, the others fitted again.",
        "",
    );
    format!("{}{note}", columns(&lines))
}
