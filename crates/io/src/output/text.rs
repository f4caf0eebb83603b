//! Text in the formats that the program writes: tables, Markdown, CSV, JSON, and characters that a terminal or an SVG can show.

use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write;
use switchback_table::shell::is_obeyed;

/// Columns padded to their widest cell: the first to the left, the others to the right, no blanks at the end of a line.
pub fn columns<const N: usize>(rows: &[[String; N]]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = format!("{:<width$}", row[0], width = widths[0]);
        for column in 1..N {
            let _ = write!(line, "  {:>width$}", row[column], width = widths[column]);
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// A name in Markdown, tables and headings included, whose signs open no HTML, link, cell or code.
pub fn markdown(name: &str) -> String {
    let one_line = name.replace(['\n', '\r'], " ").replace('&', "&amp;");
    markdown_text(&one_line).replace('|', "\\|").replace('`', "\\`")
}

/// A text in Markdown that may be formatted, but contains no HTML and no link: brackets open neither links nor images, nor do they define any.
pub fn markdown_text(text: &str) -> String {
    text.replace('<', "&lt;").replace('[', "&#91;")
}

/// Code within a line of Markdown, with any characters: CommonMark 0.31, section 6.1.
pub fn markdown_code(code: &str) -> String {
    let longest = code.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    if longest == 0 { format!("`{code}`") } else { format!("{fence} {code} {fence}") }
}

/// A cell of a CSV file. Spreadsheets run text that begins with `=`, `+`, `-` or `@` as a formula: an apostrophe before it, their own sign
/// for text, stops that. Numbers stay as they are. OWASP, "CSV Injection".
pub fn csv_cell(cell: &str) -> String {
    let is_formula = cell.starts_with(['=', '+', '-', '@', '\t', '\r']) && cell.len() > 1;
    if is_formula && cell.parse::<f64>().is_err() { format!("'{cell}") } else { cell.to_owned() }
}

/// Letters of a number that are written without an exponent.
const LONG_NUMBER: usize = 60;

/// A number as text that is read back as the same: with an exponent where it would be long without.
///
/// ```
/// # use switchback_io::output::number;
/// assert_eq!((number(0.1).as_str(), number(-2.5e300).as_str()), ("0.1", "-2.5e300"));
/// ```
pub fn number(x: f64) -> String {
    match x.to_string() {
        long if long.len() > LONG_NUMBER => format!("{x:e}"),
        text => text,
    }
}

/// An object behind the name and version of its layout.
#[derive(Serialize)]
struct Stamped<'a, T> {
    schema: &'a str,
    #[serde(flatten)]
    body: &'a T,
}

/// An object as JSON, indented, with a newline at its end; its first key is `schema`.
///
/// ```
/// # use switchback_io::output::stamped;
/// let text = stamped("switchback/rig/1", &serde_json::json!({"order": 2}));
/// assert_eq!(text, "{\n  \"schema\": \"switchback/rig/1\",\n  \"order\": 2\n}\n");
/// ```
///
/// # Panics
/// Where `body` is no object.
pub fn stamped(schema: &str, body: &impl Serialize) -> String {
    serde_json::to_string_pretty(&Stamped { schema, body }).expect("an object of numbers and strings is JSON")
        + "\n"
}

/// A text whose control characters are shown instead of obeyed: `␛` for ESC, `␀` for NUL, `�` for those without a picture. Names in files
/// may contain any of them: they would steer a terminal, and an SVG with one is no XML. Ends of lines and tabs stay.
///
/// ```text
/// U+0000 … U+001F → U+2400 … U+241F   U+007F → U+2421   U+0080 … U+009F, U+202A … U+202E, U+2066 … U+2069, U+FFFE, U+FFFF → U+FFFD
/// ```
///
/// The pictures are the block "Control Pictures" of Unicode; XML 1.0 lists the characters that it allows in production 2; the others turn
/// the direction of the text after them.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let is_line_end = |k: usize| text[k..].starts_with("\r\n");
    let shown =
        text.char_indices().map(|(k, c)| if !is_obeyed(c) || is_line_end(k) { c } else { picture(c) });
    Cow::Owned(shown.collect())
}

fn picture(c: char) -> char {
    match u32::from(c) {
        code @ 0..0x20 => char::from_u32(0x2400 + code).unwrap_or(char::REPLACEMENT_CHARACTER),
        0x7f => '\u{2421}',
        _ => char::REPLACEMENT_CHARACTER,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_no_markup() {
        assert_eq!(markdown("a <b> | `c` & d"), "a &lt;b> \\| \\`c\\` &amp; d");
        assert_eq!(markdown("two\nlines"), "two lines");
        assert_eq!(markdown_text("is `a` < b?"), "is `a` &lt; b?");
        for link in [
            "[x](javascript:alert(1))",
            "![x](http://somewhere)",
            "[x]: javascript:a",
            "<javascript:a>",
            "\\[x](a)",
        ] {
            for shown in [markdown(link), markdown_text(link)] {
                assert!(!shown.contains(['[', '<']), "{shown}");
            }
        }
        assert_eq!(markdown_code("switchback a.toml"), "`switchback a.toml`");
        assert_eq!(markdown_code("a`b"), "`` a`b ``");
    }

    #[test]
    fn text_is_no_formula_and_numbers_are_numbers() {
        for formula in ["=1+1", "+cmd", "-2+3", "@sum(a1)"] {
            assert_eq!(csv_cell(formula), format!("'{formula}"));
        }
        for plain in ["-1.5e-3", "+2", "-", "", "a=b", "descendant"] {
            assert_eq!(csv_cell(plain), plain);
        }
    }

    #[test]
    fn controls_are_shown_and_all_else_stays() {
        assert_eq!(visible("a\u{1b}[31mb\0\u{7f}\u{9b}\rc"), "a␛[31mb␀␡\u{fffd}␍c");
        assert_eq!(visible("tab\tline\r\nµ 力 \u{202e}"), "tab\tline\r\nµ 力 \u{fffd}");
        assert!(matches!(visible("plain\n"), Cow::Borrowed(_)));
    }
}
