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
        _ => return None,
    })
}

/// Whether a cell of a row of units holds one: bracketed, known, or none (`-`, `1`, blank).
pub(super) fn is_unit(cell: &str) -> bool {
    let bare = unbracketed(cell).unwrap_or(cell).trim();
    bare.is_empty() || bare == "-" || KNOWN.contains(&bare) || unbracketed(cell).is_some()
}

/// What a cell of a row of units says.
pub(super) fn bare(cell: &str) -> Option<String> {
    let bare = unbracketed(cell).unwrap_or(cell).trim();
    (!bare.is_empty() && bare != "-").then(|| bare.to_owned())
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
        ] {
            assert_eq!(split(header), (name.to_owned(), unit.map(str::to_owned)), "{header}");
        }
    }
}
