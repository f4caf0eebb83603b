//! Whole numbers.

use std::ops::RangeInclusive;

/// A parser of whole numbers within a range.
///
/// ```
/// let parse = switchback::options::whole::<u8>(1..=20);
/// assert_eq!(parse("3"), Ok(3));
/// assert_eq!(parse("-1"), Err("give a whole number from 1 to 20".to_owned()));
/// ```
pub fn whole<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse::<u64>().ok().filter(|number| range.contains(number));
        number.and_then(|number| T::try_from(number).ok()).ok_or_else(|| match (range.start(), range.end()) {
            (low, &u64::MAX) => format!("give a whole number, {low} or more"),
            (low, high) => format!("give a whole number from {low} to {high}"),
        })
    }
}
