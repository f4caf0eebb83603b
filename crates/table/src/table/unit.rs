//! Names of columns and their units.

/// Units that may stand after an underscore (`force_N`) or alone in a row of units. Elsewhere brackets mark a unit, known or not.
const KNOWN: [&str; 62] = [
    "s", "sec", "ms", "us", "µs", "μs", "ns", "min", "h", "N", "kN", "mN", "lbf", "V", "mV", "kV", "A", "mA",
    "m", "mm", "um", "µm", "μm", "nm", "cm", "km", "inch", "rad", "mrad", "deg", "°", "Pa", "kPa", "MPa",
    "bar", "mbar", "psi", "Hz", "kHz", "kg", "g", "m/s", "mm/s", "rad/s", "deg/s", "°/s", "m/s²", "m/s^2",
    "°C", "degC", "K", "W", "kW", "J", "Nm", "N·m", "N*m", "%", "T", "mT", "A/m", "rpm",
];

/// Seconds in a unit of time; none where the unit is another quantity's.
pub fn seconds(unit: &str) -> Option<f64> {
    Some(match unit.trim() {
        "s" | "sec" | "secs" | "second" | "seconds" | "Sekunden" | "S" => 1.0,
        "ms" | "msec" | "millisecond" | "milliseconds" => 1e-3,
        "us" | "µs" | "μs" | "usec" | "microsecond" | "microseconds" => 1e-6,
        "ns" | "nanoseconds" => 1e-9,
        "min" | "minute" | "minutes" => 60.0,
        "h" | "hour" | "hours" => 3600.0,
        "d" | "day" | "days" => 86_400.0,
        _ => return None,
    })
}

/// Words for units, in lower case.
const WORDS: [(&str, &str); 27] = [
    ("second", "s"),
    ("seconds", "s"),
    ("millisecond", "ms"),
    ("milliseconds", "ms"),
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
    ("metre", "m"),
    ("metres", "m"),
    ("meter", "m"),
    ("meters", "m"),
    ("millimetre", "mm"),
    ("millimeter", "mm"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("hertz", "Hz"),
    ("pascal", "Pa"),
    ("percent", "%"),
];

/// The short form of a unit in words.
fn in_words(word: &str) -> Option<&'static str> {
    WORDS.iter().find(|(known, _)| known.eq_ignore_ascii_case(word)).map(|(_, short)| *short)
}

/// Whether a word is a unit.
pub(super) fn is_known(word: &str) -> bool {
    KNOWN.contains(&word) || in_words(word).is_some()
}

/// Whether a cell of a row of units holds one: bracketed, known, or none (`-`, `1`, blank).
fn is_unit(cell: &str) -> bool {
    let bare = unbracketed(cell).unwrap_or(cell).trim();
    bare.is_empty() || bare == "-" || is_known(bare) || unbracketed(cell).is_some()
}

/// Whether a line is a row of units: all of its cells that are no numbers are, but perhaps the first, which may name a counter.
pub(super) fn are_units(cells: &[&str]) -> bool {
    let is_number = |cell: &str| !cell.is_empty() && cell.parse::<f64>().is_ok();
    let units = |cells: &[&str]| cells.iter().all(|cell| is_unit(cell) || is_number(cell));
    let is_some = |cells: &[&str]| cells.iter().any(|cell| is_unit(cell) && !cell.is_empty());
    units(cells) && !cells.iter().all(|cell| is_number(cell))
        || cells.len() > 2 && units(&cells[1..]) && is_some(&cells[1..])
}

/// The unit in a cell of a row of units; none where it is another word or no word.
pub(super) fn bare(cell: &str) -> Option<String> {
    let bare = unbracketed(cell).unwrap_or(cell).trim();
    let is_word = !bare.is_empty() && bare != "-" && is_unit(cell);
    is_word.then(|| in_words(bare).unwrap_or(bare).to_owned())
}

fn unbracketed(cell: &str) -> Option<&str> {
    let cell = cell.trim();
    let within = |open, close| cell.strip_prefix(open).and_then(|rest: &str| rest.strip_suffix(close));
    within('[', ']').or_else(|| within('(', ')')).or_else(|| within('<', '>'))
}

/// Splits `force [N]`, `force (N)`, `force / N` and `force_N` into name and unit.
pub fn split(header: &str) -> (String, Option<String>) {
    let header = header.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(rest) = header.strip_suffix(close)
            && let Some((name, unit)) = rest.rsplit_once(open)
            && !name.trim().is_empty()
        {
            let unit = unit.trim();
            // `pos (5)` is the fifth of several alike.
            if unit.bytes().all(|byte| byte.is_ascii_digit()) && !unit.is_empty() {
                return (header.to_owned(), None);
            }
            return (name.trim().to_owned(), (!unit.is_empty() && unit != "-").then(|| unit.to_owned()));
        }
    }
    if let Some((name, unit)) = header.split_once(" / ").or_else(|| header.rsplit_once('/'))
        && KNOWN.contains(&unit.trim())
        && !name.trim().is_empty()
    {
        return (name.trim().to_owned(), Some(unit.trim().to_owned()));
    }
    if let Some((name, unit)) = header.rsplit_once('_')
        && KNOWN.contains(&unit)
        // `x_m` may be a metre or "measured"; `t_s` can only be seconds.
        && (name.chars().count() > 1 || name.eq_ignore_ascii_case("t"))
    {
        return (name.to_owned(), Some(unit.to_owned()));
    }
    (header.to_owned(), None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_distinguished_from_names() {
        for (header, name, unit) in [
            ("force [N]", "force", Some("N")),
            ("Force (kN)", "Force", Some("kN")),
            ("force_N", "force", Some("N")),
            ("Kraft / N", "Kraft", Some("N")),
            ("speed [m/s]", "speed", Some("m/s")),
            ("travel", "travel", None),
            ("y_sim", "y_sim", None),
            ("x_m", "x_m", None),
            ("t_ms", "t", Some("ms")),
            ("v [-]", "v", None),
            ("[N]", "[N]", None),
            ("pos (5)", "pos (5)", None),
            ("command[0]", "command[0]", None),
        ] {
            assert_eq!(split(header), (name.to_owned(), unit.map(str::to_owned)), "{header}");
        }
    }
}
