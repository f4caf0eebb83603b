//! Axes: from values to places, and the ticks between.

/// A linear or logarithmic axis from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    logarithmic: bool,
    low: f64,
    high: f64,
}

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// The value marked.
    pub at: f64,
    /// What is written there; nothing at a minor tick.
    pub label: Option<String>,
}

impl Axis {
    /// A linear axis that holds all values with a margin; around 0 where there is none.
    pub fn linear(values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 1.0));
        let margin = if high > low { 0.05 * (high - low) } else { low.abs().max(1.0) * 0.1 };
        Self { logarithmic: false, low: low - margin, high: high + margin }
    }

    /// A logarithmic axis that holds all positive values with a margin, one decade at least; others have no place on it.
    pub fn logarithmic(values: impl IntoIterator<Item = f64>) -> Self {
        let logs = values.into_iter().filter(|x| *x > 0.0).map(f64::log10);
        let (low, high) = range(logs).unwrap_or((-1.0, 0.0));
        let short = (1.0 - (high - low)).max(0.0) / 2.0;
        let margin = 0.06 * (high - low) + short;
        Self { logarithmic: true, low: 10f64.powf(low - margin), high: 10f64.powf(high + margin) }
    }

    /// The lower end.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The upper end.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Place of a value: 0 at the lower end, 1 at the upper; `None` for what a logarithmic axis cannot hold.
    pub fn place(&self, x: f64) -> Option<f64> {
        match self.logarithmic {
            false => Some((x - self.low) / (self.high - self.low)),
            true if x > 0.0 => Some((x / self.low).ln() / (self.high / self.low).ln()),
            true => None,
        }
    }

    /// Marks, by increasing value.
    pub fn ticks(&self) -> Vec<Tick> {
        if self.logarithmic { self.decades() } else { self.steps() }
    }

    /// Powers of ten, or 1, 2 and 5 of each where fewer than two powers fit; minor ticks where there is room.
    fn decades(&self) -> Vec<Tick> {
        let (first, last) = (self.low.log10().ceil() as i32, self.high.log10().floor() as i32);
        let decades = last - first + 1;
        let every = ((decades + 4) / 5).max(1);
        let mut ticks = Vec::new();
        for power in first - 1..=last {
            for digit in 1..=9 {
                let at = f64::from(digit) * 10f64.powi(power);
                if at < self.low || at > self.high {
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

    /// Round steps, about five of them.
    fn steps(&self) -> Vec<Tick> {
        let rough = (self.high - self.low) / 5.0;
        let unit = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|k| k * unit).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * unit);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        (first..=last)
            .map(|k| Tick {
                at: k as f64 * step,
                label: Some(minus(&format!("{:.decimals$}", k as f64 * step))),
            })
            .collect()
    }
}

fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|x| x.is_finite())
        .fold(None, |r, x| r.map_or(Some((x, x)), |(low, high): (f64, f64)| Some((low.min(x), high.max(x)))))
}

/// `10⁻³`.
fn power_of_ten(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits: String =
        power.unsigned_abs().to_string().bytes().map(|b| DIGITS[usize::from(b - b'0')]).collect();
    format!("10{}{digits}", if power < 0 { "⁻" } else { "" })
}

/// A short number: plain where it has few digits, scientific elsewhere.
pub fn plain(x: f64) -> String {
    let text = if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        format!("{}", (x * 1e9).round() / 1e9)
    } else {
        format!("{x:e}")
    };
    minus(&text)
}

/// The typographic minus sign.
fn minus(text: &str) -> String {
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().filter_map(|t| t.label).collect()
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
    }

    #[test]
    fn no_value_at_all_still_gives_an_axis() {
        assert!(!labels(&Axis::logarithmic([])).is_empty());
        assert!(!labels(&Axis::linear([])).is_empty());
    }
}
