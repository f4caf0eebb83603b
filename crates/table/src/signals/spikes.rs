//! Values that no machine ever reached: a failed sensor, or a word for "nothing" written as a number.

use super::measured::Measured;
use crate::table::{Column, Place};

/// So many interquartile ranges from the median a value is no measurement: converters resolve 24 bits at most, 1.7e7 steps, and a signal
/// that fills a millionth of their range is not what they were set up for.
const FAR: f64 = 1e6;

/// Sizes that programs write for a value they do not have.
const SENTINELS: [f64; 9] = [999.0, 9999.0, 99_999.0, 999_999.0, 1e20, 1e30, 1e31, 1e36, 1e38];

/// One sentence a column that has such values.
pub fn warnings(measured: &Measured) -> Vec<String> {
    let signals = [(Some(measured.input()), Some(&measured.v)), (measured.output(), measured.y.as_ref())];
    let reported = signals.into_iter().filter_map(|(column, values)| warning(measured, column?, values?));
    reported.collect()
}

fn warning(measured: &Measured, column: &Column, values: &[f64]) -> Option<String> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let (far, distance) = odd(&sorted)?;
    let first = values.iter().position(|value| far(*value))?;
    let count = values.iter().filter(|value| far(**value)).count();
    let value = values[first];
    let place = match measured.place(first) {
        Place::Line(line) => format!("{}:{line}", measured.table.path),
        Place::Row(row) => format!("{}, row {row}", measured.table.path),
    };
    let others = match count - 1 {
        0 => String::new(),
        more => format!(", and {more} more like it"),
    };
    Some(format!(
        "{place}: `{}` is {}{others}, {} times as far out as all other values: leave the cell empty if the sensor failed",
        column.name,
        plain(value),
        plain(short(distance))
    ))
}

/// Which values of a sorted list are odd, and how many times as far from the median they lie as the others.
fn odd(sorted: &[f64]) -> Option<(impl Fn(f64) -> bool, f64)> {
    let median = *sorted.get(sorted.len() / 2)?;
    let range = sorted[3 * sorted.len() / 4] - sorted[sorted.len() / 4];
    let is_far = move |value: f64| range > 0.0 && (value - median).abs() > FAR * range;
    let ends = [sorted[0], sorted[sorted.len() - 1]];
    let is_odd = move |value: f64| {
        let is_sentinel = ends.contains(&value) && SENTINELS.contains(&value.abs());
        is_far(value) || is_sentinel
    };
    let others: Vec<f64> = sorted.iter().copied().filter(|value| !is_odd(*value)).collect();
    let (low, high) = (*others.first()?, *others.last()?);
    let reach = (low - median).abs().max((high - median).abs());
    let nearest = sorted.iter().filter(|value| is_odd(**value)).map(|value| (value - median).abs());
    let nearest = nearest.reduce(f64::min)?;
    // A sentinel stands alone: as far again from all others as they are from each other.
    let alone = (nearest - reach) / (high - low).max(f64::MIN_POSITIVE);
    (reach > 0.0 && alone > 1.0).then_some((is_odd, nearest / reach))
}

/// Two digits of a number.
fn short(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// A number as a person writes it.
fn plain(x: f64) -> String {
    if x.abs() < 1e6 { x.to_string() } else { format!("{x:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(mut values: Vec<f64>) -> Vec<f64> {
        values.sort_by(f64::total_cmp);
        odd(&values).map_or(Vec::new(), |(is_odd, _)| values.iter().copied().filter(|v| is_odd(*v)).collect())
    }

    fn with(odd: &[f64]) -> Vec<f64> {
        (0..200).map(|k| 3.0 * (f64::from(k) * 0.3).sin()).chain(odd.iter().copied()).collect()
    }

    #[test]
    fn far_values_and_lonely_sentinels_are_odd_and_nothing_else_is() {
        assert_eq!(found(with(&[])), [0.0; 0]);
        assert_eq!(found(with(&[40.0, 1000.0])), [0.0; 0], "an outlier may be a measurement");
        assert_eq!(found(with(&[1e300])), [1e300]);
        assert_eq!(found(with(&[-1e300, 1e300])), [-1e300, 1e300]);
        assert_eq!(found(with(&[-9999.0, -9999.0])), [-9999.0, -9999.0]);
        let near: Vec<f64> = (0..=9999).map(f64::from).collect();
        assert_eq!(found(near), [0.0; 0], "a sentinel's size among others like it is a value");
        assert_eq!(found(vec![2.0; 50]), [0.0; 0]);
        assert_eq!(found([vec![0.0; 90], vec![1.0; 10]].concat()), [0.0; 0], "levels are no spikes");
    }
}
