//! What makes the records of a rig dimensionless, whatever the zero and the unit of its sensors.

use switchback_model::rig::{Rig, RigRecord};

use crate::error::DiagnoseError;

/// Origin and size of a signal, in its own units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) origin: f64,
    pub(super) size: f64,
}

impl Scale {
    /// Of the input: the working interval, 0 at its lower end and 1 at the upper; that of the fit records where none is declared.
    pub(super) fn of_input(rig: &Rig) -> Result<Self, DiagnoseError> {
        let (low, high) = range(rig.fit_records().flat_map(|r| r.record.v()));
        if high <= low {
            return Err(DiagnoseError::ConstantInput);
        }
        Ok(match rig.interval {
            Some(interval) => Self { origin: interval.low(), size: interval.width() },
            None => Self { origin: low, size: high - low },
        })
    }

    /// Of the output: mean and standard deviation over the fit records.
    ///
    /// Sums are compensated, so that both are as exact as one rounding: in other units the dimensionless records are the same numbers.
    pub(super) fn of_output(rig: &Rig) -> Result<Self, DiagnoseError> {
        let outputs = || rig.fit_records().flat_map(|r| r.record.y()).copied();
        let (least, most) = range(rig.fit_records().flat_map(|r| r.record.y()));
        if most <= least {
            return Err(DiagnoseError::ConstantOutput);
        }
        let count = outputs().count() as f64;
        // Counted from a reading, so that no digits go into a zero far away.
        let mean = sum(outputs().map(|y| y - least)) / count;
        let variance = sum(outputs().map(|y| (y - least - mean).powi(2))) / count;
        Ok(Self { origin: least + mean, size: variance.sqrt() })
    }
}

/// A sum that is as exact as one rounding of it, where it is not much smaller than its terms.
///
/// A. Neumaier, ZAMM 54 (1974), doi 10.1002/zamm.19740540106.
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0, 0.0);
    for x in values {
        let next: f64 = sum + x;
        lost += if sum.abs() >= x.abs() { (sum - next) + x } else { (x - next) + sum };
        sum = next;
    }
    sum + lost
}

pub(super) fn range<'a>(values: impl Iterator<Item = &'a f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)))
}

/// So many central ranges from the median a value is no reading of the same sensor: converters resolve 24 bits at most, 1.7e7 steps, and a
/// signal that fills a millionth of their range is not what they were set up for.
const FAR: f64 = 1e6;

/// Refuses records that hold what no sensor of the fit records can have read: nothing that follows from them would mean anything.
pub(super) fn check_plausible(rig: &Rig) -> Result<(), DiagnoseError> {
    type Signal = fn(&RigRecord) -> &[f64];
    let signals: [(&'static str, Signal); 2] = [("v", |r| r.record.v()), ("y", |r| r.record.y())];
    for (signal, of) in signals {
        let Some((median, width)) = centre(rig.fit_records().flat_map(&of).copied().collect()) else {
            continue;
        };
        for r in &rig.records {
            // The difference of two finite numbers may be infinite, and is far then.
            let distance = |x: &f64| (x - median).abs() / width;
            if let Some(index) = of(r).iter().position(|x| distance(x) > FAR) {
                let value = of(r)[index];
                let (record, times) = (r.name.clone(), distance(&value));
                return Err(DiagnoseError::Implausible { record, signal, index, value, times });
            }
        }
    }
    Ok(())
}

/// Median and central range of values: between the quartiles, or where these coincide between the eighths, and so on; nothing where all but a
/// few values are equal.
fn centre(mut values: Vec<f64>) -> Option<(f64, f64)> {
    let count = values.len();
    let mut at = |k: usize| *values.select_nth_unstable_by(k.min(count - 1), f64::total_cmp).1;
    let median = at(count / 2);
    let effect_terms = std::iter::successors(Some(4), |effect_terms| Some(2 * effect_terms))
        .take_while(|&effect_terms| effect_terms <= count);
    let widths =
        effect_terms.map(|effect_terms| at(count - 1 - count / effect_terms) - at(count / effect_terms));
    widths.into_iter().find(|width| *width > 0.0).map(|width| (median, width))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_keep_what_large_terms_would_swallow() {
        assert_eq!(sum([1e100, 1.0, -1e100].into_iter()), 1.0);
    }

    #[test]
    fn the_centre_of_a_signal_that_mostly_rests_is_where_it_moves() {
        assert_eq!(centre((0..=8).map(f64::from).collect()), Some((4.0, 4.0)));
        assert_eq!(centre(vec![2.0; 9]), None);
        let rests = [vec![1.0; 90], vec![0.0; 10]].concat();
        assert_eq!(centre(rests), Some((1.0, 1.0)));
    }
}
