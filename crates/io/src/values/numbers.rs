//! Numbers.

use super::ValueError;
use std::ops::RangeInclusive;
use switchback_model::hysteresis::Interval;

/// Parses a finite number.
///
/// # Errors
/// [`ValueError::Number`]
pub fn number(text: &str) -> Result<f64, ValueError> {
    text.parse().ok().filter(|number: &f64| number.is_finite()).ok_or(ValueError::Number)
}

/// Parses a finite number above zero.
///
/// # Errors
/// [`ValueError::Positive`]
pub fn positive(text: &str) -> Result<f64, ValueError> {
    number(text).ok().filter(|number| is_positive(*number)).ok_or(ValueError::Positive)
}

/// Whether a number is finite and above zero.
pub fn is_positive(number: f64) -> bool {
    number.is_finite() && number > 0.0
}

/// A parser of whole numbers within a range.
///
/// ```
/// let parse = switchback_io::values::whole::<u8>(1..=20);
/// assert_eq!(parse("3"), Ok(3));
/// assert_eq!(parse("-1").unwrap_err().to_string(), "give a whole number from 1 to 20");
/// ```
pub fn whole<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, ValueError> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse::<u64>().ok().filter(|number| range.contains(number));
        number.and_then(|number| T::try_from(number).ok()).ok_or_else(|| {
            match (*range.start(), *range.end()) {
                (low, u64::MAX) => ValueError::AtLeast { low },
                (low, high) => ValueError::Within { low, high },
            }
        })
    }
}

/// Parses a share: `0.01`, `1%` or `1 %`.
///
/// # Errors
/// [`ValueError::Positive`]
pub fn share(text: &str) -> Result<f64, ValueError> {
    match text.strip_suffix('%') {
        Some(percent) => positive(percent.trim()).map(|number| number / 100.0),
        None => positive(text),
    }
}

/// Parses two numbers with a comma between them.
///
/// # Errors
/// [`ValueError::Part`] or [`ValueError::Pair`]
pub fn pair(text: &str) -> Result<[f64; 2], ValueError> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| part.trim().parse().map_err(|_| ValueError::Part { part: part.trim().to_owned() }))
        .collect::<Result<_, _>>()?;
    numbers.try_into().map_err(|_| ValueError::Pair)
}

/// Parses a working interval, its lower end first.
///
/// # Errors
/// As of a [`pair`], and [`ValueError::Interval`].
pub fn interval(text: &str) -> Result<Interval, ValueError> {
    let [low, high] = pair(text)?;
    Ok(Interval::new(low, high)?)
}
