//! Lines above a table that say what its columns are by a key: the same one before every name, or one a line.

use super::dialect::Dialect;
use super::lines::{Delimiter, is_comment};
use super::{silent, unit};
use std::collections::HashSet;

/// A name and its unit.
pub(super) type Named = (String, Option<String>);

/// Names and units behind a key that is repeated: `name: Time  name: Force`, or `Name;Force;Name;Travel` above pairs of times and values.
/// `step` is from the first row to the next.
pub(super) fn described<'t>(
    lines: &[(u64, &'t str)],
    dialect: &Dialect,
    step: Option<f64>,
) -> Option<Vec<Named>> {
    // Below such lines stands no other that could be a header.
    let said = lines.iter().rev().map(|(_, line)| *line).filter(|line| !silent::is_mark(line, dialect));
    let rows = said.map(|line| (is_comment(line), repeated(line, dialect)));
    let rows = rows.take_while(|(is_comment, row)| *is_comment || row.is_some());
    let rows: Vec<Vec<(&'t str, &'t str)>> = rows.filter_map(|(_, row)| row).collect();
    let values = |row: &[(&'t str, &'t str)]| row.iter().map(|(_, value)| *value).collect::<Vec<_>>();
    let all = |is: &dyn Fn(&str) -> bool| {
        let found = rows.iter().filter(|row| is(&row[0].0.to_lowercase()));
        found.map(|row| values(row)).collect::<Vec<_>>()
    };
    let behind = |is: &dyn Fn(&str) -> bool| all(is).into_iter().next();
    // Values that are all alike distinguish nothing.
    let named = |is: &dyn Fn(&str) -> bool| {
        let differ = |names: &Vec<&str>| names.iter().any(|name| *name != names[0]);
        all(is).into_iter().find(differ)
    };
    let is_name = |key: &str| key.contains("name");
    let names = named(&|key| ["name", "signal", "symbol", "channel"].contains(&key));
    let names = names.or_else(|| named(&is_name)).or_else(|| behind(&is_name))?;
    let units = behind(&|key| key.contains("unit") || key.contains("einheit"));
    let named = names.iter().enumerate().map(|(k, name)| {
        let (name, own) = unit::split(name);
        (name, units.as_ref().and_then(|units| unit::meant(units.get(k)?)).or(own))
    });
    let named: Vec<Named> = named.collect();
    if named.len() == dialect.width {
        return Some(named);
    }
    // A single pair is a line of any preamble.
    if named.len() < 2 && units.is_none() {
        return None;
    }
    // `Time[ms]`, or `SampleTime[ms];2` where the first rows are 2 apart.
    let unit = rows.iter().find_map(|row| {
        let unit = unit::split(row[0].0).1.filter(|unit| unit::seconds(unit).is_some())?;
        let said: Option<f64> = row[0].1.replace(',', ".").parse().ok();
        let fits = |said: f64| step.is_some_and(|step| (step - said).abs() <= 0.01 * said.abs());
        (row[0].1.is_empty() || said.is_some_and(fits)).then_some(unit)
    });
    let time = |name: &str| (format!("time of {name}"), unit.clone());
    let mut pairs: Vec<Named> =
        named.into_iter().flat_map(|(name, own)| [time(&name), (name, own)]).collect();
    if pairs.len() + 1 == dialect.width {
        // Behind the delimiter at the end of every row.
        pairs.push((String::new(), None));
    }
    Some(pairs)
}

/// The keys and values of a line in which one key stands before every value: as many as there are columns in a comment, half as many else.
fn repeated<'t>(line: &'t str, dialect: &Dialect) -> Option<Vec<(&'t str, &'t str)>> {
    let are_alike =
        |pairs: &[(&str, &str)]| pairs.iter().all(|(key, _)| *key == pairs[0].0 && !key.is_empty());
    if dialect.delimiter != Delimiter::Blanks && dialect.width > 1 && !is_comment(line) {
        let width = dialect.width - dialect.width % 2;
        let mut cells = Vec::new();
        dialect.delimiter.split(line, &mut cells);
        if cells.len() == width + 1 && cells.last() == Some(&"") {
            cells.pop();
        }
        if cells.len() + 1 == width {
            cells.push("");
        }
        let pairs: Vec<(&str, &str)> = cells.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        let is_word = |key: &str| key.starts_with(char::is_alphabetic);
        if cells.len() == width && are_alike(&pairs) && is_word(pairs[0].0) {
            return Some(pairs);
        }
    }
    let pairs = in_comment(line, dialect.width)?;
    are_alike(&pairs).then_some(pairs)
}

/// The keys and values of a comment that has as many as there are columns.
fn in_comment(line: &str, width: usize) -> Option<Vec<(&str, &str)>> {
    let bare = line.trim_start().trim_start_matches(['#', '%', '/', ' ']);
    let cells: Vec<&str> = bare.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let pairs: Vec<(&str, &str)> = match cells.len() == width {
        true => cells
            .iter()
            .filter_map(|cell| cell.split_once(':'))
            .map(|(key, value)| (key, value.trim()))
            .collect(),
        false => {
            cells.chunks_exact(2).filter_map(|pair| Some((pair[0].strip_suffix(':')?, pair[1]))).collect()
        }
    };
    (pairs.len() == width && width > 1).then_some(pairs)
}

/// Names one a line, each with its number: `NAME0 = Force`, `Channel 1: Force [N]`; as many as there are columns.
pub(super) fn counted(lines: &[(u64, &str)], width: usize) -> Option<Vec<Named>> {
    let entries: Vec<(&str, usize, &str)> = lines.iter().filter_map(|(_, line)| entry(line)).collect();
    let of_key = |key: &str| -> Option<Vec<Named>> {
        let own: Vec<_> = entries.iter().filter(|(other, ..)| *other == key).collect();
        let first = own.first()?.1;
        let is_counted = own.iter().enumerate().all(|(k, (_, number, _))| *number == first + k);
        let is_whole = own.len() == width && width > 1 && first <= 1 && is_counted;
        let named = || own.iter().map(|(.., name)| unit::split(name)).collect();
        is_whole.then(named)
    };
    let is_name = |key: &&str| {
        ["name", "channel", "column", "signal"].iter().any(|word| key.to_lowercase().contains(word))
    };
    let keys = || entries.iter().map(|(key, ..)| *key);
    keys().filter(is_name).chain(keys()).find_map(of_key)
}

/// Whether a line is one of such names.
pub(super) fn is_counted(line: &str) -> bool {
    entry(line).is_some()
}

/// What the row of names is called where every row has its key in the first cell; lower case.
const NAME_KEYS: [&str; 14] = [
    "name",
    "names",
    "tracename",
    "trace name",
    "channel",
    "channels",
    "channel name",
    "channelname",
    "signal",
    "signal name",
    "label",
    "kanal",
    "kanalname",
    "bezeichnung",
];

/// Names in the row with their key in its first cell, where a row of units has a key too; with its line.
pub(super) fn named(lines: &[(u64, &str)], dialect: &Dialect) -> Option<(u64, Vec<Named>)> {
    let rows = lines.iter().rev().filter_map(|(line, text)| {
        let mut cells = Vec::new();
        dialect.delimiter.split(text, &mut cells);
        while cells.len() > dialect.width && cells.last() == Some(&"") {
            cells.pop();
        }
        (cells.len() == dialect.width && cells.len() > 1).then_some((*line, cells))
    });
    let rows: Vec<_> = rows.collect();
    let (_, nearest) = rows.first()?;
    let is_word = |cell: &&str| cell.starts_with(char::is_alphabetic);
    let is_keyed = is_unit_key(nearest[0]) || is_name_key(nearest[0]);
    let are_distinct = nearest.iter().collect::<HashSet<_>>().len() == nearest.len();
    if !is_keyed && are_distinct && nearest.iter().all(is_word) {
        return None;
    }
    let has_units = rows
        .iter()
        .any(|(_, cells)| is_unit_key(cells[0]) && cells[1..].iter().any(|cell| unit::is_known(cell)));
    let (line, cells) = rows.iter().find(|(_, cells)| is_name_key(cells[0]))?;
    let are_names = cells[1..].iter().all(|cell| !cell.is_empty() && cell.parse::<f64>().is_err());
    (has_units && are_names).then(|| (*line, cells.iter().map(|cell| unit::split(cell)).collect()))
}

fn is_name_key(cell: &str) -> bool {
    NAME_KEYS.contains(&cell.to_lowercase().as_str())
}

/// Whether the cells are units behind a key.
pub(super) fn are_units(cells: &[&str]) -> bool {
    let [key, units @ ..] = cells else { return false };
    let is_unit = |cell: &&str| cell.is_empty() || *cell == "-" || unit::bare(cell).is_some();
    is_unit_key(key) && units.iter().all(is_unit) && units.iter().any(|cell| unit::bare(cell).is_some())
}

pub(super) fn is_unit_key(cell: &str) -> bool {
    let words = ["unit", "einheit", "unité", "unita", "unidad"];
    let key = cell.to_lowercase();
    words.iter().any(|word| key.contains(word)) && !unit::is_known(cell)
}

/// Key, number and text of a line such as `# NAME0 = Force`.
fn entry(line: &str) -> Option<(&str, usize, &str)> {
    keyed_value(line).filter(|(.., value)| value.starts_with(char::is_alphabetic))
}

/// Key, number and value of a line such as `# RANGE0 = 5`.
pub(super) fn keyed_value(line: &str) -> Option<(&str, usize, &str)> {
    let bare = line.trim().trim_start_matches(['#', '%', '/', ';', ' ']);
    let (key, value) = bare.split_at(bare.find([':', '=', ';', '\t', ','])?);
    let value = value[1..].trim().trim_matches('"').trim();
    let digits = key.trim_end();
    let word = digits.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = digits[word.len()..].parse().ok()?;
    Some((word.trim_end(), number, value))
}

/// Units that stand in lines of their own, behind a key in the first cell (`Vertical Units,V,A`) or the name of a column (`Force kN`), given to the
/// columns that have none yet.
pub(super) fn add_units(names: &mut [Named], lines: &[(u64, &str)], dialect: &Dialect) {
    for (_, line) in lines.iter().rev() {
        let mut cells = Vec::new();
        dialect.delimiter.split(line, &mut cells);
        while cells.len() > names.len() && cells.last() == Some(&"") {
            cells.pop();
        }
        if dialect.delimiter != Delimiter::Blanks && cells.len() <= names.len() && cells.len() >= 2 {
            add_keyed(names, &cells);
        }
        if let Some((k, unit)) = named_alone(names, line) {
            names[k].1.get_or_insert(unit);
        }
    }
}

/// From a line whose first cell is a word for units, above the column of times.
fn add_keyed(names: &mut [Named], cells: &[&str]) {
    let key = cells[0].to_lowercase();
    if !is_unit_key(cells[0]) {
        return;
    }
    let units: Vec<Option<String>> = cells.iter().skip(1).map(|cell| unit::bare(cell)).collect();
    let known = units.iter().flatten().count();
    // `x_unit`, `HUnit`.
    let is_of_time = key.starts_with(['x', 'h']) || key.contains("horizontal") || key.contains("time");
    if is_of_time {
        if let (Some((_, unit)), Some(Some(first))) = (names.first_mut(), units.first()) {
            unit.get_or_insert(first.clone());
        }
        return;
    }
    let is_whole = units.len() + 1 == names.len() || key.starts_with('y') || key.contains("vertical");
    if known > 0 && is_whole {
        for ((_, unit), found) in names.iter_mut().skip(1).zip(units) {
            *unit = unit.take().or(found);
        }
    }
}

/// A line that holds nothing but the name of a column and a known unit.
fn named_alone(names: &[Named], line: &str) -> Option<(usize, String)> {
    let line = line.trim().trim_start_matches(['#', '%', ' ']);
    names.iter().enumerate().find_map(|(k, (name, _))| {
        let rest = line.strip_prefix(name.as_str()).filter(|_| !name.is_empty())?;
        let rest =
            rest.strip_prefix([' ', '\t', ':', '=', ';', ','])?.trim_start_matches([' ', ':', '=', '\t']);
        let unit = unit::bare(rest.trim())?;
        Some((k, unit))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(text: &str) -> Vec<(u64, &str)> {
        (1..).zip(text.lines()).collect()
    }

    #[test]
    fn names_with_a_number_stand_one_a_line() {
        let lines = numbered("# NDATA = 3\n# NAME0 = Target of axis 1\n# NAME1 = Force [N]\n# END");
        let wanted = vec![("Target of axis 1".to_owned(), None), ("Force".to_owned(), Some("N".to_owned()))];
        assert_eq!(counted(&lines, 2), Some(wanted));
        assert_eq!(counted(&lines, 3), None);
        assert_eq!(counted(&numbered("Range 1: 5\nRange 2: 10"), 2), None, "numbers are no names");
    }

    #[test]
    fn a_line_of_a_name_and_a_unit_gives_the_unit() {
        let names = [("Force".to_owned(), None), ("t".to_owned(), None)];
        assert_eq!(named_alone(&names, "Force kN"), Some((0, "kN".to_owned())));
        assert_eq!(named_alone(&names, "# Force: [kN]"), Some((0, "kN".to_owned())));
        for line in ["Force", "Force sensor", "Forces N", "test"] {
            assert_eq!(named_alone(&names, line), None, "{line}");
        }
    }
}
