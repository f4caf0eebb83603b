//! What a model was identified on, and where an input leaves it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_model::rig::Rig;

/// The inputs that a model was identified on, input units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// The working interval.
    pub interval: [f64; 2],
    /// Range of the input in the fit records.
    pub v: [f64; 2],
    /// Largest change from one sample to the next.
    #[schemars(range(min = 0))]
    pub largest_step: f64,
    /// Smallest and largest travel between two reversals.
    pub reversals: Option<[f64; 2]>,
    /// A move back by less is no reversal.
    #[schemars(range(min = 0))]
    pub threshold: f64,
    /// The records of the rig.
    pub records: Vec<Source>,
}

/// A record of the rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// `fit` or `holdout`.
    #[schemars(extend("enum" = ["fit", "holdout"]))]
    pub r#use: String,
    /// Its samples.
    pub samples: usize,
}

/// Shares of the range by which an input may leave it unnoticed: the rounding of decimals.
const ROUNDING: f64 = 1e-9;

impl Domain {
    /// What the fit records of a rig hold; a move back below the threshold, input units, is no reversal.
    pub fn of(rig: &Rig, threshold: f64) -> Self {
        let inputs = || rig.fit_records().map(|r| r.record.v());
        let v = range(inputs().flatten().copied()).unwrap_or([0.0, 0.0]);
        let steps = inputs().flat_map(|v| v.windows(2).map(|w| (w[1] - w[0]).abs()));
        let travels = inputs().flat_map(|v| travels(v, threshold));
        let record = |r: &switchback_model::rig::RigRecord| Source {
            name: r.name.clone(),
            r#use: r.usage.name().to_owned(),
            samples: r.record.len(),
        };
        Self {
            interval: rig.interval.map_or(v, |i| [i.low(), i.high()]),
            v,
            largest_step: steps.fold(0.0, f64::max),
            reversals: range(travels),
            threshold,
            records: rig.records.iter().map(record).collect(),
        }
    }

    /// Where an input leaves it, one sentence each; `unit` is that of the input.
    pub fn warnings(&self, v: &[f64], sample_time: f64, unit: &str) -> Vec<String> {
        let slack = ROUNDING * (self.v[1] - self.v[0]).abs();
        [
            self.range_left(v, unit, slack),
            self.speed_left(v, sample_time, unit, slack),
            self.reversals_left(v, unit, slack),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    fn range_left(&self, v: &[f64], unit: &str, slack: f64) -> Option<String> {
        let [low, high] = self.v;
        let out = v.iter().filter(|x| **x < low - slack || **x > high + slack).count();
        let [least, most] = range(v.iter().copied())?;
        (out > 0).then(|| {
            format!(
                "the input leaves the range that the model was identified on: {}, against {} ({}); nothing is known of the borders there",
                span(least, most, unit),
                span(low, high, unit),
                of_samples(out, v.len())
            )
        })
    }

    fn speed_left(&self, v: &[f64], sample_time: f64, unit: &str, slack: f64) -> Option<String> {
        let steps = || v.windows(2).map(|w| (w[1] - w[0]).abs());
        let out = steps().filter(|step| *step > self.largest_step + slack).count();
        let most = steps().fold(0.0, f64::max);
        (out > 0).then(|| {
            let speed = |step: f64| with_unit(step / sample_time, &per_second(unit));
            format!(
                "the input is faster than any that the model was identified on: up to {}, against {} ({})",
                speed(most),
                speed(self.largest_step),
                of_samples(out, v.len())
            )
        })
    }

    fn reversals_left(&self, v: &[f64], unit: &str, slack: f64) -> Option<String> {
        let travels = travels(v, self.threshold);
        let Some([low, high]) = self.reversals else {
            return (!travels.is_empty()).then(|| {
                "the input moves between reversals, of which the records of the model have no two".to_owned()
            });
        };
        let out = travels.iter().filter(|x| **x < low - slack || **x > high + slack).count();
        let [least, most] = range(travels.iter().copied())?;
        (out > 0).then(|| {
            format!(
                "{out} of {} moves from one reversal to the next are smaller or larger than any that the model was identified on: {}, \
                 against {}",
                travels.len(),
                span(least, most, unit),
                span(low, high, unit)
            )
        })
    }
}

/// Travels between successive reversals: what comes before the first and after the last is not a whole move.
fn travels(v: &[f64], threshold: f64) -> Vec<f64> {
    let Some(&first) = v.first() else { return Vec::new() };
    let (mut low, mut high, mut rises) = (first, first, None);
    let mut turns = Vec::new();
    for &now in v {
        low = low.min(now);
        high = high.max(now);
        let turned = match rises {
            None if now - low > threshold => Some((true, None)),
            None if high - now > threshold => Some((false, None)),
            Some(true) if high - now > threshold => Some((false, Some(high))),
            Some(false) if now - low > threshold => Some((true, Some(low))),
            _ => None,
        };
        if let Some((now_rises, turn)) = turned {
            turns.extend(turn);
            rises = Some(now_rises);
            (low, high) = (now, now);
        }
    }
    turns.windows(2).map(|w| (w[1] - w[0]).abs()).collect()
}

fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.fold(None, |range, x| match range {
        None => Some([x, x]),
        Some([low, high]) => Some([low.min(x), high.max(x)]),
    })
}

fn span(low: f64, high: f64, unit: &str) -> String {
    format!("{} to {}", short(low), with_unit(high, unit))
}

fn with_unit(x: f64, unit: &str) -> String {
    format!("{} {unit}", short(x)).trim_end().to_owned()
}

fn per_second(unit: &str) -> String {
    if unit.is_empty() { "input units/s".to_owned() } else { format!("{unit}/s") }
}

fn of_samples(out: usize, all: usize) -> String {
    let share = 100.0 * out as f64 / all.max(1) as f64;
    let share = if share < 0.1 { "below 0.1 %".to_owned() } else { format!("{share:.1} %") };
    format!("{out} of {all} samples, {share}")
}

/// Four significant digits.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn domain() -> Domain {
        let (interval, v) = ([-2.0, 2.0], [-2.0, 2.0]);
        let records = Vec::new();
        Domain { interval, v, largest_step: 0.5, reversals: Some([1.0, 4.0]), threshold: 0.0, records }
    }

    #[test]
    fn moves_are_counted_between_reversals_only() {
        assert_eq!(travels(&[0.0, 1.0, 3.0, 2.0, 2.0, 2.5, 0.0], 0.0), [1.0, 0.5]);
        // The return by a half is noise for a threshold of one.
        assert_eq!(travels(&[0.0, 3.0, 2.5, 4.0, 0.0, 5.0, 0.0], 1.0), [4.0, 5.0]);
        assert!(travels(&[0.0, 1.0, 2.0], 0.0).is_empty() && travels(&[], 0.0).is_empty());
    }

    #[test]
    fn what_stays_inside_is_not_warned_of() {
        assert_eq!(domain().warnings(&[-2.0, -1.5, -1.0, -1.5, -2.0, -1.5], 0.01, "mm"), [] as [String; 0]);
    }

    #[test]
    fn every_way_out_is_reported_with_its_figures() {
        let reported = domain().warnings(&[0.0, 1.0, 2.5, 2.4, 2.6, 2.4], 0.1, "mm");
        assert_eq!(reported.len(), 3, "{reported:?}");
        assert!(
            reported[0].contains("0 to 2.6 mm, against -2 to 2 mm (4 of 6 samples, 66.7 %)"),
            "{}",
            reported[0]
        );
        assert!(reported[1].contains("up to 15 mm/s, against 5 mm/s (2 of 6"), "{}", reported[1]);
        assert!(
            reported[2].contains("2 of 2 moves") && reported[2].contains("0.1 to 0.2 mm"),
            "{}",
            reported[2]
        );
    }
}
