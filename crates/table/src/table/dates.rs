//! Dates and times as spreadsheets and loggers write them, beside ISO 8601.

use jiff::Timestamp;
use jiff::civil::{DateTime, Time};
use jiff::fmt::strtime;
use jiff::tz::TimeZone;

/// What a stamp counts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stamp {
    /// Nanoseconds since some instant.
    Instant(i128),
    /// Nanoseconds since midnight.
    Clock(i128),
}

/// A way to write a time: ISO 8601 first, where it is 0, then those of [`WRITTEN`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Format(usize);

/// Dates with times, in the order in which they are tried: days of the month beyond 12 distinguish German and American ones.
const WRITTEN: [&str; 36] = [
    "%d.%m.%Y %H:%M:%S%.f",
    "%m/%d/%Y %I:%M:%S%.f %p",
    "%d/%m/%Y %I:%M:%S%.f %p",
    "%m/%d/%Y %H:%M:%S%.f",
    "%d/%m/%Y %H:%M:%S%.f",
    "%Y/%m/%d %H:%M:%S%.f",
    "%Y.%m.%d %H:%M:%S%.f",
    "%d-%b-%Y %H:%M:%S%.f",
    "%d %b %Y %H:%M:%S%.f",
    "%b %d %Y %H:%M:%S%.f",
    "%b %d %Y %I:%M:%S%.f %p",
    "%d-%m-%Y %H:%M:%S%.f",
    "%Y-%m-%d %I:%M:%S%.f %p",
    "%d.%m.%y %H:%M:%S%.f",
    "%m/%d/%y %I:%M:%S%.f %p",
    "%m/%d/%y %H:%M:%S%.f",
    "%d/%m/%y %H:%M:%S%.f",
    "%d.%m.%Y %H:%M",
    "%m/%d/%Y %I:%M %p",
    "%m/%d/%Y %H:%M",
    "%d/%m/%Y %H:%M",
    "%Y/%m/%d %H:%M",
    "%d-%b-%y %H:%M:%S%.f",
    "%d-%b-%y %I:%M:%S%.f %p",
    "%d-%b-%Y %I:%M:%S%.f %p",
    "%d %b %y %H:%M:%S%.f",
    "%d %b %Y %I:%M:%S%.f %p",
    "%d %B %Y %H:%M:%S%.f",
    "%d %B %Y %I:%M:%S%.f %p",
    "%B %d %Y %H:%M:%S%.f",
    "%B %d %Y %I:%M:%S%.f %p",
    "%a %b %d %H:%M:%S%.f %Y",
    "%a %d %b %Y %H:%M:%S%.f",
    "%A %B %d %Y %I:%M:%S%.f %p",
    "%d-%b-%y %H:%M",
    "%d-%b-%Y %H:%M",
];

/// Times of day.
const CLOCKS: [&str; 2] = ["%H:%M:%S%.f", "%I:%M:%S%.f %p"];

/// Of the formats above and of ISO 8601, the last; behind it are lengths of time.
const LAST: usize = WRITTEN.len() + CLOCKS.len();

/// Reads a cell in the format given, else in any; with the format that it is in.
pub(super) fn read(cell: &str, usual: Option<Format>) -> Option<(Stamp, Format)> {
    if !has_clock(cell) {
        return None;
    }
    let in_usual = usual.and_then(|format| Some((in_format(cell, format)?, format)));
    let in_any = || {
        let all = (0..=LAST + 1).map(Format);
        all.filter_map(|format| Some((in_format(cell, format)?, format))).next()
    };
    in_usual.or_else(in_any)
}

/// Whether a cell can be a time at all: digits on both sides of its first colon, and no other signs than dates have.
fn has_clock(cell: &str) -> bool {
    let bytes = cell.as_bytes();
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let is_sign =
        |byte: &u8| byte.is_ascii_alphanumeric() || b" :.,;-/+[]_".contains(byte) || !byte.is_ascii();
    let clock = bytes.iter().position(|byte| *byte == b':');
    clock.is_some_and(|colon| colon > 0 && is_digit(colon - 1) && is_digit(colon + 1))
        && bytes.iter().all(is_sign)
}

fn in_format(cell: &str, Format(number): Format) -> Option<Stamp> {
    let Some(number) = number.checked_sub(1) else { return iso(cell) };
    let plain = plain(cell);
    if number == LAST {
        return in_days(&plain);
    }
    match WRITTEN.get(number) {
        Some(format) => {
            let local = strtime::parse(format, &plain).ok()?.to_datetime().ok()?;
            instant(local)
        }
        None => {
            let time = strtime::parse(CLOCKS[number - WRITTEN.len()], &plain).ok()?.to_time().ok()?;
            Some(Stamp::Clock(time.duration_since(Time::midnight()).as_nanos()))
        }
    }
}

/// ISO 8601: date and time with or without an offset, or a time of day.
fn iso(cell: &str) -> Option<Stamp> {
    if !cell.starts_with(|first: char| first.is_ascii_digit()) {
        return None;
    }
    if let Ok(instant) = cell.parse::<Timestamp>() {
        return Some(Stamp::Instant(instant.as_nanosecond()));
    }
    if cell.as_bytes().get(4) == Some(&b'-') {
        return instant(cell.parse().ok()?);
    }
    let time: Time = cell.parse().ok()?;
    Some(Stamp::Clock(time.duration_since(Time::midnight()).as_nanos()))
}

/// A length of time, as data frames write it: `0 days 00:00:00.005`, `-1 days +23:59:59.995`, `1 day, 0:00:01`.
fn in_days(cell: &str) -> Option<Stamp> {
    const SECOND: i128 = 1_000_000_000;
    let (days, rest) = cell.split_once(" day")?;
    let rest = rest.strip_prefix('s').unwrap_or(rest).trim_start();
    let mut parts = rest.strip_prefix('+').unwrap_or(rest).splitn(3, ':');
    let mut whole = || parts.next()?.parse::<u8>().ok().map(i128::from);
    let (hours, minutes) = (whole()?, whole()?);
    let (seconds, fraction) = parts.next().map(|seconds| seconds.split_once('.').unwrap_or((seconds, "")))?;
    let is_number = fraction.len() <= 9 && fraction.bytes().all(|byte| byte.is_ascii_digit());
    let nanoseconds: i128 = format!("{fraction:0<9}").parse().ok().filter(|_| is_number)?;
    let seconds = seconds.parse::<u8>().ok().map(i128::from)?;
    let days = i128::from(days.parse::<i32>().ok()?);
    let whole = ((24 * days + hours) * 60 + minutes) * 60 + seconds;
    Some(Stamp::Instant(whole * SECOND + nanoseconds))
}

fn instant(local: DateTime) -> Option<Stamp> {
    // A year of two digits is read by the formats for it.
    const FIRST_YEAR: i16 = 1900;
    if local.year() < FIRST_YEAR {
        return None;
    }
    TimeZone::UTC.to_timestamp(local).ok().map(|instant| Stamp::Instant(instant.as_nanosecond()))
}

/// Points before fractions of a second, whatever was written there, and single blanks elsewhere.
fn plain(cell: &str) -> String {
    let mut plain = cell.replace(", ", " ");
    // 19:13:58,005, 19:13:58;005 and 19:13:58:005.
    let colons: Vec<usize> = plain.match_indices(':').map(|(at, _)| at).collect();
    if let [_, _, third] = colons[..] {
        plain.replace_range(third..=third, ".");
    }
    plain.replace([',', ';'], ".").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_of_all_countries_are_the_same_instant() {
        let wanted = Stamp::Instant(1_794_683_638_005_000_000);
        for cell in [
            "2026-11-14T19:13:58.005",
            "2026-11-14 19:13:58.005",
            "2026-11-14 07:13:58.005 PM",
            "14.11.2026 19:13:58,005",
            "14.11.26 19:13:58.005",
            "11/14/2026 07:13:58.005 PM",
            "11/14/2026, 7:13:58.005 PM",
            "11/14/2026 19:13:58.005",
            "14/11/2026 19:13:58.005",
            "2026/11/14 19:13:58:005",
            "14-Nov-2026 19:13:58.005",
            "Nov 14 2026 19:13:58.005",
            "14-Nov-26 19:13:58.005",
            "14-NOV-26 07:13:58.005 PM",
            "14-nov-2026 7:13:58.005 PM",
            "14 Nov 2026 19:13:58.005",
            "14 November 2026 7:13:58.005 PM",
            "November 14, 2026 19:13:58.005",
            "Nov 14, 2026 07:13:58.005 PM",
            "Sat Nov 14 19:13:58.005 2026",
            "Sat, 14 Nov 2026 19:13:58.005",
            "Saturday, November 14, 2026 7:13:58.005 PM",
        ] {
            assert_eq!(read(cell, None).map(|(stamp, _)| stamp), Some(wanted), "{cell}");
        }
        for cell in ["4 May 2023 10:12:01", "May 4, 2023 10:12:01 AM", "Thu May  4 10:12:01 2023"] {
            let wanted = Stamp::Instant(1_683_195_121_000_000_000);
            assert_eq!(read(cell, None).map(|(stamp, _)| stamp), Some(wanted), "{cell}");
        }
        for cell in ["19:13:58.005", "19:13:58;005", "19:13:58,005", "19:13:58:005", "07:13:58.005 PM"] {
            let wanted = Stamp::Clock(69_238_005_000_000);
            assert_eq!(read(cell, None).map(|(stamp, _)| stamp), Some(wanted), "{cell}");
        }
        for cell in ["2 days 01:00:00.005000", "2 days, 1:00:00.005", "2 days 01:00:00.005000000"] {
            let wanted = Stamp::Instant(176_400_005_000_000);
            assert_eq!(read(cell, None).map(|(stamp, _)| stamp), Some(wanted), "{cell}");
        }
        let before = read("-1 days +23:59:59.995000", None).map(|(stamp, _)| stamp);
        assert_eq!(before, Some(Stamp::Instant(-5_000_000)));
        assert_eq!(read("ratio 3:4", None), None);
    }
}
