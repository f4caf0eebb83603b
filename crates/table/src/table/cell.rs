//! What a cell says: a number, a time stamp, nothing, or text.

use super::dates::{self, Format, Stamp};
use super::unit_words::is_known;

/// What a cell says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    /// A number, perhaps infinite.
    Number(f64),
    /// A number with its [unit](quantity) behind it.
    Quantity(f64),
    /// Nanoseconds since some instant.
    Stamp(i128),
    /// Nanoseconds since midnight.
    Clock(i128),
    /// Empty, or one of the words for it.
    Missing,
    /// Anything else.
    Text,
}

/// The sign between a number's whole part and its fraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Decimal {
    Point,
    Comma,
}

impl Decimal {
    pub(super) fn other(self) -> Self {
        match self {
            Self::Point => Self::Comma,
            Self::Comma => Self::Point,
        }
    }
}

/// Words that stand for a value that was not measured; lower case.
const MISSING: [&str; 10] = ["nan", "-nan", "na", "n/a", "#n/a", "null", "none", "nil", "-", "--"];

pub(super) fn read(cell: &str, decimal: Decimal) -> Cell {
    read_in(cell, decimal, &mut None)
}

/// The same where cells like it came before: their format of times is tried first, and kept.
pub(super) fn read_in(cell: &str, decimal: Decimal, format: &mut Option<Format>) -> Cell {
    match number(cell, decimal) {
        Some(value) if value.is_nan() => Cell::Missing,
        Some(value) => Cell::Number(value),
        None => otherwise(cell, decimal, format),
    }
}

/// What a cell says that is no plain number.
#[inline(never)]
fn otherwise(cell: &str, decimal: Decimal, format: &mut Option<Format>) -> Cell {
    if cell.is_empty() || MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) {
        return Cell::Missing;
    }
    match dates::read(cell, *format) {
        Some((stamp, found)) => {
            *format = Some(found);
            match stamp {
                Stamp::Instant(nanoseconds) => Cell::Stamp(nanoseconds),
                Stamp::Clock(nanoseconds) => Cell::Clock(nanoseconds),
            }
        }
        None => quantity(cell, decimal).map_or(Cell::Text, |(value, _)| Cell::Quantity(value)),
    }
}

/// Whether a number with a unit may be a name: `12Hz`, but neither `12 Hz` nor `12%`.
pub(super) fn is_name(cell: &str) -> bool {
    let unit = cell.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.,".contains(c));
    unit.starts_with(char::is_alphabetic)
}

/// A number and the unit behind it, as in `31.0 °C` and `12.3%`.
pub(super) fn quantity(cell: &str, decimal: Decimal) -> Option<(f64, &str)> {
    let is_part = |sign: char| sign.is_ascii_digit() || "+-.,eE\u{2212}".contains(sign);
    if !cell.starts_with(|first: char| first.is_ascii_digit() || "+-.\u{2212}".contains(first)) {
        return None;
    }
    let end = cell.find(|sign| !is_part(sign))?;
    let unit = cell[end..].trim();
    let bare = unit.strip_prefix(['[', '(']).map_or(unit, |open| open.trim_end_matches([']', ')']));
    let value = number(&cell[..end], decimal).filter(|value| value.is_finite())?;
    is_known(bare).then_some((value, bare))
}

/// The library's reader, fed a point where commas are decimal.
fn number(cell: &str, decimal: Decimal) -> Option<f64> {
    if let Decimal::Comma = decimal
        && let Some((whole, fraction)) = cell.split_once(',')
    {
        if cell.contains('.') || !fraction.starts_with(|digit: char| digit.is_ascii_digit()) {
            return None;
        }
        return format!("{whole}.{fraction}").parse().ok();
    }
    if decimal == Decimal::Comma && cell.contains('.') {
        return None;
    }
    match cell.parse() {
        Ok(value) => Some(value),
        // Word processors and some loggers write the minus sign proper.
        Err(_) if cell.starts_with('\u{2212}') => cell.replacen('\u{2212}', "-", 1).parse().ok(),
        Err(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbers_stamps_nothing_or_text() {
        assert_eq!(read("-1.5e-3", Decimal::Point), Cell::Number(-1.5e-3));
        assert_eq!(read("-1,5E-3", Decimal::Comma), Cell::Number(-1.5e-3));
        assert_eq!(read("1,5", Decimal::Point), Cell::Text);
        assert_eq!(read("1,", Decimal::Comma), Cell::Text);
        assert_eq!(read("1.5", Decimal::Comma), Cell::Text);
        assert_eq!(read("\u{2212}2", Decimal::Point), Cell::Number(-2.0));
        for missing in ["", "NaN", "n/a", "NULL", "-"] {
            assert_eq!(read(missing, Decimal::Point), Cell::Missing, "{missing}");
        }
        for (cell, decimal, value) in [
            ("12.3%", Decimal::Point, 12.3),
            ("31,0 °C", Decimal::Comma, 31.0),
            ("0.005 sec", Decimal::Point, 0.005),
            ("-1e-3 [kN]", Decimal::Point, -1e-3),
            ("4 km/h", Decimal::Point, 4.0),
        ] {
            assert_eq!(read(cell, decimal), Cell::Quantity(value), "{cell}");
        }
        for text in ["1,5 %", "3 bolts", "0x1A", "12 %s", "% 12", "5 5 mm"] {
            assert_eq!(read(text, Decimal::Point), Cell::Text, "{text}");
        }
        assert_eq!(read("1e999", Decimal::Point), Cell::Number(f64::INFINITY));
        assert_eq!(read("OK", Decimal::Point), Cell::Text);
    }

    #[test]
    fn stamps_with_and_without_an_offset_differ_by_what_passed() {
        let ns = |cell| match read(cell, Decimal::Point) {
            Cell::Stamp(ns) | Cell::Clock(ns) => ns,
            other => panic!("{cell}: {other:?}"),
        };
        assert_eq!(ns("2024-05-01T10:00:00.250Z") - ns("2024-05-01T12:00:00+02:00"), 250_000_000);
        assert_eq!(ns("2024-05-01 10:00:01") - ns("2024-05-01 10:00:00.999"), 1_000_000);
        assert_eq!(ns("10:00:00.004") - ns("10:00:00"), 4_000_000);
    }
}
