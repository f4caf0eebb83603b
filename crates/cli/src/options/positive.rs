//! Numbers above zero.

/// Parses a finite number.
///
/// # Errors
/// What to give instead.
pub fn number(text: &str) -> Result<f64, String> {
    text.parse::<f64>().ok().filter(|number| number.is_finite()).ok_or_else(|| "give a number".to_owned())
}

/// Parses a finite number above zero.
///
/// # Errors
/// What to give instead.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("give a positive number".to_owned()),
    }
}
