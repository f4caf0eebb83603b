//! Words and signs that are units.

/// Units that may stand behind an underscore (`force_N`) or a stroke (`Kraft/N`).
const SUFFIXES: [&str; 94] = [
    "s", "sec", "ms", "us", "µs", "μs", "ns", "min", "h", "N", "kN", "mN", "daN", "lbf", "lbs", "V", "mV",
    "kV", "A", "mA", "m", "mm", "um", "µm", "μm", "nm", "cm", "km", "inch", "rad", "mrad", "deg", "°", "Pa",
    "kPa", "MPa", "bar", "mbar", "psi", "Hz", "kHz", "kg", "g", "m/s", "mm/s", "rad/s", "deg/s", "°/s",
    "m/s²", "m/s^2", "°C", "℃", "degC", "degF", "K", "W", "kW", "J", "Nm", "N·m", "N*m", "%", "T", "mT",
    "A/m", "rpm", "kmh", "kph", "mph", "ips", "Ohm", "с", "мс", "мм", "м", "Н", "кН", "В", "мВ", "А", "мА",
    "Па", "кПа", "МПа", "бар", "Гц", "рад", "град", "°С", "кг", "об", "мин", "秒", "毫秒",
];

/// Units that take the prefixes of the SI.
const PREFIXED: [&str; 18] =
    ["s", "m", "N", "V", "A", "g", "Pa", "Hz", "W", "J", "T", "rad", "bar", "Nm", "Ω", "Ohm", "ohm", "Wb"];

/// The prefixes of measurements.
const PREFIXES: [&str; 7] = ["n", "µ", "μ", "u", "m", "k", "M"];

/// Other units that may stand alone in a row of units, as they are written.
const SIGNS: [&str; 26] = [
    "in", "ft", "mil", "lb", "kp", "kgf", "cN", "dN", "dm", "°F", "℉", "deg C", "deg F", "deg. C", "GPa",
    "GHz", "mmHg", "min-1", "min^-1", "min⁻¹", "s-1", "s^-1", "s⁻¹", "‰", "VA", "dB",
];

/// Units of a part of a quotient or product only: alone they are words or initials.
const PARTS: [&str; 12] = ["U", "tr", "rev", "r", "d", "l", "L", "mol", "FS", "h", "min", "cnt"];

/// Words for units in lower case, and their short form.
const WORDS: [(&str, &str); 67] = [
    ("sec", "sec"),
    ("sec.", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("sekunde", "s"),
    ("sekunden", "s"),
    ("msec", "ms"),
    ("millisecond", "ms"),
    ("milliseconds", "ms"),
    ("usec", "us"),
    ("microsecond", "us"),
    ("microseconds", "us"),
    ("minutes", "min"),
    ("hours", "h"),
    ("volt", "V"),
    ("volts", "V"),
    ("millivolt", "mV"),
    ("ampere", "A"),
    ("amperes", "A"),
    ("amp", "A"),
    ("amps", "A"),
    ("newton", "N"),
    ("newtons", "N"),
    ("kilonewton", "kN"),
    ("newton-meter", "Nm"),
    ("newtonmeter", "Nm"),
    ("metre", "m"),
    ("metres", "m"),
    ("meter", "m"),
    ("meters", "m"),
    ("millimetre", "mm"),
    ("millimetres", "mm"),
    ("millimeter", "mm"),
    ("millimeters", "mm"),
    ("inch", "inch"),
    ("inches", "inch"),
    ("feet", "ft"),
    ("lbf", "lbf"),
    ("lbs", "lbs"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("grad", "deg"),
    ("degc", "degC"),
    ("degf", "degF"),
    ("celsius", "°C"),
    ("fahrenheit", "°F"),
    ("kelvin", "K"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("hertz", "Hz"),
    ("pascal", "Pa"),
    ("percent", "%"),
    ("prozent", "%"),
    ("watt", "W"),
    ("rpm", "rpm"),
    ("kmh", "km/h"),
    ("kph", "km/h"),
    ("mph", "mph"),
    ("ips", "ips"),
    ("count", "count"),
    ("counts", "counts"),
    ("digits", "digits"),
    ("ticks", "ticks"),
    ("cycles", "cycles"),
    ("segments", "segments"),
    ("revolutions", "rev"),
];

/// The short form of a unit in words.
pub(super) fn in_words(word: &str) -> Option<&'static str> {
    WORDS.iter().find(|(known, _)| known.eq_ignore_ascii_case(word)).map(|(_, short)| *short)
}

/// Whether a word is a unit: a sign or word for one, or units multiplied and divided.
pub(super) fn is_known(word: &str) -> bool {
    is_single(word) || is_compound(word)
}

/// Whether letters behind an underscore or a stroke are a unit.
pub(super) fn is_suffix(word: &str) -> bool {
    SUFFIXES.contains(&word) || is_compound(word)
}

/// Whether two units are one, written in two ways.
pub(super) fn is_same(one: &str, other: &str) -> bool {
    let usual = |unit: &str| -> String {
        let unit = unit.trim();
        let short = in_words(unit).unwrap_or(unit);
        let plain = short.replace('μ', "µ").replace("deg. ", "deg").replace("deg ", "deg").replace('℃', "°C");
        plain.replace('℉', "°F").replace("deg", "°").replace("sec", "s").replace("inch", "in")
    };
    one == other || usual(one) == usual(other)
}

fn is_single(word: &str) -> bool {
    SUFFIXES.contains(&word) || SIGNS.contains(&word) || is_prefixed(word) || in_words(word).is_some()
}

fn is_prefixed(word: &str) -> bool {
    let is_base = |rest: &str| PREFIXED.contains(&rest);
    is_base(word) || PREFIXES.iter().any(|prefix| word.strip_prefix(prefix).is_some_and(is_base))
}

/// Units joined by strokes, points or stars: `km/h`, `N·m`, `1/min`, `N/(m/s)`.
fn is_compound(word: &str) -> bool {
    let is_joint = |sign: char| "/*·⋅×.()".contains(sign);
    // Not available.
    if word == "N/A" || !word.contains(is_joint) || word.starts_with(is_joint) || word.ends_with('/') {
        return false;
    }
    let is_inverse = word.starts_with("1/");
    let mut parts = word.split(is_joint).filter(|part| !part.is_empty()).peekable();
    if is_inverse {
        parts.next();
    }
    let is_part = |part: &str| {
        let bare = part.trim().trim_end_matches(|c: char| c.is_ascii_digit() || "²³^-⁻¹".contains(c));
        is_single(bare) || PARTS.contains(&bare)
    };
    let (parts, count) = (parts.clone(), parts.count());
    (count >= 2 || is_inverse && count == 1) && parts.into_iter().all(is_part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_alone_and_joined() {
        for unit in [
            "km/h", "mph", "daN", "lbs", "lbf", "℃", "degF", "deg C", "Sec", "in/sec", "ips", "rpm", "1/min",
            "bar", "psi", "g", "mg", "µV", "kNm", "MHz", "N·m", "N/(m/s)", "m/s²", "m/s^2", "U/min", "rad/s",
            "mV/V", "kN*m", "min-1",
        ] {
            assert!(is_known(unit), "{unit}");
        }
        for word in
            ["Time", "Force", "raw", "/", "1", "1/", "pos.x", "a/b", "F", "t", "FL/FR", "N/A", "km/", ""]
        {
            assert!(!is_known(word), "{word}");
        }
        assert!(is_same("°C", "degC") && is_same("sec", "s") && is_same("Percent", "%"));
        assert!(!is_same("mV", "V"));
    }
}
