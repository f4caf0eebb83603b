//! Where the gap lies, in words.

use switchback_diagnose::Cell;
use switchback_io::diagnosis::{Report, Units};
use switchback_io::diagnosis::{edge, whole_percent};

/// Cells with a q-value below this are reported and coloured: at most this share of them is expected to be chance.
pub(crate) const SIGNIFICANT: f64 = 0.05;

/// Share of the energy that a place must hold to be reported: most of it.
const MOST: f64 = 0.5;

/// How many times the average a sample of a place must carry: half as much again. With most of the energy a place is then two thirds of
/// the samples at most.
const ENRICHED: f64 = 1.5;

/// A place on one axis: neighbouring cells, or one kind.
struct Place<'a> {
    axis: &'static str,
    cells: &'a [Cell],
    share: f64,
    exposure: f64,
}

impl<'a> Place<'a> {
    fn of(cells: &'a [Cell]) -> Self {
        let sum = |of: fn(&Cell) -> f64| cells.iter().map(of).sum();
        Self {
            axis: cells[0].axis,
            cells,
            share: sum(|cell| cell.share),
            exposure: sum(|cell| cell.exposure),
        }
    }

    /// How many times the average a sample here carries.
    fn enrichment(&self) -> f64 {
        self.share / self.exposure
    }

    /// Whether it is worth naming, and chance made none of it.
    fn is_reported(&self) -> bool {
        let found = |cell: &Cell| cell.q_value < SIGNIFICANT && cell.enrichment_q_value < SIGNIFICANT;
        self.share >= MOST && self.enrichment() >= ENRICHED && self.cells.iter().all(found)
    }
}

/// Where the gap is concentrated: on a branch, and on the axis that shows it best. None where no cell is significant.
///
/// Where the simulation shows no gap, the map is that of the one-step errors alone, and the sentence says so.
pub(super) fn place(report: &Report) -> Option<String> {
    let visible = report.diagnosis.gap.before.ci90[0] > 0.0;
    let subject = if visible { "The gap" } else { "What one-step predictions miss" };
    sentence(subject, &report.diagnosis.where_, &Units::of(&report.rig))
}

fn sentence(subject: &str, cells: &[Cell], units: &Units) -> Option<String> {
    if cells.iter().all(|cell| cell.q_value >= SIGNIFICANT) {
        return None;
    }
    let places = cells.chunk_by(|one, next| one.axis == next.axis).filter_map(densest);
    let (branch, mut others): (Vec<Place<'_>>, Vec<Place<'_>>) =
        places.partition(|place| place.axis == "branch");
    others.sort_by(|x, y| {
        let order = |place: &Place<'_>| (is_indirect(place.axis), -place.enrichment());
        order(x).partial_cmp(&order(y)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let reported = branch.iter().chain(others.first()).enumerate();
    let reported: Vec<String> =
        reported.map(|(number, place)| with_figures(place, units, number == 0)).collect();
    Some(match reported.is_empty() {
        true => {
            format!("{subject} lies everywhere: no axis of the map shows most of it in few of the samples.")
        }
        false => format!("{subject} lies {}.", reported.join(", ")),
    })
}

/// Records and stretches of time differ by what the input does in them, so they are named only where nothing says it better.
fn is_indirect(axis: &str) -> bool {
    matches!(axis, "record" | "time")
}

/// Of the stretches of one axis that are reported, the one whose samples carry most. Kinds have no neighbours.
fn densest(cells: &[Cell]) -> Option<Place<'_>> {
    let longest = if cells.iter().all(|cell| cell.interval.is_some()) { cells.len() } else { 1 };
    let stretches = (1..=longest).flat_map(|length| cells.windows(length));
    let reported = stretches.filter(|cells| adjoin(cells)).map(Place::of).filter(Place::is_reported);
    reported.max_by(|x, y| x.enrichment().total_cmp(&y.enrichment()))
}

/// Whether each cell begins where the last one ends: cells without samples are not in the map.
fn adjoin(cells: &[Cell]) -> bool {
    cells.windows(2).all(|w| w[0].interval.zip(w[1].interval).is_some_and(|(one, next)| one.high == next.low))
}

/// `within 0.04 mm of each reversal (58 % of its energy in 5 % of the samples)`
fn with_figures(place: &Place<'_>, units: &Units, is_first: bool) -> String {
    let [share, exposure] = [place.share, place.exposure].map(|x| whole_percent(100.0 * x));
    let whole = if place.axis == "frequency" { "frequencies" } else { "samples" };
    let figures = match is_first {
        true => format!("{share} % of its energy in {exposure} % of the {whole}"),
        false => format!("{share} % in {exposure} % of the {whole}"),
    };
    format!("{} ({figures})", reported(place, units))
}

fn reported(place: &Place<'_>, units: &Units) -> String {
    let ends = |cell: &Cell| cell.interval.map(|interval| (interval, units.of_cell(interval.unit)));
    let (Some((first, unit)), Some((last, _))) = (ends(&place.cells[0]), place.cells.last().and_then(ends))
    else {
        return named(place.axis, &place.cells[0].cell);
    };
    let ends = [first.low, last.high];
    match place.axis {
        "travel_since_reversal" => after_reversal(ends, &unit),
        "rest_samples" if ends[1] <= 1.0 => "while the input moves".to_owned(),
        "rest_samples" if ends[0] <= 0.0 => {
            format!("while the input moves and until {} samples after it stopped", edge(ends[1]))
        }
        "rest_samples" => format!("{} after the input stopped", between(ends, &unit)),
        "v" => format!("at an input of {}", between(ends, &unit)),
        "y" => format!("at an output of {}", between(ends, &unit)),
        "loop_size" => format!("in loops of {}", between(ends, &unit)),
        "speed" => format!("at speeds of {}", between(ends, &unit)),
        "frequency" => format!("at frequencies of {}", between(ends, &unit)),
        "time" => format!("at {} of the dataset's time", between(ends.map(|x| 100.0 * x), "%")),
        axis => format!("at {} {}", axis.replace('_', " "), between(ends, "")),
    }
}

fn named(axis: &str, cell: &str) -> String {
    match (axis, cell) {
        ("branch", "holding") => "where the input rests".to_owned(),
        ("branch", branch) => format!("on the {branch} border"),
        ("record", record) => format!("in the record {record}"),
        (axis, cell) => format!("at {} {cell}", axis.replace('_', " ")),
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

#[cfg(test)]
mod tests {
    use super::*;
    use switchback_diagnose::{CellInterval, CellUnit};

    fn units() -> Units {
        Units { input: "V".into(), output: "um".into(), sample_time: 0.01, stroke: 2.0 }
    }

    fn kind(axis: &'static str, cell: &str, share: f64, exposure: f64) -> Cell {
        Cell {
            axis,
            cell: cell.to_owned(),
            interval: None,
            share,
            exposure,
            enrichment: share / exposure,
            q_value: 1e-9,
            enrichment_q_value: if share > exposure { 1e-9 } else { 1.0 },
        }
    }

    fn travel([low, high]: [f64; 2], share: f64, exposure: f64) -> Cell {
        let interval = Some(CellInterval { low, high, unit: CellUnit::Input });
        Cell { interval, ..kind("travel_since_reversal", "", share, exposure) }
    }

    fn reported(cells: &[Cell]) -> String {
        sentence("The gap", cells, &units()).expect("significant cells")
    }

    /// A play: most of its energy soon after a reversal, where few samples are, at slow speeds, where most are.
    fn play() -> Vec<Cell> {
        let speed = |low, high, share, exposure| {
            let interval = Some(CellInterval { low, high, unit: CellUnit::InputPerSecond });
            Cell { interval, ..kind("speed", "", share, exposure) }
        };
        vec![
            travel([0.0, 0.04], 0.58, 0.05),
            travel([0.04, 0.1], 0.24, 0.05),
            travel([0.1, f64::INFINITY], 0.18, 0.9),
            speed(0.0, 20.0, 0.98, 0.95),
            speed(20.0, f64::INFINITY, 0.02, 0.05),
        ]
    }

    #[test]
    fn a_place_is_reported_by_share_and_exposure() {
        let expected =
            "The gap lies within 0.04 V of each reversal (58 % of its energy in 5 % of the samples).";
        assert_eq!(reported(&play()), expected);
    }

    #[test]
    fn neighbouring_cells_are_reported_as_one_stretch() {
        let mut cells = play();
        (cells[0].share, cells[1].share) = (0.42, 0.4);
        let expected =
            "The gap lies within 0.1 V of each reversal (82 % of its energy in 10 % of the samples).";
        assert_eq!(reported(&cells), expected);
        // Not where a cell between them has no samples.
        cells[1].interval = Some(CellInterval { low: 0.05, high: 0.1, unit: CellUnit::Input });
        assert!(reported(&cells).starts_with("The gap lies everywhere"), "{}", reported(&cells));
    }

    #[test]
    fn where_nearly_all_samples_are_is_no_place() {
        let speeds = &play()[3..];
        assert!(reported(speeds).starts_with("The gap lies everywhere"), "{}", reported(speeds));
    }

    #[test]
    fn energy_that_chance_may_have_put_there_is_in_no_place() {
        let mut cells = play();
        cells[0].enrichment_q_value = 0.3;
        assert!(reported(&cells).starts_with("The gap lies everywhere"), "{}", reported(&cells));
        cells.iter_mut().for_each(|cell| cell.q_value = 0.3);
        assert!(sentence("The gap", &cells, &units()).is_none());
    }

    #[test]
    fn a_branch_is_reported_beside_the_best_of_the_other_axes() {
        let mut cells =
            vec![kind("branch", "descending", 0.95, 0.48), kind("branch", "ascending", 0.05, 0.52)];
        cells.extend(play());
        let expected = "The gap lies on the descending border (95 % of its energy in 48 % of the samples), within 0.04 V of each reversal \
                        (58 % in 5 % of the samples).";
        assert_eq!(reported(&cells), expected);
    }

    #[test]
    fn records_are_named_where_nothing_says_it_better() {
        let records = [kind("record", "drive", 0.9, 0.1), kind("record", "sweep", 0.1, 0.9)];
        assert!(
            reported(&records).contains("in the record drive (90 % of its energy in 10 %"),
            "{}",
            reported(&records)
        );
        let both = [&records[..], &play()].concat();
        assert!(!reported(&both).contains("drive"), "{}", reported(&both));
    }

    #[test]
    fn open_cells_and_unknown_axes_read_well() {
        assert_eq!(between([f64::NEG_INFINITY, -1.5], "um"), "less than −1.5 um");
        assert_eq!(after_reversal([1.6, f64::INFINITY], "V"), "more than 1.6 V after each reversal");
        assert_eq!(named("y_amplitude", "large"), "at y amplitude large");
    }
}
