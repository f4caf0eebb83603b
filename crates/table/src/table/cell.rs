//! What a cell says: a number, a time stamp, nothing, or text.

use jiff::civil::{DateTime, Time};
use jiff::{Timestamp, tz::TimeZone};

/// What a cell says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    /// A number, perhaps infinite.
    Number(f64),
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
    match number(cell, decimal) {
        Some(value) if value.is_nan() => Cell::Missing,
        Some(value) => Cell::Number(value),
        None if cell.is_empty() || MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) => {
            Cell::Missing
        }
        None => stamp(cell).unwrap_or(Cell::Text),
    }
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

/// ISO 8601: date and time with or without an offset, or a time of day.
fn stamp(cell: &str) -> Option<Cell> {
    let digits = cell.bytes().next()?.is_ascii_digit();
    if !digits || !cell.contains(':') {
        return None;
    }
    if let Ok(instant) = cell.parse::<Timestamp>() {
        return Some(Cell::Stamp(instant.as_nanosecond()));
    }
    if cell.as_bytes().get(4) == Some(&b'-') {
        let local: DateTime = cell.parse().ok()?;
        return TimeZone::UTC.to_timestamp(local).ok().map(|instant| Cell::Stamp(instant.as_nanosecond()));
    }
    let time: Time = cell.parse().ok()?;
    Some(Cell::Clock(time.duration_since(Time::midnight()).as_nanos()))
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
