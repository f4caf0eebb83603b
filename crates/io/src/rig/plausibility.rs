//! Signals whose size or course no experiment of the kind is likely to have.

use super::plan::PlannedRecord;
use super::quantity::Unit;
use switchback_model::rig::{Role, Usage};
use switchback_table::signals::Measured;
use switchback_table::table::Column;

/// Ranges of one signal in two records that differ by more than this are rather those of two units.
const FACTOR: f64 = 300.0;
/// Share of the input's range within which all turning points of a kind count as one.
const ALIKE: f64 = 0.02;
/// Share of it that a stroke must cover, and strokes that show that they are alike.
const STROKE: f64 = 0.1;
const STROKES: usize = 6;

/// Takes a signal out of a record.
type Signal = fn(&Measured) -> Option<(&Column, &[f64])>;

/// One sentence a doubt.
pub(super) fn warnings(records: &[(&PlannedRecord, &Measured)]) -> Vec<String> {
    let free: Vec<_> = records.iter().copied().filter(|(record, _)| record.role == Role::Free).collect();
    let signals: [(&str, Signal); 2] = [
        ("input", |measured| Some((measured.input(), &measured.v[..]))),
        ("output", |measured| Some((measured.output()?, measured.y.as_deref()?))),
    ];
    let sizes = signals.into_iter().filter_map(|(part, of)| other_size(&free, part, of));
    records
        .first()
        .into_iter()
        .flat_map(|(_, measured)| other_unit(measured).into_iter().chain(other_quantity(measured)))
        .chain(sizes)
        .chain(alike_strokes(&free))
        .collect()
}

/// Input and output are one quantity in two units.
fn other_unit(measured: &Measured) -> Option<String> {
    let (input, output) = (measured.input(), measured.output()?);
    let factor = Unit::of(input)?.ratio(Unit::of(output)?).filter(|ratio| *ratio != 1.0)?;
    let factor = rounded(factor.max(1.0 / factor));
    Some(format!(
        "`{}` and `{}` are one quantity in two units: the gain holds a factor of {factor}",
        input.label(),
        output.label()
    ))
}

/// Predictions of another quantity than the output's.
fn other_quantity(measured: &Measured) -> Option<String> {
    let (prediction, output) = (measured.prediction()?, measured.output()?);
    let ratio = Unit::of(prediction)?.ratio(Unit::of(output)?);
    ratio.is_none().then(|| {
        format!(
            "`{}` is predicted in a unit of another quantity than `{}`: check the columns and their units",
            prediction.label(),
            output.label()
        )
    })
}

/// A signal that moves a thousand times as far in one record as in another.
fn other_size(records: &[(&PlannedRecord, &Measured)], part: &str, of: Signal) -> Option<String> {
    let ranges = records.iter().filter_map(|(record, measured)| {
        let (column, values) = of(measured)?;
        let (low, high) = ends(values);
        (high > low).then_some((high - low, &record.named, column))
    });
    let mut ranges: Vec<_> = ranges.collect();
    ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (small, large) = (ranges.first()?, ranges.last()?);
    (large.0 > FACTOR * small.0).then(|| {
        format!(
            "the {part} `{}` spans {} in {}, but {} in {}, {} times as much: check that both are in one unit",
            large.2.name,
            rounded(small.0),
            small.1,
            rounded(large.0),
            large.1,
            rounded(large.0 / small.0)
        )
    })
}

/// An input whose strokes all have the same ends.
fn alike_strokes(records: &[(&PlannedRecord, &Measured)]) -> Option<String> {
    let fitted: Vec<_> = records.iter().filter(|(record, _)| record.usage == Usage::Fit).collect();
    let (low, high) =
        ends(&fitted.iter().flat_map(|(_, measured)| measured.v.iter().copied()).collect::<Vec<_>>());
    let (mut tops, mut bottoms) = (Vec::new(), Vec::new());
    for (_, measured) in &fitted {
        for piece in &measured.pieces {
            turning_points(&measured.v[piece.clone()], STROKE * (high - low), (&mut tops, &mut bottoms));
        }
    }
    let is_alike = |points: &[f64]| {
        let (low_point, high_point) = ends(points);
        high_point - low_point <= ALIKE * (high - low)
    };
    let strokes = tops.len() + bottoms.len();
    (strokes >= STROKES && is_alike(&tops) && is_alike(&bottoms)).then(|| {
        format!(
            "all {strokes} strokes of `{}` run between {} and {}: what depends on the length of a stroke cannot be \
             distinguished from what does not; add strokes of other lengths",
            fitted[0].1.input().name,
            rounded(bottoms.iter().sum::<f64>() / bottoms.len() as f64),
            rounded(tops.iter().sum::<f64>() / tops.len() as f64)
        )
    })
}

/// Adds the values at which a signal turns after a travel of `far` at least.
fn turning_points(values: &[f64], far: f64, (tops, bottoms): (&mut Vec<f64>, &mut Vec<f64>)) {
    let Some(first) = values.first() else { return };
    let (mut low, mut high, mut rises) = (*first, *first, None);
    for &value in values {
        (low, high) = (low.min(value), high.max(value));
        if rises != Some(false) && value <= high - far {
            tops.extend(rises.map(|_| high));
            (rises, low) = (Some(false), value);
        } else if rises != Some(true) && value >= low + far {
            bottoms.extend(rises.map(|_| low));
            (rises, high) = (Some(true), value);
        }
        if rises == Some(false) {
            high = value.max(low);
        }
        if rises == Some(true) {
            low = value.min(high);
        }
    }
}

fn ends(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// Three digits.
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_points_are_ends_of_strokes() {
        let v = [0.0, 1.0, 2.0, 3.0, 2.9, 3.1, 1.0, 0.0, 0.1, 2.0, 1.95, 0.5];
        let (mut tops, mut bottoms) = (Vec::new(), Vec::new());
        turning_points(&v, 0.5, (&mut tops, &mut bottoms));
        assert_eq!((tops, bottoms), (vec![3.1, 2.0], vec![0.0]));
    }
}
