//! What lines hold beside their values: when they came, and what each value is called.

use super::cell::{self, Cell, Decimal};
use super::lines::Delimiter;

/// What a row holds beside its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Form {
    /// The time at which the line came, as terminals write it.
    arrival: Option<Arrival>,
    /// The sign between each value and its name before it: `angle:1.5`, `angle=1.5`.
    sign: Option<char>,
}

/// How a terminal marks when a line came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Arrival {
    /// `14:23:45.123 -> 1,2`.
    Arrow,
    /// `[14:23:45.123] 1,2`.
    Brackets,
}

/// What the column of these times is called.
const ARRIVAL: &str = "time";

/// Letters of the longest name of a value.
const LONGEST: usize = 80;

impl Form {
    /// The forms that lines may have, nothing but values first.
    pub(super) fn in_lines(lines: &[&str]) -> Vec<Self> {
        let are_most =
            |is: &dyn Fn(&str) -> bool| 2 * lines.iter().filter(|line| is(line)).count() > lines.len();
        let signs = [':', '='].into_iter().filter(|sign| are_most(&|line| has_name(line, *sign)));
        let signs: Vec<Option<char>> = std::iter::once(None).chain(signs.map(Some)).collect();
        let arrivals = [Arrival::Arrow, Arrival::Brackets].into_iter();
        let arrivals = arrivals.filter(|arrival| are_most(&|line| arrival.split(line).is_some()));
        let arrivals = std::iter::once(None).chain(arrivals.map(Some));
        arrivals.flat_map(|arrival| signs.iter().map(move |sign| Self { arrival, sign: *sign })).collect()
    }

    /// Whether a row holds nothing but values.
    #[inline]
    pub(super) fn is_plain(self) -> bool {
        self.arrival.is_none() && self.sign.is_none()
    }

    /// Whether each value stands behind its name.
    pub(super) fn is_named(self) -> bool {
        self.sign.is_some()
    }

    /// In words, where it is no plain table.
    pub(super) fn described(self) -> Option<&'static str> {
        match (self.arrival, self.sign) {
            (None, None) => None,
            (Some(_), None) => Some("the time of arrival before each row"),
            (None, Some(_)) => Some("a name before each value"),
            (Some(_), Some(_)) => Some("the time of arrival before each row and a name before each value"),
        }
    }

    /// The values of a line; `cells` is emptied first.
    pub(super) fn split<'t>(self, line: &'t str, delimiter: Delimiter, cells: &mut Vec<&'t str>) {
        if self.is_plain() {
            delimiter.split(line, cells);
            return;
        }
        cells.clear();
        // A value without its name is text.
        let value =
            |(name, value): (&str, &'t str)| if self.is_named() && name.is_empty() { "?" } else { value };
        cells.extend(self.pairs(line, delimiter).into_iter().map(value));
    }

    /// The names in a header, which terminals give a time too.
    pub(super) fn header(self, line: &str, delimiter: Delimiter) -> Vec<&str> {
        let split = self.arrival.and_then(|arrival| arrival.split(line));
        let mut cells = Vec::new();
        delimiter.split(split.map_or(line, |(_, rest)| rest), &mut cells);
        if self.arrival.is_some() {
            cells.insert(0, ARRIVAL);
        }
        cells
    }

    /// The values of a line with their names.
    pub(super) fn pairs(self, line: &str, delimiter: Delimiter) -> Vec<(&str, &str)> {
        let mut pairs = Vec::new();
        let mut rest = line.trim();
        if let Some(arrival) = self.arrival {
            match arrival.split(rest) {
                Some((time, values)) => {
                    pairs.push((ARRIVAL, time));
                    rest = values;
                }
                None => return vec![("", rest)],
            }
        }
        let mut cells = Vec::new();
        match (self.sign, delimiter) {
            (None, _) => {
                delimiter.split(rest, &mut cells);
                pairs.extend(cells.into_iter().map(|cell| ("", cell)));
            }
            (Some(sign), Delimiter::Blanks) => among_blanks(rest, sign, &mut pairs),
            (Some(sign), _) => {
                // One object of JSON a line.
                let object = rest.strip_prefix('{').map(|rest| rest.trim_end_matches([',', ' ']));
                rest = object.and_then(|rest| rest.strip_suffix('}')).unwrap_or(rest);
                delimiter.split(rest, &mut cells);
                while cells.last() == Some(&"") {
                    cells.pop();
                }
                pairs.extend(cells.into_iter().map(|cell| named(cell, sign).unwrap_or(("", cell))));
            }
        }
        pairs
    }
}

impl Arrival {
    /// The time and what follows.
    fn split(self, line: &str) -> Option<(&str, &str)> {
        let (time, rest) = match self {
            Self::Arrow => line.split_once("->")?,
            Self::Brackets => line.trim_start().strip_prefix('[')?.split_once(']')?,
        };
        let time = time.trim();
        // A whole number in brackets counts something.
        let is_time = match cell::read(time, Decimal::Point) {
            Cell::Text | Cell::Missing => false,
            Cell::Number(_) => time.contains('.'),
            _ => true,
        } && !rest.trim().is_empty();
        is_time.then(|| (time, rest.trim()))
    }
}

/// A value and its name: a word that begins with a letter.
fn named(cell: &str, sign: char) -> Option<(&str, &str)> {
    let (name, value) = cell.split_once(sign)?;
    let name = name.trim().trim_matches(['"', '\'']);
    let is_name = name.starts_with(|first: char| first.is_alphabetic() || first == '_')
        && name.len() <= LONGEST
        && !name.contains([',', ';', '|', '\t']);
    is_name.then(|| (name, value.trim()))
}

/// Whether a line has a name somewhere.
fn has_name(line: &str, sign: char) -> bool {
    let before = line.match_indices(sign).map(|(at, _)| line[..at].trim_end());
    before
        .into_iter()
        .any(|name| name.ends_with(|last: char| last.is_alphanumeric() || "_])\"'".contains(last)))
        && line.contains(char::is_alphabetic)
}

/// Names and values that nothing but blanks sets apart: a name may hold some, a value does not.
fn among_blanks<'t>(line: &'t str, sign: char, pairs: &mut Vec<(&'t str, &'t str)>) {
    let mut rest = line;
    while let Some(at) = rest.find(sign) {
        let value = rest[at + sign.len_utf8()..].trim_start();
        let (value, after) = value.split_once([' ', '\t']).unwrap_or((value, ""));
        let pair = &rest[..at];
        match named(&rest[..=at], sign) {
            Some((name, _)) => pairs.push((name, value)),
            None => pairs.push(("", pair)),
        }
        rest = after.trim_start();
    }
    if !rest.is_empty() {
        pairs.push(("", rest));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(line: &str, sign: char, delimiter: Delimiter) -> Vec<(&str, &str)> {
        let forms = Form::in_lines(&[line]);
        let form = forms.into_iter().rfind(|form| form.sign == Some(sign)).expect("a form");
        form.pairs(line, delimiter)
    }

    #[test]
    fn names_are_taken_from_before_their_values() {
        let wanted = [("a", "1.5"), ("b 2", "-3")];
        assert_eq!(pairs("a:1.5,b 2:-3", ':', Delimiter::Sign(',')), wanted);
        assert_eq!(pairs("a = 1.5; b 2 = -3;", '=', Delimiter::Sign(';')), wanted);
        assert_eq!(pairs("a: 1.5  b 2: -3", ':', Delimiter::Blanks), wanted);
        assert_eq!(pairs("{\"a\": 1.5, \"b 2\": -3}", ':', Delimiter::Sign(',')), wanted);
        let with_time = [("time", "14:23:45.123"), ("a", "1.5"), ("b 2", "-3")];
        assert_eq!(pairs("14:23:45.123 -> a:1.5\tb 2:-3", ':', Delimiter::Sign('\t')), with_time);
        assert_eq!(pairs("[14:23:45.123] a:1.5\tb 2:-3", ':', Delimiter::Sign('\t')), with_time);
    }

    #[test]
    fn clocks_and_paths_are_no_names() {
        for line in ["2024-05-01T10:00:00,1,2", "10:00:00.5;1;2", "1,2,3"] {
            assert_eq!(
                Form::in_lines(&[line]).iter().filter(|form| form.arrival.is_some()).count(),
                0,
                "{line}"
            );
            let named = Form { arrival: None, sign: Some(':') };
            assert!(
                named.pairs(line, Delimiter::Sign(',')).iter().all(|(name, _)| name.is_empty()),
                "{line}"
            );
        }
    }
}
