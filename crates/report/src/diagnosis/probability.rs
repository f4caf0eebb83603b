//! A probability as it is printed.

/// Two decimals; certainty is never printed.
pub(crate) fn probability(p: f64) -> String {
    match p {
        p if p.is_nan() => "–".to_owned(),
        p if p > 0.99 => "> 0.99".to_owned(),
        p if p < 0.01 => "< 0.01".to_owned(),
        p => format!("{p:.2}"),
    }
}
