//! Names of columns and their units.

use super::unit_words::{in_words, is_suffix};

pub(super) use super::unit_words::{is_known, is_same};

/// Seconds in a unit of time; none where the unit is another quantity's.
pub fn seconds(unit: &str) -> Option<f64> {
    let unit = unit.trim();
    // Of signs the case counts, of words it does not.
    let word = if unit.chars().count() > 2 { unit.to_lowercase() } else { unit.to_owned() };
    Some(match word.as_str() {
        "s" | "sec" | "sec." | "secs" | "second" | "seconds" | "sekunde" | "sekunden" | "S" | "с" | "秒" => {
            1.0
        }
        "ms" | "msec" | "millisecond" | "milliseconds" | "мс" | "毫秒" => 1e-3,
        "us" | "µs" | "μs" | "usec" | "microsecond" | "microseconds" => 1e-6,
        "ns" | "nanoseconds" => 1e-9,
        "min" | "minute" | "minutes" => 60.0,
        "h" | "hour" | "hours" => 3600.0,
        "d" | "day" | "days" => 86_400.0,
        _ => return None,
    })
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

/// Whether most words of a line are units, two at least: among them may be some that nobody knows.
pub(super) fn are_mostly_units(cells: &[&str]) -> bool {
    let (known, words) = counted(cells.iter().copied());
    known >= 2 && 2 * known > words
}

/// Whether a line is units below names: at least half of the words that the line above does not repeat, while there it has none.
pub(super) fn are_units_below(cells: &[&str], above: &[&str]) -> bool {
    let differ = || cells.iter().zip(above).filter(|(cell, above)| cell != above);
    let (known, words) = counted(differ().map(|(cell, _)| *cell));
    let (above, _) = counted(differ().map(|(_, above)| *above));
    known >= 2 && (2 * known >= words && above == 0 || are_mostly_units(cells)) && 2 * above <= known
}

/// How many words are units, and how many there are.
fn counted<'t>(cells: impl Iterator<Item = &'t str>) -> (usize, usize) {
    let words = cells.filter(|cell| !cell.is_empty() && cell.parse::<f64>().is_err());
    words.fold((0, 0), |(known, words), cell| (known + usize::from(is_unit(cell)), words + 1))
}

/// The unit in a cell of a row of units; none where it is another word or no word.
pub(super) fn bare(cell: &str) -> Option<String> {
    let bare = unbracketed(cell).unwrap_or(cell).trim();
    let is_word = !bare.is_empty() && bare != "-" && is_unit(cell);
    is_word.then(|| in_words(bare).unwrap_or(bare).to_owned())
}

/// The same where the words of other cells show that this one is meant as a unit, though nobody knows it.
pub(super) fn meant(cell: &str) -> Option<String> {
    // `segments`, but neither `Time` nor `A1`.
    let is_word = cell.starts_with(char::is_lowercase)
        && cell.chars().count() <= LONGEST
        && !cell.contains(|c: char| c.is_ascii_digit());
    bare(cell).or_else(|| is_word.then(|| cell.to_owned()))
}

/// Letters of the longest unit.
const LONGEST: usize = 12;

/// What brackets a unit.
const BRACKETS: [(char, char); 4] = [('[', ']'), ('(', ')'), ('<', '>'), ('{', '}')];

fn unbracketed(cell: &str) -> Option<&str> {
    let cell = cell.trim();
    if let Some(unit) = cell.strip_prefix("in ") {
        return is_known(unit).then_some(unit);
    }
    BRACKETS.iter().find_map(|(open, close)| cell.strip_prefix(*open)?.strip_suffix(*close))
}

/// Splits `force [N]`, `force (N)`, `force / N`, `force, N`, `force in N` and `force_N` into name and unit.
pub fn split(header: &str) -> (String, Option<String>) {
    let header = header.trim();
    // Names within quotation marks, as of a channel in a group.
    if let Some(quoted) = header.strip_suffix('\'')
        && let (name, Some(unit)) = bracketed(quoted)
    {
        return (name + "'", Some(unit));
    }
    if BRACKETS.iter().any(|(_, close)| header.ends_with(*close)) {
        return bracketed(header);
    }
    let owned = |(name, unit): (&str, &str)| (name.trim().to_owned(), Some(unit.trim().to_owned()));
    let is_name = |(name, unit): &(&str, &str)| is_suffix(unit.trim()) && !name.trim().is_empty();
    // The strokes of `km/h` divide units, and those of a path are no others.
    let strokes = || {
        let is_path = header.starts_with('/') || is_known(header);
        let all = if is_path { "" } else { header };
        all.match_indices('/').map(|(at, _)| (&header[..at], &header[at + 1..]))
    };
    let split = header.rsplit_once(", ").or_else(|| header.rsplit_once(" in ")).filter(is_name);
    let split = split.or_else(|| header.split_once(" / ").filter(is_name));
    if let Some(split) = split.or_else(|| strokes().find(is_name)) {
        return owned(split);
    }
    if let Some(split) = quotient(header) {
        return split;
    }
    if let Some((name, unit)) = header.rsplit_once('_')
        && is_suffix(unit)
        // `x_m` may be a metre or "measured"; `t_s` can only be seconds.
        && (name.chars().count() > 1 || name.eq_ignore_ascii_case("t"))
    {
        return (name.to_owned(), Some(unit.to_owned()));
    }
    (header.to_owned(), None)
}

/// Splits what ends in a bracket.
fn bracketed(header: &str) -> (String, Option<String>) {
    for (open, close) in BRACKETS {
        if let Some(rest) = header.strip_suffix(close)
            && let Some((name, unit)) = opened(rest, (open, close))
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
    (header.to_owned(), None)
}

/// What stands before and behind the bracket that the end closes: `damping (N/(m/s)` is open at the first.
fn opened(rest: &str, (open, close): (char, char)) -> Option<(&str, &str)> {
    let mut depth = 0;
    for (at, sign) in rest.char_indices().rev() {
        if sign == close {
            depth += 1;
        } else if sign == open && depth == 0 {
            return Some((&rest[..at], &rest[at + 1..]));
        } else if sign == open {
            depth -= 1;
        }
    }
    None
}

/// `speed_mm_s` and `acceleration_m_s2`: names for programs have no strokes.
fn quotient(header: &str) -> Option<(String, Option<String>)> {
    let (rest, below) = header.rsplit_once('_')?;
    let (name, above) = rest.rsplit_once('_')?;
    let is_time = ["s", "s2", "min", "h"].contains(&below);
    let is_other = is_suffix(above) && seconds(above).is_none();
    (is_time && is_other && !name.is_empty()).then(|| (name.to_owned(), Some(format!("{above}/{below}"))))
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
            ("km/h", "km/h", None),
            ("speed/km/h", "speed", Some("km/h")),
            ("/joint/1/m", "/joint/1/m", None),
            ("Kraft, kN", "Kraft", Some("kN")),
            ("Weg in mm", "Weg", Some("mm")),
            ("change in temperature", "change in temperature", None),
            ("omega_rad_s", "omega", Some("rad/s")),
            ("a_m_s2", "a", Some("m/s2")),
            ("damping (N/(m/s))", "damping", Some("N/(m/s)")),
            ("travel <mm>", "travel", Some("mm")),
            ("/'Measured'/'Load [N]'", "/'Measured'/'Load'", Some("N")),
        ] {
            assert_eq!(split(header), (name.to_owned(), unit.map(str::to_owned)), "{header}");
        }
    }
}
