//! Numbers with no more digits than their errors leave them.

use std::fmt;

/// An estimate and the half-width of its interval, both rounded where the second digit of the half-width stands.
///
/// Formats as `value ± half`; outside 10⁻⁴…10⁷ both share a power of ten.
///
/// ```
/// use switchback_identify::PlusMinus;
/// assert_eq!(PlusMinus::new(5751.8, 1555.2).to_string(), "5800 ± 1600");
/// assert_eq!(PlusMinus::new(-0.044045, 0.00996).to_string(), "-0.044 ± 0.010");
/// assert_eq!(PlusMinus::new(1.23456e-7, 3.4e-9).to_string(), "1.235e-7 ± 0.034e-7");
/// assert_eq!(PlusMinus::new(2.5, f64::NAN).to_string(), "2.5000 ± –");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlusMinus {
    /// The estimate.
    pub value: String,
    /// The half-width; `–` where there is none.
    pub half: String,
}

/// Digits of a number without an error: enough to compare by eye.
const BARE_DIGITS: i32 = 5;

impl PlusMinus {
    /// Rounds a pair.
    pub fn new(value: f64, half: f64) -> Self {
        let missing = || "–".to_owned();
        if !value.is_finite() {
            return Self { value: missing(), half: missing() };
        }
        if !(half.is_finite() && half > 0.0) {
            let last = magnitude(value) + 1 - BARE_DIGITS;
            let half = if half == 0.0 { "0".to_owned() } else { missing() };
            return Self { value: written(value, last, exponent(value)), half };
        }
        // 0.0996 has its second digit in the third place only until it is rounded to 0.10.
        let half = rounded(half, magnitude(half) - 1);
        let last = magnitude(half) - 1;
        let exponent = exponent(if value.abs() > half { value } else { half });
        Self { value: written(value, last, exponent), half: written(half, last, exponent) }
    }
}

impl fmt::Display for PlusMinus {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} ± {}", self.value, self.half)
    }
}

/// Power of ten of the first digit.
fn magnitude(x: f64) -> i32 {
    if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 }
}

/// Power of ten that is written out; 0 where plain decimals are readable.
fn exponent(x: f64) -> i32 {
    let magnitude = magnitude(x);
    if (-4..=6).contains(&magnitude) { 0 } else { magnitude }
}

/// To the nearest multiple of `10^last`.
fn rounded(x: f64, last: i32) -> f64 {
    let unit = 10f64.powi(last.abs());
    let nearest = if last < 0 { (x * unit).round() / unit } else { (x / unit).round() * unit };
    // No minus before a zero.
    if nearest == 0.0 { 0.0 } else { nearest }
}

/// `x` down to the decimal place `last`, as a multiple of `10^exponent`.
fn written(x: f64, last: i32, exponent: i32) -> String {
    let x = rounded(x, last) / 10f64.powi(exponent);
    let decimals = usize::try_from(exponent - last).unwrap_or(0);
    if exponent == 0 { format!("{x:.decimals$}") } else { format!("{x:.decimals$}e{exponent}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(value: f64, half: f64) -> String {
        PlusMinus::new(value, half).to_string()
    }

    #[test]
    fn the_second_digit_of_the_half_width_is_the_last_of_both() {
        assert_eq!(reported(0.781_004, 0.000_62), "0.78100 ± 0.00062");
        assert_eq!(reported(-3.4, 12.3), "-3 ± 12");
        assert_eq!(reported(123_456.0, 789.0), "123460 ± 790");
        assert_eq!(reported(0.000_1, 0.16), "0.00 ± 0.16");
        assert_eq!(reported(-0.000_1, 0.16), "0.00 ± 0.16");
        assert_eq!(reported(9.96, 0.099_7), "9.96 ± 0.10");
        assert_eq!(reported(3.2e8, 1.1e7), "3.20e8 ± 0.11e8");
    }

    #[test]
    fn a_number_without_an_error_has_five_digits() {
        assert_eq!(reported(46.345_1, f64::NAN), "46.345 ± –");
        assert_eq!(reported(0.0, f64::INFINITY), "0.0000 ± –");
        assert_eq!(reported(f64::NAN, 1.0), "– ± –");
        assert_eq!(reported(1.0, 0.0), "1.0000 ± 0");
    }
}
