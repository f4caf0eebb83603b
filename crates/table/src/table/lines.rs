//! The lines of a text, whatever ends them, and their cells.

/// Lines with their number, from 1.
pub(super) fn numbered(text: &str) -> impl Iterator<Item = (u64, &str)> {
    (1..).zip(text.split(end(text)).map(without_return))
}

/// What ends the lines of a text: LF, after which CRLF is left a [return](without_return), or where there is none CR.
pub(super) fn end(text: &str) -> char {
    if text.contains('\n') { '\n' } else { '\r' }
}

/// A line that ended in CRLF.
pub(super) fn without_return(line: &str) -> &str {
    line.strip_suffix('\r').unwrap_or(line)
}

/// Whether a line holds no cells: blank, or a comment.
pub(super) fn is_idle(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || is_comment(line)
}

pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with(['#', '%']) || line.starts_with("//")
}

/// What stands between two cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Delimiter {
    Sign(char),
    Blanks,
}

impl Delimiter {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Sign(';') => "semicolons",
            Self::Sign('\t') => "tabs",
            Self::Sign('|') => "bars",
            Self::Sign(_) => "commas",
            Self::Blanks => "blanks",
        }
    }

    /// Splits a line into its cells, trimmed and without quotation marks; `cells` is emptied first.
    pub(super) fn split<'t>(self, line: &'t str, cells: &mut Vec<&'t str>) {
        cells.clear();
        let mut rest = line.trim_matches(|c: char| c.is_whitespace() && Self::Sign(c) != self);
        loop {
            let (cell, after) = self.first(rest);
            cells.push(cell);
            match after {
                Some(after) => rest = after,
                None => return,
            }
        }
    }

    /// The first cell, and what stands behind the delimiter that ends it.
    fn first(self, line: &str) -> (&str, Option<&str>) {
        // Most cells begin at once.
        let start = match line.as_bytes().first() {
            Some(b'!'..=b'~') => line,
            _ => line.trim_start_matches(|c: char| c.is_whitespace() && Self::Sign(c) != self),
        };
        if let Some(quoted) = start.strip_prefix('"')
            && let Some(split) = self.closed(quoted)
        {
            return split;
        }
        match self {
            Self::Sign(sign) => match start.split_once(sign) {
                Some((cell, after)) => (cell.trim(), Some(after)),
                None => (start.trim(), None),
            },
            Self::Blanks => match start.split_once([' ', '\t']) {
                Some((cell, after)) => (cell, Some(after).filter(|after| !after.trim().is_empty())),
                None => (start, None),
            },
        }
    }

    /// The cell that a quotation mark closes, and what follows; two of them are one within the cell. None where what follows the mark is no delimiter:
    /// it belongs to the cell then, as the one at its beginning does.
    fn closed(self, quoted: &str) -> Option<(&str, Option<&str>)> {
        let mut from = 0;
        loop {
            let first = from + quoted[from..].find('"')?;
            let marks = quoted[first..].bytes().take_while(|byte| *byte == b'"').count();
            let behind = &quoted[first + marks..];
            if marks % 2 == 1 {
                let is_closed = self.ends(behind);
                return is_closed.then(|| (quoted[..first + marks - 1].trim(), self.after(behind)));
            }
            from = first + marks;
        }
    }

    /// Whether a cell ends where this follows.
    fn ends(self, rest: &str) -> bool {
        match self {
            Self::Sign(sign) => {
                let rest = rest.trim_start_matches(' ');
                rest.is_empty() || rest.starts_with(sign)
            }
            Self::Blanks => rest.is_empty() || rest.starts_with([' ', '\t']),
        }
    }

    /// What stands behind the delimiter, if there is one.
    fn after(self, rest: &str) -> Option<&str> {
        match self {
            Self::Sign(sign) => rest.trim_start_matches(' ').strip_prefix(sign),
            Self::Blanks => Some(rest).filter(|rest| !rest.trim().is_empty()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(delimiter: Delimiter, line: &str) -> Vec<&str> {
        let mut cells = Vec::new();
        delimiter.split(line, &mut cells);
        cells
    }

    #[test]
    fn lines_end_in_any_of_three_ways() {
        for text in ["a\nb", "a\r\nb", "a\rb"] {
            assert_eq!(numbered(text).collect::<Vec<_>>(), [(1, "a"), (2, "b")]);
        }
    }

    #[test]
    fn cells_are_split_trimmed_and_unquoted() {
        assert_eq!(cells(Delimiter::Sign(','), " 1, 2 ,3"), ["1", "2", "3"]);
        assert_eq!(cells(Delimiter::Sign(','), "\"1,5\",\"a b\" ,"), ["1,5", "a b", ""]);
        assert_eq!(cells(Delimiter::Sign('\t'), "1\t\t3"), ["1", "", "3"]);
        assert_eq!(cells(Delimiter::Sign('\t'), "\t2\t3"), ["", "2", "3"]);
        assert_eq!(cells(Delimiter::Blanks, "  1  2 \t3 "), ["1", "2", "3"]);
        assert_eq!(cells(Delimiter::Blanks, "\"load cell\" 2"), ["load cell", "2"]);
        assert_eq!(cells(Delimiter::Sign(','), "\"\",\"a\""), ["", "a"]);
    }

    #[test]
    fn a_quotation_mark_before_no_delimiter_belongs_to_the_cell() {
        let semicolons = Delimiter::Sign(';');
        assert_eq!(cells(semicolons, "t;\"A1\".pos;\"A1\""), ["t", "\"A1\".pos", "A1"]);
        assert_eq!(cells(semicolons, "\"A1\".pos;\"A2\".pos;3"), ["\"A1\".pos", "\"A2\".pos", "3"]);
        assert_eq!(cells(semicolons, "\"\"\"A1\"\".pos; rest\";2"), ["\"\"A1\"\".pos; rest", "2"]);
        assert_eq!(cells(Delimiter::Blanks, "\"A\"1 2"), ["\"A\"1", "2"]);
        assert_eq!(cells(semicolons, "\"never closed;2"), ["\"never closed", "2"]);
    }
}
