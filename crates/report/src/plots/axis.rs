//! Axes: from values to places, and the ticks between.

use super::style::{minus, percent, plain, power_of_ten};
use switchback_io::output::number;

/// An axis from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    scale: Scale,
    low: f64,
    high: f64,
}

/// How places grow with values, and where the ticks stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scale {
    /// With the values; ticks at round steps.
    Linear,
    /// The same, ticks in percent.
    Percent,
    /// With their logarithms; ticks at powers of ten.
    Decades,
    /// With their logarithms; ticks at powers of two.
    Doublings,
    /// With the values, downwards; no ticks.
    Rows,
}

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    /// The value marked.
    pub at: f64,
    /// The number written there; none at a minor tick.
    pub label: Option<String>,
}

/// Share of the axis that is left free at its ends.
const LINEAR_MARGIN: f64 = 0.05;
const LOGARITHMIC_MARGIN: f64 = 0.06;

impl Axis {
    /// A linear axis that holds all values with a margin; around 0 where there is none.
    pub(crate) fn linear(values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 1.0));
        let margin = if high > low { LINEAR_MARGIN * (high - low) } else { low.abs().max(1.0) * 0.1 };
        Self::between(low - margin, high + margin)
    }

    /// A linear axis with these ends.
    pub(crate) fn between(low: f64, high: f64) -> Self {
        Self { scale: Scale::Linear, low, high }
    }

    /// A linear axis of shares from `low` to `high`, marked in percent, with a margin.
    pub(crate) fn percent(low: f64, high: f64) -> Self {
        Self { scale: Scale::Percent, ..Self::linear([low, high]) }
    }

    /// A logarithmic axis that holds all positive values with a margin, one decade at least; others have no place on it.
    pub(crate) fn logarithmic(values: impl IntoIterator<Item = f64>) -> Self {
        let logs = values.into_iter().filter(|x| *x > 0.0).map(f64::log10);
        let (low, high) = range(logs).unwrap_or((-1.0, 0.0));
        let short = (1.0 - (high - low)).max(0.0) / 2.0;
        let margin = LOGARITHMIC_MARGIN * (high - low) + short;
        Self { scale: Scale::Decades, low: 10f64.powf(low - margin), high: 10f64.powf(high + margin) }
    }

    /// A logarithmic axis marked at powers of two, that holds all positive values with a margin.
    pub(crate) fn doublings(values: impl IntoIterator<Item = f64>) -> Self {
        let logs = values.into_iter().filter(|x| *x > 0.0).map(f64::log2);
        let (low, high) = range(logs).unwrap_or((0.0, 1.0));
        let margin = (LOGARITHMIC_MARGIN * (high - low)).max(0.3);
        Self { scale: Scale::Doublings, low: (low - margin).exp2(), high: (high + margin).exp2() }
    }

    /// A vertical axis of so many rows, counted from 0 at the top: row `i` is from `i` to `i + 1`.
    pub(crate) fn rows(rows: f64) -> Self {
        Self { scale: Scale::Rows, low: rows, high: 0.0 }
    }

    /// The same with so large a share of its length added at either end.
    #[must_use]
    pub(crate) fn widened(self, share: f64) -> Self {
        let (low, high) = (self.low, self.high);
        match self.scale {
            Scale::Decades | Scale::Doublings => {
                let factor = (high / low).powf(share);
                Self { low: low / factor, high: high * factor, ..self }
            }
            Scale::Linear | Scale::Percent | Scale::Rows => {
                let more = share * (high - low);
                Self { low: low - more, high: high + more, ..self }
            }
        }
    }

    /// The lower end.
    pub(crate) fn low(&self) -> f64 {
        self.low
    }

    /// The upper end.
    pub(crate) fn high(&self) -> f64 {
        self.high
    }

    /// How places grow with values, and both ends, as a script reads them.
    pub(crate) fn words(&self) -> String {
        let scale = match self.scale {
            Scale::Linear | Scale::Percent | Scale::Rows => "linear",
            Scale::Decades | Scale::Doublings => "logarithmic",
        };
        format!("{scale} {} {}", number(self.low), number(self.high))
    }

    /// Whether a value lies between the ends.
    pub(crate) fn holds(&self, x: f64) -> bool {
        (self.low.min(self.high)..=self.high.max(self.low)).contains(&x)
    }

    /// The value, or the end that it lies beyond.
    pub(crate) fn clamp(&self, x: f64) -> f64 {
        x.clamp(self.low.min(self.high), self.high.max(self.low))
    }

    /// Place of a value: 0 at the lower end, 1 at the upper; `None` for a value without a logarithm on a logarithmic axis.
    pub(crate) fn place(&self, x: f64) -> Option<f64> {
        match self.scale {
            Scale::Linear | Scale::Percent | Scale::Rows => Some((x - self.low) / (self.high - self.low)),
            _ if x > 0.0 => Some((x / self.low).ln() / (self.high / self.low).ln()),
            _ => None,
        }
    }

    /// Marks, by increasing value; about `most` of them have a label.
    pub(crate) fn ticks(&self, most: usize) -> Vec<Tick> {
        match self.scale {
            Scale::Linear | Scale::Percent => self.steps(most.max(2)),
            Scale::Decades => self.decades(most.max(2)),
            Scale::Doublings => self.powers_of_two(),
            Scale::Rows => Vec::new(),
        }
    }

    /// Powers of ten, or 1, 2 and 5 of each where fewer than two powers fit; minor ticks where there is room.
    fn decades(&self, most: usize) -> Vec<Tick> {
        let (first, last) = (self.low.log10().ceil() as i32, self.high.log10().floor() as i32);
        let decades = last - first + 1;
        let every = ((decades + most as i32 - 1) / most as i32).max(1);
        let mut ticks = Vec::new();
        for power in first - 1..=last {
            for digit in 1..=9 {
                let at = f64::from(digit) * 10f64.powi(power);
                if !self.holds(at) {
                    continue;
                }
                let label = match digit {
                    1 | 2 | 5 if decades < 2 => Some(plain(at)),
                    1 if power.rem_euclid(every) == 0 => Some(power_of_ten(power)),
                    _ => None,
                };
                if label.is_some() || digit == 1 || decades <= 4 {
                    ticks.push(Tick { at, label });
                }
            }
        }
        ticks
    }

    fn powers_of_two(&self) -> Vec<Tick> {
        let (first, last) = (self.low.log2().ceil() as i32, self.high.log2().floor() as i32);
        (first..=last)
            .map(|power| f64::from(power).exp2())
            .map(|at| Tick { at, label: Some(plain(at)) })
            .collect()
    }

    /// Round steps.
    fn steps(&self, most: usize) -> Vec<Tick> {
        let rough = (self.high - self.low) / most as f64;
        let unit = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|k| k * unit).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * unit);
        let decimals = |step: f64| (-step.log10().floor()).max(0.0) as usize;
        let label = |x: f64| match self.scale {
            Scale::Percent => percent(x, decimals(100.0 * step)),
            _ => match format!("{x:.*}", decimals(step)) {
                long if long.len() > LONGEST_LABEL => minus(&format!("{x:.3e}")),
                label => minus(&label),
            },
        };
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        let tick = |at: f64| Tick { at, label: Some(label(at)) };
        (first..=last).map(|k| tick(k as f64 * step)).collect()
    }
}

/// Letters of a label beyond which it gets an exponent.
const LONGEST_LABEL: usize = 20;

fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|x| x.is_finite())
        .fold(None, |r, x| r.map_or(Some((x, x)), |(low, high): (f64, f64)| Some((low.min(x), high.max(x)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks(5).into_iter().filter_map(|t| t.label).collect()
    }

    #[test]
    fn a_logarithmic_axis_is_marked_at_powers_of_ten() {
        let axis = Axis::logarithmic([1e3, 1e5]);
        assert_eq!(labels(&axis), ["10³", "10⁴", "10⁵"]);
        assert_eq!(axis.place(-1.0), None);
        let place = axis.place(1e4).expect("it is positive");
        assert!((place - 0.5).abs() < 1e-12);
    }

    #[test]
    fn many_decades_are_thinned_and_a_part_of_one_is_filled() {
        assert!(labels(&Axis::logarithmic([1e-9, 1.0])).len() <= 6);
        assert!(labels(&Axis::logarithmic([0.3, 0.4])).len() >= 2);
    }

    #[test]
    fn a_linear_axis_is_marked_at_round_numbers() {
        assert_eq!(labels(&Axis::linear([-0.6, 0.6])), ["−0.5", "0.0", "0.5"].map(str::to_owned).to_vec());
        assert_eq!(labels(&Axis::linear([-20.0, 20.0])), ["−20", "−10", "0", "10", "20"]);
        assert_eq!(labels(&Axis::percent(0.0, 1.0)), ["0 %", "50 %", "100 %"]);
    }

    #[test]
    fn a_widened_axis_has_its_values_further_in() {
        for axis in
            [Axis::linear([1.0, 100.0]), Axis::logarithmic([1.0, 100.0]), Axis::doublings([1.0, 100.0])]
        {
            let (before, after) = (axis.place(1.0), axis.widened(0.25).place(1.0));
            let (before, after) = (before.expect("it has a place"), after.expect("it has a place"));
            assert!((after - (before + 0.25) / 1.5).abs() < 1e-12);
        }
    }

    #[test]
    fn doublings_are_marked_and_nothing_between() {
        assert_eq!(labels(&Axis::doublings([0.5, 4.0])), ["0.5", "1", "2", "4"]);
    }

    #[test]
    fn a_script_reads_scale_and_ends() {
        assert_eq!(Axis::between(-0.5, 10.0).words(), "linear -0.5 10");
        assert!(Axis::doublings([1.0, 4.0]).words().starts_with("logarithmic 0."));
    }

    #[test]
    fn rows_are_counted_downwards() {
        let axis = Axis::rows(4.0);
        assert_eq!((axis.place(0.0), axis.place(4.0)), (Some(1.0), Some(0.0)));
        assert!(axis.holds(3.5) && !axis.holds(4.5) && axis.ticks(5).is_empty());
        assert_eq!(axis.clamp(-1.0), 0.0);
    }

    #[test]
    fn no_value_at_all_still_gives_an_axis() {
        assert!(!labels(&Axis::logarithmic([])).is_empty());
        assert!(!labels(&Axis::linear([])).is_empty());
        assert!(!labels(&Axis::doublings([])).is_empty());
    }
}
