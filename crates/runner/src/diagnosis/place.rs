//! Where the gap lies, in words.

use super::number::edge;
use super::{Report, Units};
use switchback_gap::Cell;

/// Cells with a q-value below this are told of and coloured: at most this share of them is expected to be chance.
pub const SIGNIFICANT: f64 = 0.05;

/// Share of an axis's energy that the cells named must hold together.
const BULK: f64 = 0.6;

/// How much larger than its share of the axis a place's share of the energy must be to be worth naming.
const CONCENTRATED: f64 = 0.2;

/// The cells of one axis that hold the bulk of the energy.
struct Place<'a> {
    axis: &'static str,
    cells: Vec<&'a Cell>,
    share: f64,
    /// Share of the energy less share of the axis's cells: 0 where the gap is everywhere, near 1 where it is in one place.
    concentration: f64,
}

/// Where the gap is concentrated: on a branch, and on the axis that shows it best. None where no cell is significant.
///
/// Where the simulation shows no gap, the map is that of the one-step errors alone, and the sentence says so.
pub(super) fn place(report: &Report) -> Option<String> {
    let cells = &report.diagnosis.where_;
    if cells.iter().all(|cell| cell.q_value >= SIGNIFICANT) {
        return None;
    }
    let mut axes: Vec<&'static str> = cells.iter().map(|cell| cell.axis).collect();
    axes.dedup();
    let visible = report.diagnosis.gap.before.ci90[0] > 0.0;
    let subject = if visible { "The gap" } else { "What one-step predictions miss" };
    let units = Units::of(&report.rig);
    let places = axes.into_iter().filter_map(|axis| bulk(axis, cells));
    let (branch, mut others): (Vec<Place<'_>>, Vec<Place<'_>>) = places
        .filter(|place| place.concentration >= CONCENTRATED)
        .partition(|place| place.axis == "branch" && place.cells.len() == 1);
    others.retain(|place| place.axis != "branch" && !is_motion(place) && is_one_stretch(place));
    others.sort_by(|x, y| {
        let order = |place: &Place<'_>| (is_indirect(place.axis), -place.concentration);
        order(x).partial_cmp(&order(y)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let told: Vec<String> = branch
        .iter()
        .chain(others.first())
        .map(|place| format!("{} ({:.0} % of its energy)", told(place, &units), 100.0 * place.share))
        .collect();
    Some(match told.is_empty() {
        true => format!("{subject} lies everywhere: no axis of the map holds most of it in few cells."),
        false => format!("{subject} lies {}.", told.join(", ")),
    })
}

/// Records and stretches of time differ by what the input does in them, so they are named only where nothing says it better.
fn is_indirect(axis: &str) -> bool {
    matches!(axis, "record" | "time")
}

/// Whether the cells lie side by side; scattered ones are no place.
fn is_one_stretch(place: &Place<'_>) -> bool {
    let intervals: Option<Vec<_>> = place.cells.iter().map(|cell| edges(&cell.cell)).collect();
    intervals.is_none_or(|intervals| merged(&intervals).len() == 1)
}

/// Whether the place is merely where the input moves, as in most samples.
fn is_motion(place: &Place<'_>) -> bool {
    place.axis == "rest_samples" && place.cells.first().is_some_and(|cell| cell.cell.starts_with("0.0"))
}

/// The fewest cells that hold [`BULK`] of an axis's energy, all of them significant.
fn bulk<'a>(axis: &'static str, cells: &'a [Cell]) -> Option<Place<'a>> {
    let mut ranked: Vec<(usize, &Cell)> = cells.iter().filter(|cell| cell.axis == axis).enumerate().collect();
    let count = ranked.len();
    ranked.sort_by(|x, y| y.1.share.total_cmp(&x.1.share));
    let mut share = 0.0;
    let mut core = Vec::new();
    for (position, cell) in ranked {
        if share >= BULK {
            break;
        }
        if cell.q_value >= SIGNIFICANT {
            return None;
        }
        share += cell.share;
        core.push((position, cell));
    }
    core.sort_by_key(|(position, _)| *position);
    let concentration = share - core.len() as f64 / count as f64;
    Some(Place { axis, cells: core.into_iter().map(|(_, cell)| cell).collect(), share, concentration })
}

/// The ends of a cell that is an interval, `0.1000..0.2000`.
pub fn edges(cell: &str) -> Option<[f64; 2]> {
    let (low, high) = cell.split_once("..")?;
    Some([low.parse().ok()?, high.parse().ok()?])
}

fn told(place: &Place<'_>, units: &Units) -> String {
    let Some(intervals) = place.cells.iter().map(|cell| edges(&cell.cell)).collect::<Option<Vec<_>>>() else {
        return named(place.axis, &place.cells.iter().map(|cell| cell.cell.as_str()).collect::<Vec<_>>());
    };
    let merged = merged(&intervals);
    let each =
        |tell: &dyn Fn([f64; 2]) -> String| merged.iter().map(|i| tell(*i)).collect::<Vec<_>>().join(" and ");
    match place.axis {
        "travel_since_reversal" => each(&|i| after_reversal(i, &units.input)),
        "rest_samples" => format!("{} after the input stopped", each(&|i| between(i, "samples"))),
        "v" => format!("at an input of {}", each(&|i| between(i, &units.input))),
        "y" => format!("at an output of {}", each(&|i| between(i, &units.output))),
        "loop_size" => format!("in loops of {}", each(&|i| between(i, &units.input))),
        "speed" => {
            let per_second = |i: [f64; 2]| i.map(|x| x / units.sample_time);
            format!("at speeds of {}", each(&|i| between(per_second(i), &format!("{}/s", units.input))))
        }
        "frequency" => {
            let hertz = |i: [f64; 2]| i.map(|x| x / units.sample_time);
            format!("at frequencies of {}", each(&|i| between(hertz(i), "Hz")))
        }
        "time" => {
            let percent = |i: [f64; 2]| i.map(|x| 100.0 * x);
            format!("at {} of the campaign's time", each(&|i| between(percent(i), "%")))
        }
        axis => format!("at {} {}", axis.replace('_', " "), each(&|i| between(i, ""))),
    }
}

fn named(axis: &str, cells: &[&str]) -> String {
    match (axis, cells) {
        ("branch", ["holding"]) => "where the input rests".to_owned(),
        ("branch", [branch]) => format!("on the {branch} border"),
        ("record", [record]) => format!("in the record {record}"),
        ("record", records) => format!("in the records {}", records.join(", ")),
        (axis, cells) => format!("at {} {}", axis.replace('_', " "), cells.join(", ")),
    }
}

fn after_reversal([low, high]: [f64; 2], unit: &str) -> String {
    match (low <= 0.0, high.is_finite()) {
        (true, true) => format!("within {} {unit} of each reversal", edge(high)),
        (true, false) => "after the reversals".to_owned(),
        (false, true) => format!("{} to {} {unit} after each reversal", edge(low), edge(high)),
        (false, false) => format!("more than {} {unit} after each reversal", edge(low)),
    }
}

fn between([low, high]: [f64; 2], unit: &str) -> String {
    let text = match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{} to {} {unit}", edge(low), edge(high)),
        (true, false) => format!("more than {} {unit}", edge(low)),
        (false, true) => format!("less than {} {unit}", edge(high)),
        (false, false) => "any size".to_owned(),
    };
    text.trim_end().to_owned()
}

/// Intervals that touch become one.
fn merged(intervals: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut merged: Vec<[f64; 2]> = Vec::new();
    for interval in intervals {
        match merged.last_mut() {
            Some(last) if last[1] >= interval[0] => last[1] = interval[1],
            _ => merged.push(*interval),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units() -> Units {
        Units { input: "V".into(), output: "um".into(), sample_time: 0.01, stroke: 2.0 }
    }

    fn cell(axis: &'static str, cell: &str, share: f64, q_value: f64) -> Cell {
        Cell { axis, cell: cell.to_owned(), share, q_value }
    }

    #[test]
    fn neighbouring_cells_are_told_as_one_stretch() {
        let cells = [
            cell("travel_since_reversal", "0.0000..0.0400", 0.5, 1e-9),
            cell("travel_since_reversal", "0.0400..0.1000", 0.4, 1e-9),
            cell("travel_since_reversal", "0.1000..0.2000", 0.1, 0.5),
            cell("travel_since_reversal", "0.2000..inf", 0.0, 1.0),
        ];
        let place = bulk("travel_since_reversal", &cells).expect("two cells hold the bulk");
        assert_eq!(told(&place, &units()), "within 0.1 V of each reversal");
        assert!((place.concentration - 0.4).abs() < 1e-12);
    }

    #[test]
    fn a_bulk_that_chance_may_have_made_is_no_place() {
        let cells = [cell("time", "0.0000..0.1000", 0.9, 0.3), cell("time", "0.1000..0.2000", 0.1, 0.01)];
        assert!(bulk("time", &cells).is_none());
    }

    #[test]
    fn open_cells_and_unknown_axes_read_well() {
        assert_eq!(between([f64::NEG_INFINITY, -1.5], "um"), "less than −1.5 um");
        assert_eq!(after_reversal([1.6, f64::INFINITY], "V"), "more than 1.6 V after each reversal");
        assert_eq!(named("y_amplitude", &["large"]), "at y amplitude large");
        assert_eq!(edges("holding"), None);
    }
}
