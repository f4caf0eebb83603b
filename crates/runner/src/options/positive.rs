//! Numbers above zero.

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
