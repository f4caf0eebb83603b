//! A model that does not describe the measured outputs, and the change of its output that would do.

use switchback_io::diagnosis::digits;
use switchback_io::identification::unit;
use switchback_io::model::{ModelFile, Run};
use switchback_model::alignment::{align, regression};

/// Least share of measured outputs in the 95 % band of a model of the machine that was measured; noise and wear explain less of them, but not
/// that most lie outside.
const LEAST_COVERED: f64 = 0.5;
/// Consecutive measured outputs that are compared with shifted ones, at least.
const LEAST_PIECE: usize = 100;

/// The model's output as `factor·y(t − delay) + constant`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Change {
    factor: f64,
    constant: f64,
    /// Samples.
    delay: isize,
}

/// A model of another machine, or outputs in another unit, of another sign, from another zero or at another time; none where at least half of the measured
/// outputs lie within the band.
pub(super) fn outside_the_band(file: &ModelFile, measured: &[f64], run: &Run) -> Option<String> {
    let share = run.covered(measured).filter(|covered| *covered < LEAST_COVERED)?;
    let within = |share: f64| format!("{:.1} %", 100.0 * share);
    let changes = changes(measured, run).into_iter();
    let best = changes.map(|c| (c, c.covered(measured, run))).find(|(_, covered)| *covered >= LEAST_COVERED);
    let remedy = match best {
        Some((change, covered)) => format!(
            "with {} {} would: check {}",
            change.words(unit(&file.header.output), file.header.sample_time),
            within(covered),
            change.suspect()
        ),
        None => "no constant, factor, sign or delay brings half of them into it: check columns and units, and that the model is of this machine"
            .to_owned(),
    };
    Some(format!("only {} of the measured outputs lie within the 95 % band; {remedy}", within(share)))
}

/// Changes from the simplest on.
fn changes(measured: &[f64], run: &Run) -> Vec<Change> {
    let pieces = pieces(measured, run);
    let factor = regression(&pieces, 0).map_or(1.0, |a| a.factor);
    let best = align(&pieces);
    let (delay, factor_at_delay) = best.map_or((0, 1.0), |a| (a.delay, a.factor));
    let simple = [(1.0, 0), (-1.0, 0), (factor, 0), (1.0, delay), (-1.0, delay), (factor_at_delay, delay)];
    let plain = simple.into_iter().map(|(factor, delay)| Change { factor, constant: 0.0, delay });
    let with_constant = plain.clone().map(|c| Change { constant: c.offset(measured, run), ..c });
    let all: Vec<Change> = plain.skip(1).chain(with_constant).collect();
    let mut all: Vec<(usize, Change)> = all.into_iter().map(|c| (c.parts(), c)).collect();
    all.sort_by_key(|(parts, _)| *parts);
    all.into_iter().map(|(_, change)| change).collect()
}

/// Stretches of measured outputs, each with the run on it.
fn pieces<'a>(measured: &'a [f64], run: &'a Run) -> Vec<(&'a [f64], &'a [f64])> {
    let mut pieces = Vec::new();
    let mut from = run.start;
    for part in measured[run.start..].split(|y| !y.is_finite()) {
        if part.len() >= LEAST_PIECE {
            pieces.push((part, &run.y[from..from + part.len()]));
        }
        from += part.len() + 1;
    }
    pieces
}

impl Change {
    /// Changed values at the same time.
    fn parts(&self) -> usize {
        usize::from(self.factor != 1.0) + usize::from(self.constant != 0.0) + usize::from(self.delay != 0)
    }

    /// The sample of the run that belongs to a measured one.
    fn sample(&self, t: usize, run: &Run) -> Option<usize> {
        t.checked_add_signed(-self.delay).filter(|at| *at >= run.start && *at < run.y.len())
    }

    /// By how much measured outputs lie above the changed run in the middle.
    fn offset(&self, measured: &[f64], run: &Run) -> f64 {
        let above = |t: usize| self.sample(t, run).map(|at| measured[t] - self.factor * run.y[at]);
        let mut above: Vec<f64> = (0..measured.len()).filter_map(above).filter(|x| x.is_finite()).collect();
        let middle = above.len() / 2;
        if above.is_empty() { 0.0 } else { *above.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }

    /// Share of the measured outputs within the band of the changed run.
    fn covered(&self, measured: &[f64], run: &Run) -> f64 {
        let is_inside = |t: usize| {
            let at = self.sample(t, run).filter(|_| measured[t].is_finite())?;
            let change = |y: f64| self.factor * y + self.constant;
            let (one, other) = (change(run.low[at]), change(run.high[at]));
            Some((one.min(other)..=one.max(other)).contains(&measured[t]))
        };
        let (inside, count) = (run.start..measured.len())
            .filter_map(is_inside)
            .fold((0_usize, 0_usize), |(inside, count), is_inside| {
                (inside + usize::from(is_inside), count + 1)
            });
        if count == 0 { 0.0 } else { inside as f64 / count as f64 }
    }

    fn words(&self, unit: &str, sample_time: f64) -> String {
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let mut parts = Vec::new();
        if self.factor == -1.0 {
            parts.push("the other sign".to_owned());
        } else if self.factor != 1.0 {
            parts.push(format!("the model's output times {}", digits(self.factor, 4)));
        }
        if self.delay != 0 {
            let side = if self.delay > 0 { "later" } else { "earlier" };
            let samples = self.delay.unsigned_abs();
            let time = digits(samples as f64 * sample_time, 3);
            let s = if samples == 1 { "" } else { "s" };
            parts.push(format!("an output {time} s ({samples} sample{s}) {side}"));
        }
        if self.constant != 0.0 {
            parts.push(format!("{}{unit} added to it", digits(self.constant, 4)));
        }
        parts.join(" and ")
    }

    fn suspect(&self) -> String {
        let mut parts = Vec::new();
        match self.factor {
            -1.0 => parts.push("the sign"),
            1.0 => {}
            _ => parts.push("units and gain"),
        }
        if self.delay != 0 {
            parts.push("the time stamps");
        }
        if self.constant != 0.0 {
            parts.push("the zero");
        }
        parts.join(" and ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run() -> Run {
        let y: Vec<f64> =
            (0..600).map(|t| (0.11 * f64::from(t)).sin() + (0.031 * f64::from(t)).cos()).collect();
        let band = |sign: f64| y.iter().map(|y| y + sign * 0.05).collect();
        Run { low: band(-1.0), high: band(1.0), start: 5, fit_percent: None, notes: Vec::new(), y }
    }

    fn found(measured: impl Fn(&Run, usize) -> f64) -> Option<Change> {
        let run = run();
        let mut measured: Vec<f64> = (0..600).map(|t| measured(&run, t)).collect();
        measured[300] = f64::NAN;
        changes(&measured, &run).into_iter().find(|c| c.covered(&measured, &run) >= LEAST_COVERED)
    }

    #[test]
    fn the_simplest_change_that_would_do_is_found() {
        let one = |factor: f64, constant: f64, delay: isize| {
            let change = found(|run, t| factor * run.y[t.saturating_add_signed(-delay).min(599)] + constant);
            let change = change.expect("a change");
            assert!((change.factor - factor).abs() < 1e-6 * factor.abs(), "{change:?}");
            assert!((change.constant - constant).abs() < 1e-6, "{change:?}");
            assert_eq!(change.delay, delay, "{change:?}");
            change
        };
        assert_eq!(one(1.0, 0.5, 0).suspect(), "the zero");
        assert_eq!(one(-1.0, 0.0, 0).words("N", 0.01), "the other sign");
        assert_eq!(one(1000.0, 0.0, 0).suspect(), "units and gain");
        assert_eq!(one(1.0, 0.0, 4).words("N", 0.01), "an output 0.0400 s (4 samples) later");
        assert_eq!(one(-1.0, 2.0, -1).parts(), 3);
        assert_eq!(found(|_, t| (t as f64 * 0.7).sin() * 3.0), None);
    }
}
