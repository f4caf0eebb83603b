//! Lines between a header and its rows that say nothing of the columns.

use super::dialect::Dialect;
use super::lines::Delimiter;

/// Words for types of data, in lower case and without their sizes.
const TYPES: [&str; 16] = [
    "f", "i", "u", "float", "double", "single", "int", "uint", "integer", "real", "lreal", "bool", "boolean",
    "string", "text", "datetime",
];

/// Whether a line says nothing of the columns: a mark, a title, or a [row](is_row) that is the same throughout.
pub(super) fn is(line: &str, dialect: &Dialect) -> bool {
    is_mark(line, dialect) || is_row(line, dialect)
}

/// Whether a line is a mark or a title: `[data]`, `***End_of_Header***`, `----`, `trace_values;;;`, `Measured values`.
pub(super) fn is_mark(line: &str, dialect: &Dialect) -> bool {
    let text = line.trim().trim_start_matches(['#', '%', ';', ' ']);
    let is_framed = text.starts_with('[') && text.ends_with(']') && !text[1..].contains('[');
    let is_drawn = text.starts_with("**") || text.starts_with("--") || text.starts_with("==");
    let mut cells = Vec::new();
    dialect.delimiter.split(text, &mut cells);
    // `,force` names the second of two columns.
    let is_single = match &cells[..] {
        [_] => dialect.width > 1 && !is_split_otherwise(text, dialect.width),
        [_, others @ ..] => dialect.width > 2 && others.iter().all(|cell| cell.is_empty()),
        [] => true,
    };
    // Blanks separate the words of any sentence.
    (is_framed && dialect.delimiter == Delimiter::Blanks) || is_drawn || is_single
}

/// Whether a line has as many cells as there are columns by another delimiter than the rows'.
fn is_split_otherwise(text: &str, width: usize) -> bool {
    let by_sign = [',', ';', '\t', '|'].into_iter().any(|sign| text.split(sign).count() == width);
    by_sign || text.split("  ").filter(|cell| !cell.trim().is_empty()).count() >= width
}

/// Words before settings of the channels, one a column; lower case.
const SETTINGS: [&str; 24] = [
    "min",
    "max",
    "minimum",
    "maximum",
    "mean",
    "average",
    "range",
    "bereich",
    "offset",
    "scale",
    "scaling",
    "gain",
    "factor",
    "faktor",
    "scale factor",
    "scalefactor",
    "sensitivity",
    "zero",
    "lower",
    "upper",
    "full scale",
    "filter",
    "sensor",
    "serial",
];

/// Whether cells are settings of the channels behind a word for them: `Range,500,10`, or before each of them `Port,501,Port,502`.
pub(super) fn is_setting(cells: &[&str]) -> bool {
    let is_number = |cell: &&str| cell.is_empty() || cell.replace(',', ".").parse::<f64>().is_ok();
    let [key, values @ ..] = cells else { return false };
    let is_pair = |pair: &[&str]| pair[0] == *key && is_number(&pair[1]);
    let is_word = key.starts_with(char::is_alphabetic) && !is_number(key);
    if is_word && cells.len() > 2 && cells.len().is_multiple_of(2) && cells.chunks_exact(2).all(is_pair) {
        return true;
    }
    !values.is_empty() && values.iter().all(is_number) && SETTINGS.contains(&key.to_lowercase().as_str())
}

/// Whether cells are a word and numbers behind it, as `Gain,2,3`: a setting, unless they are names.
pub(super) fn is_keyed(cells: &[&str]) -> bool {
    let is_number = |cell: &&str| cell.replace(',', ".").parse::<f64>().is_ok();
    let [key, values @ ..] = cells else { return false };
    key.starts_with(char::is_alphabetic)
        && !is_number(key)
        && values.len() > 1
        && values.iter().all(is_number)
}

/// Whether all cells of a line are the same (`Rohdaten;Rohdaten;Rohdaten`), types of data, or a drawn line.
pub(super) fn is_row(line: &str, dialect: &Dialect) -> bool {
    let mut cells = Vec::new();
    dialect.delimiter.split(line, &mut cells);
    cells.retain(|cell| !cell.is_empty());
    let is_word = |cell: &&str| cell.starts_with(char::is_alphabetic);
    let are_alike = || cells.iter().all(|cell| *cell == cells[0]);
    let is_drawn = |cell: &&str| cell.len() > 1 && cell.bytes().all(|byte| b"-=:+_*".contains(&byte));
    if cells.len() > 1 && cells.iter().all(is_drawn) || is_setting_of_all(&cells) {
        return true;
    }
    // Of two columns of one name nobody knows better.
    cells.len() > 1 && cells.iter().all(is_word) && (are_alike() || cells.iter().all(|cell| is_type(cell)))
}

/// Whether a line has one key before one value, which is no name, throughout: `BitMask;0xff;BitMask;0xff`.
fn is_setting_of_all(cells: &[&str]) -> bool {
    let [key, value, others @ ..] = cells else { return false };
    let is_key = key.starts_with(char::is_alphabetic) && !value.starts_with(char::is_alphabetic);
    let is_same = |pair: &[&str]| pair == [*key, *value];
    is_key && !others.is_empty() && others.len().is_multiple_of(2) && others.chunks_exact(2).all(is_same)
}

fn is_type(word: &str) -> bool {
    let word = word.to_lowercase();
    let bare =
        word.trim_start_matches(['<', '|', '>']).trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    TYPES.contains(&bare) && (bare.len() > 1 || bare.len() < word.len())
}
