//! The grid of a sweep.

use super::check::{at_most, distinct, in_one_line, non_empty, positive, unknown};
use crate::scenario::border::WireBorder;
use crate::scenario::error::Fault;
use crate::scenario::wire::WireSweep;
use crate::scenario::{Case, Sweep};
use switchback_identify::Method;

/// The borders of the sweep, in its order; all of them where it does not choose.
pub(super) fn selected(borders: Vec<WireBorder>, sweep: &WireSweep) -> Result<Vec<WireBorder>, Fault> {
    distinct(borders.iter().map(|b| &b.name))?;
    borders.iter().try_for_each(|b| in_one_line(&b.name))?;
    let Some(chosen) = &sweep.borders else { return Ok(borders) };
    distinct(non_empty(chosen)?.iter())?;
    let mut rest = borders;
    let mut taken = Vec::new();
    for name in chosen.get_ref() {
        match rest.iter().position(|b| b.name == *name) {
            Some(i) => taken.push(rest.swap_remove(i)),
            None => {
                let names: Vec<&str> = rest.iter().map(|b| b.name.get_ref().as_str()).collect();
                return Err(unknown(name, "border", &names));
            }
        }
    }
    Ok(taken)
}

/// An information matrix holds the square of their number, for every cell.
const MOST_POINTS: usize = 1000;

/// Days of any rig; where a record is simulated it takes a gigabyte a series.
const MOST_SAMPLES: usize = 100_000_000;

pub(super) fn sweep(wire: &WireSweep, methods: Vec<Method>, cases: &[Case]) -> Result<Sweep, Fault> {
    let points: Vec<usize> = non_empty(&wire.points)?
        .iter()
        .map(|m| match *m.get_ref() {
            0 => Err(Fault::new(m.span(), "an experiment visits at least one point", "write 1 or more")),
            _ => at_most(m, MOST_POINTS, "points"),
        })
        .collect::<Result<_, _>>()?;
    distinct(wire.points.get_ref().iter())?;
    let noise: Vec<f64> = non_empty(&wire.noise)?.iter().map(positive).collect::<Result<_, _>>()?;
    if let Some(i) = (1..noise.len()).find(|&i| noise[..i].contains(&noise[i])) {
        return Err(Fault::new(wire.noise.get_ref()[i].span(), "given twice", "remove one of them"));
    }
    let samples = samples(wire, &points, cases)?;
    let slope_from = slope_from(wire, &samples)?;
    Ok(Sweep { noise, samples, points, methods, slope_from })
}

/// Slopes are fitted over this many decades of `N`, unless the scenario says otherwise.
const SLOPE_DECADES: u32 = 2;

/// … and over this many points at least, as far as there are so many.
const SLOPE_POINTS: usize = 3;

/// Where fitted slopes begin: what the scenario says, else the last decades of `N`, where terms of higher order no longer show.
fn slope_from(wire: &WireSweep, samples: &[usize]) -> Result<usize, Fault> {
    let Some(from) = &wire.slope_from else {
        let longest = samples.last().copied().unwrap_or_default();
        let decades = samples.partition_point(|n| n * 10usize.pow(SLOPE_DECADES) < longest);
        return Ok(samples[decades.min(samples.len().saturating_sub(SLOPE_POINTS))]);
    };
    if samples.contains(from.get_ref()) {
        return Ok(*from.get_ref());
    }
    let list: Vec<String> = samples.iter().map(usize::to_string).collect();
    let remedy = format!("write one of {}", list.join(", "));
    Err(Fault::new(from.span(), "is not among sweep.samples", remedy))
}

/// Record lengths: ascending, and none shorter than a period of any experiment.
fn samples(wire: &WireSweep, points: &[usize], cases: &[Case]) -> Result<Vec<usize>, Fault> {
    let most_points = points.iter().copied().max().unwrap_or(1);
    let longest = cases.iter().max_by_key(|c| c.period(most_points));
    let mut previous = 0;
    for n in non_empty(&wire.samples)? {
        at_most(n, MOST_SAMPLES, "samples")?;
        if *n.get_ref() <= previous {
            let why = format!("does not exceed the entry before it, {previous}");
            return Err(Fault::new(n.span(), why, "list the record lengths in ascending order, each once"));
        }
        if let Some(case) = longest.filter(|c| *n.get_ref() < c.period(most_points)) {
            let period = case.period(most_points);
            let why = format!(
                "shorter than a period: m = {most_points} points, {} samples apart, take T = s(m + 3) = {period} samples",
                case.spacing
            );
            return Err(Fault::new(n.span(), why, format!("write {period} or more, or lower sweep.points")));
        }
        previous = *n.get_ref();
    }
    Ok(wire.samples.get_ref().iter().map(|n| *n.get_ref()).collect())
}
