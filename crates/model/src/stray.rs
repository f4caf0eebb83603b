//! Samples that no measurement can be: a glitch of a converter, a line lost on the bus, a word for "nothing" written as a number.

use crate::record::Record;

/// A value farther from the bulk of its signal than so many times the width of the bulk.
///
/// The bulk of a signal is where all but a thousandth of its samples at each end lie. A normal distribution is 6.2 standard deviations wide there, so that
/// the limit lies 34 of them from its mean; and a converter whose range the bulk fills to a tenth cannot go beyond it.
const WIDTHS: f64 = 5.0;

/// Samples in a thousand that the bulk leaves out at each end.
const LEFT_OUT: usize = 1000;

/// One of the two signals of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SignalName {
    /// `v`.
    Input,
    /// `y`.
    Output,
}

/// A sample far from all others of its signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StraySample {
    /// Number of the record, from 0.
    pub record: usize,
    /// Number of the sample, from 0.
    pub sample: usize,
    /// Which signal.
    pub signal: SignalName,
    /// Its value, units of the signal.
    pub value: f64,
}

/// Records with straight lines through their stray samples, and these samples.
///
/// ```
/// use switchback_model::record::Record;
/// use switchback_model::stray::{SignalName, screened};
/// let wave = |t: i32| f64::from(t % 20 - 10);
/// let mut y: Vec<f64> = (0..100).map(wave).collect();
/// y[7] = 1e6;
/// let record = Record::new((0..100).map(wave).collect(), y)?;
/// let (records, stray) = screened(&[&record]);
/// assert_eq!((stray.len(), stray[0].sample, stray[0].signal), (1, 7, SignalName::Output));
/// assert_eq!(records[0].y()[7], wave(7));
/// # Ok::<(), switchback_model::record::RecordError>(())
/// ```
pub fn screened(records: &[&Record]) -> (Vec<Record>, Vec<StraySample>) {
    let inputs: Vec<&[f64]> = records.iter().map(|r| r.v()).collect();
    let outputs: Vec<&[f64]> = records.iter().map(|r| r.y()).collect();
    let mut stray = Vec::new();
    let [v, y] = [(SignalName::Input, inputs), (SignalName::Output, outputs)].map(|(signal, values)| {
        let is_stray = beyond_the_bulk(&values);
        let mend = |(record, values): (usize, &&[f64])| {
            let far: Vec<usize> = (0..values.len()).filter(|&t| is_stray(values[t])).collect();
            stray.extend(far.iter().map(|&sample| StraySample {
                record,
                sample,
                signal,
                value: values[sample],
            }));
            interpolated(values, &far)
        };
        values.iter().enumerate().map(mend).collect::<Vec<_>>()
    });
    stray.sort_by_key(|s| (s.record, s.sample, s.signal));
    let records =
        v.into_iter().zip(y).map(|(v, y)| Record::new(v, y).expect("finite values of equal number"));
    (records.collect(), stray)
}

/// Whether a value lies beyond the bulk of a signal.
fn beyond_the_bulk(values: &[&[f64]]) -> impl Fn(f64) -> bool {
    let mut sorted = values.concat();
    if sorted.is_empty() {
        sorted.push(0.0);
    }
    sorted.sort_by(f64::total_cmp);
    // In short records a single sample at each end is left out.
    let out = (sorted.len() / LEFT_OUT).max(1).min((sorted.len() - 1) / 2);
    let (low, high) = (sorted[out], sorted[sorted.len() - 1 - out]);
    let most = WIDTHS * (high - low);
    move |x| most > 0.0 && (x < low - most || x > high + most)
}

/// The values with straight lines through the samples of the given numbers; before the first and after the last other sample its value.
fn interpolated(values: &[f64], gaps: &[usize]) -> Vec<f64> {
    let mut out = values.to_vec();
    let is_gap = |t: usize| gaps.binary_search(&t).is_ok();
    for &t in gaps {
        let before = (0..t).rev().find(|&s| !is_gap(s));
        let after = (t + 1..values.len()).find(|&s| !is_gap(s));
        out[t] = match (before, after) {
            (Some(a), Some(b)) => {
                let share = (t - a) as f64 / (b - a) as f64;
                values[a] + share * (values[b] - values[a])
            }
            (Some(s), None) | (None, Some(s)) => values[s],
            (None, None) => values[t],
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(change: impl Fn(&mut Vec<f64>)) -> Record {
        let wave = |t: usize| (0.05 * t as f64).sin();
        let mut y: Vec<f64> = (0..3000).map(wave).collect();
        change(&mut y);
        Record::new((0..3000).map(wave).collect(), y).expect("a record")
    }

    #[test]
    fn what_a_sensor_can_have_read_stays() {
        let plain = record(|_| ());
        // A pulse of five times the amplitude, and readings at both ends of a converter that the wave fills to a quarter.
        let pulsed = record(|y| y[200..230].fill(5.0));
        let clipped = record(|y| (y[300], y[301]) = (4.0, -4.0));
        for one in [&plain, &pulsed, &clipped] {
            let (records, stray) = screened(&[one]);
            assert_eq!((&records[0], stray.len()), (one, 0));
        }
    }

    #[test]
    fn one_sample_at_any_place_and_of_any_size_is_found_and_bridged() {
        let plain = record(|_| ());
        for place in [0, 1, 777, 2998, 2999] {
            for size in [20.0, -2e3, 2e6, 1e300] {
                let spoilt = record(|y| y[place] = size);
                let (records, stray) = screened(&[&plain, &spoilt]);
                assert_eq!(
                    stray,
                    [StraySample { record: 1, sample: place, signal: SignalName::Output, value: size }]
                );
                let error = records[1].y()[place] - plain.y()[place];
                assert!(error.abs() < 0.06 && records[0] == plain, "{error}");
            }
        }
    }

    #[test]
    fn neighbours_are_bridged_together() {
        let spoilt = record(|y| (y[10], y[11]) = (1e9, 1e9));
        let (records, stray) = screened(&[&spoilt]);
        assert_eq!(stray.len(), 2);
        assert!((records[0].y()[10] - 0.5_f64.sin()).abs() < 2e-3);
    }
}
