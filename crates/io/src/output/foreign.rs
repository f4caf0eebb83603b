//! Names that users chose, in the formats that the program writes: nothing in them is taken for the format's own signs.

/// A name in Markdown, tables and headings included, whose signs open no HTML, cell or code.
pub fn markdown(name: &str) -> String {
    let one_line = name.replace(['\n', '\r'], " ");
    one_line.replace('&', "&amp;").replace('<', "&lt;").replace('|', "\\|").replace('`', "\\`")
}

/// A text in Markdown that may be formatted, but holds no HTML.
pub fn markdown_text(text: &str) -> String {
    text.replace('<', "&lt;")
}

/// Code within a line of Markdown, whatever it holds: CommonMark 0.31, section 6.1.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_no_markup() {
        assert_eq!(markdown("a <b> | `c` & d"), "a &lt;b> \\| \\`c\\` &amp; d");
        assert_eq!(markdown("two\nlines"), "two lines");
        assert_eq!(markdown_text("is `a` < b?"), "is `a` &lt; b?");
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
}
