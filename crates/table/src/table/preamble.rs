//! The sample time, where a line above the table says it.

use super::unit;

/// What instruments call the time between samples; letters only, in lower case.
const TIMES: [&str; 17] = [
    "increment",
    "xincrement",
    "xinc",
    "deltax",
    "deltat",
    "dt",
    "sampleinterval",
    "samplinginterval",
    "sampletime",
    "samplingtime",
    "sampleperiod",
    "samplingperiod",
    "timestep",
    "timeincrement",
    "horizontalinterval",
    "hresolution",
    "abtastzeit",
];
/// What they call the samples a second.
const RATES: [&str; 7] =
    ["samplerate", "samplingrate", "samplefrequency", "samplingfrequency", "fs", "abtastrate", "scanrate"];

/// The sample time in the lines above a table, the nearest to it first.
pub(super) fn increment(lines: &[(u64, &str)]) -> Option<f64> {
    lines.iter().rev().find_map(|(_, line)| {
        let bare = line.trim_start_matches(['#', '%', '/', ';', ' ', '\t', '"']);
        let sign = bare.find([':', '=', ',', ';', '\t'])?;
        let (key, rest) =
            (&bare[..sign], bare[sign + 1..].trim_start_matches([':', '=', ',', ';', '\t', ' ', '"']));
        // A comma is decimal where another sign separates.
        let signs: &[char] = if bare[sign..].starts_with(',') { &[',', ';', '\t'] } else { &[';', '\t'] };
        let mut cells = rest.split(signs);
        let value = cells.next()?.trim().trim_end_matches('"');
        let unit = cells.next().map(str::trim).filter(|unit| unit::is_known(unit)).unwrap_or_default();
        entry(key, &format!("{value} {unit}"))
    })
}

/// The sample time that an entry says, as `Increment`, `5e-3` or `Sample rate [kHz]`, `0.2`.
pub(super) fn entry(key: &str, value: &str) -> Option<f64> {
    let (name, own) = unit::split(key);
    let letters: String = name.chars().filter(|c| c.is_alphabetic()).collect::<String>().to_lowercase();
    let (is_time, is_rate) = (TIMES.contains(&letters.as_str()), RATES.contains(&letters.as_str()));
    if !is_time && !is_rate {
        return None;
    }
    let (number, unit) = amount(value)?;
    let unit = unit.or(own);
    let seconds = match unit.as_deref() {
        None if is_time => number,
        None => 1.0 / number,
        Some(unit) if is_time => number * unit::seconds(unit)?,
        // A period under the name of a rate: `Sample Rate: 10 Milliseconds`.
        Some(unit) => match hertz(unit) {
            Some(hertz) => 1.0 / (number * hertz),
            None => number * unit::seconds(unit)?,
        },
    };
    (seconds.is_finite() && seconds > 0.0).then_some(seconds)
}

/// A number and the unit behind it.
fn amount(value: &str) -> Option<(f64, Option<String>)> {
    let value = value.trim().trim_matches('"');
    let is_part = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    let mut end = value.find(|c: char| !is_part(c)).unwrap_or(value.len());
    let number = loop {
        match value.get(..end)?.replace(',', ".").parse::<f64>() {
            Ok(number) => break number,
            Err(_) => end = end.checked_sub(1)?,
        }
    };
    let unit = value[end..].trim().trim_matches(['[', ']', '(', ')']);
    Some((number, (!unit.is_empty()).then(|| unit.to_owned())))
}

fn hertz(unit: &str) -> Option<f64> {
    Some(match unit.to_lowercase().as_str() {
        "hz" | "1/s" | "s/s" | "sa/s" | "samples/s" | "hertz" => 1.0,
        "khz" | "ks/s" | "ksa/s" => 1e3,
        "mhz" | "ms/s" | "msa/s" => 1e6,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sample_time_is_found_however_it_is_said() {
        for line in [
            ";Sample rate,200",
            "# Sampling frequency: 200 Hz",
            "Sample Rate = 0.2 kHz",
            "Delta_X\t0.005\t0.005",
            "Delta_X\t0,005000\t0,005000\t",
            "Sample Interval,5.0e-03,s",
            "Abtastzeit [ms];5",
            "\"Sample Rate:\",\"5 Milliseconds\"",
            "Sample Rate: 5 ms",
            "Sample Period: 5 ms",
        ] {
            let found = increment(&[(1, line)]).unwrap_or_else(|| panic!("{line}"));
            assert!((found - 0.005).abs() < 1e-12, "{line}: {found}");
        }
        assert_eq!(increment(&[(1, "Nr of samples,4733"), (2, "Time\t14:37:48.2")]), None);
    }
}
