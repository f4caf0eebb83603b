//! Numbers for sentences.

/// A number with `count` significant digits, trailing zeros kept, scientific only where plain digits would be many.
///
/// ```
/// # use switchback_io::diagnosis::digits;
/// assert_eq!(digits(0.12345, 2), "0.12");
/// assert_eq!(digits(1234.5, 2), "1234");
/// assert_eq!(digits(0.0, 3), "0");
/// assert_eq!(digits(-0.0000012, 2), "−1.2e−6");
/// ```
pub fn digits(x: f64, count: usize) -> String {
    if !x.is_finite() {
        return "–".to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    let magnitude = x.abs().log10().floor() as i32;
    let text = if (-4..=6).contains(&magnitude) {
        let decimals = (count as i32 - 1 - magnitude).max(0) as usize;
        format!("{x:.decimals$}")
    } else {
        format!("{x:.*e}", count.saturating_sub(1))
    };
    text.replace('-', "−")
}

/// A share in whole percent, with decimals where it comes closer to 100 than that, up to three; `percent` may be negative.
pub fn whole_percent(percent: f64) -> String {
    let short = 100.0 - percent;
    if short > 0.0 && short < 0.0005 {
        return "> 99.999".to_owned();
    }
    let decimals =
        if short > 0.0 && short < 1.0 { (-short.log10().floor()).clamp(1.0, 3.0) as usize } else { 0 };
    // Adding zero turns the −0 of rounding into 0.
    let rounded = format!("{percent:.decimals$}").parse::<f64>().unwrap_or(percent) + 0.0;
    format!("{rounded:.decimals$}").replace('-', "−")
}

/// Share of a gap that is closed, in whole percent; what is worse than −999 says no more than that.
pub fn closed_percent(percent: f64) -> String {
    if percent < -999.0 { "< −999".to_owned() } else { whole_percent(percent) }
}

/// A fit figure: one decimal; what is worse than −999 says no more than that.
///
/// ```
/// # use switchback_io::diagnosis::fit_percent;
/// assert_eq!(fit_percent(97.25), "97.2");
/// assert_eq!(fit_percent(-68_042_733.0), "< −999");
/// ```
pub fn fit_percent(fit: f64) -> String {
    match fit {
        fit if !fit.is_finite() => "–".to_owned(),
        fit if fit < -999.0 => "< −999".to_owned(),
        fit => format!("{fit:.1}").replace('-', "−"),
    }
}

/// A number without trailing zeros, four significant digits at most: for the edges of cells.
pub fn edge(x: f64) -> String {
    let text = digits(x, 4);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// Half-width of an interval, over the estimate, from which the records do not determine it.
const UNDETERMINED: f64 = 30.0;

/// An estimate below this share of its interval is zero but for rounding.
const ROUNDING: f64 = 1e-12;

/// An estimate with its 90 % interval: `0.12 ± 0.01` where the interval is symmetric, `0.5 [0.3, 0.9]` where it is not, and no
/// figure but the estimate where the records do not determine it.
pub fn with_interval(value: f64, [low, high]: [f64; 2]) -> String {
    if !(low.is_finite() && high.is_finite()) {
        return digits(value, 3);
    }
    let (below, above) = (value - low, high - value);
    let half = 0.5 * (below + above);
    if half <= 0.0 {
        return digits(value, 3);
    }
    // An estimate of zero is one as well: how close to it the parameter lies is what its interval shows.
    let value = if value.abs() < ROUNDING * half { 0.0 } else { value };
    if half > UNDETERMINED * value.abs() && value != 0.0 {
        return format!("{}, undetermined", digits(value, 3));
    }
    // One digit of the error decides how many of the value are worth reporting; two where it begins with a one.
    let first = half / 10f64.powf(half.log10().floor());
    let decimals = (f64::from(u8::from(first < 2.0)) - half.log10().floor()).clamp(0.0, 9.0) as usize;
    let fixed = |x: f64, decimals: usize| format!("{x:.decimals$}").replace('-', "−");
    if (above - below).abs() < 0.2 * half {
        return format!("{} ± {}", fixed(value, decimals), fixed(half, decimals));
    }
    let all = |decimals: usize| [value, low, high].map(|x| fixed(x, decimals));
    // An end close to the estimate needs a digit more to be distinguished from it.
    let [reported, least, most] = match all(decimals) {
        [reported, least, most] if reported == least || reported == most => all(decimals + 1),
        apart => apart,
    };
    format!("{reported} [{least}, {most}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_decides_the_digits() {
        assert_eq!(with_interval(0.12345, [0.1134, 0.1334]), "0.123 ± 0.010");
        assert_eq!(with_interval(0.12345, [0.0934, 0.1534]), "0.12 ± 0.03");
        assert_eq!(with_interval(0.5, [0.3, 0.9]), "0.5 [0.3, 0.9]");
        assert_eq!(with_interval(0.0397, [0.03967, 0.04007]), "0.03970 [0.03967, 0.04007]");
        assert_eq!(with_interval(0.6, [-1e9, 1e9]), "0.600, undetermined");
        assert_eq!(with_interval(1.1e-16, [-0.3, 0.3]), "0.0 ± 0.3");
        assert_eq!(with_interval(2.0, [f64::NAN, f64::NAN]), "2.00");
    }

    #[test]
    fn all_but_a_trace_is_not_all() {
        assert_eq!(whole_percent(96.4), "96");
        assert_eq!(whole_percent(99.93), "99.93");
        assert_eq!(whole_percent(99.999_96), "> 99.999");
        assert_eq!(whole_percent(100.0), "100");
        assert_eq!(whole_percent(-0.2), "0");
        assert_eq!(whole_percent(-112.3), "−112");
    }

    #[test]
    fn a_gap_that_grows_beyond_measure_is_reported_as_such() {
        assert_eq!(closed_percent(-2.7e12), "< −999");
        assert_eq!(closed_percent(-112.3), "−112");
        assert_eq!(closed_percent(97.7), "98");
    }

    #[test]
    fn edges_have_no_trailing_zeros() {
        assert_eq!(edge(0.1), "0.1");
        assert_eq!(edge(-20.0), "−20");
        assert_eq!(edge(123.456), "123.5");
    }
}
