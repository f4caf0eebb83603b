//! A failure as text.

use super::text::visible;
pub use miette::Diagnostic;
use miette::{SourceCode, SourceSpan};
use std::fmt::Write;

/// A failure without colours or widths: the message, the offending line with the place marked, the remedy.
///
/// ```text
/// error: rig.toml:3:1: unknown key `oder`, expected one of …
///   3 | oder = 2
///     | ^^^^
/// help: did you mean `order`?
/// ```
///
/// Where several things are wrong, each follows in this form, numbered.
pub fn plain(diagnostic: &dyn Diagnostic) -> String {
    let mut reported = format!("error: {}", reported(diagnostic));
    for (k, related) in diagnostic.related().into_iter().flatten().enumerate() {
        let _ = write!(reported, "{}. {}", k + 1, self::reported(related));
    }
    visible(&reported).into_owned()
}

/// Letters of a message that are reported: room for the names of many columns.
const LONG_MESSAGE: usize = 3000;

/// Letters of a line of a file that are shown.
const LONG_LINE: usize = 160;

/// … of which so many on either side of the place.
const AROUND: usize = 60;

/// Letters of a word that are reported in full; a path may be long.
const LONG_WORD: usize = 500;

/// A message as it is printed: its long words without their middle, and then all of it.
fn reported_of(message: &str) -> String {
    let words = message.split_inclusive(' ');
    let word = |word: &str| {
        if word.chars().count() > LONG_WORD { shortened(word, 2 * AROUND) } else { word.to_owned() }
    };
    shortened(&words.map(word).collect::<String>(), LONG_MESSAGE)
}

/// A text without its middle where it is longer than `most` letters.
fn shortened(text: &str, most: usize) -> String {
    let letters = text.chars().count();
    if letters <= most {
        return text.to_owned();
    }
    let (start, end) = (text.chars().take(most / 2), text.chars().skip(letters - most / 2));
    start.chain(['…']).chain(end).collect()
}

/// One message with its place and remedy.
fn reported(diagnostic: &dyn Diagnostic) -> String {
    let mut reported = reported_of(&diagnostic.to_string()) + "\n";
    if let (Some(code), Some(label)) =
        (diagnostic.source_code(), diagnostic.labels().and_then(|mut l| l.next()))
    {
        reported.push_str(&marked_line(code, label.inner()).unwrap_or_default());
    }
    if let Some(help) = diagnostic.help() {
        let _ = writeln!(reported, "help: {}", reported_of(&help.to_string()));
    }
    reported
}

/// The line that a span begins on, with its number before it and marks under the span.
fn marked_line(code: &dyn SourceCode, span: &SourceSpan) -> Option<String> {
    // A line of context on each side makes sure that the span's own line is there in full.
    let contents = code.read_span(span, 1, 1).ok()?;
    let text = std::str::from_utf8(contents.data()).ok()?;
    let start = span.offset().checked_sub(contents.span().offset())?;
    let before = text.get(..start)?;
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[line_start..].lines().next().unwrap_or_default();
    let number = (contents.line() + 1 + before.matches('\n').count()).to_string();
    let marked = text[start..].chars().take_while(|c| *c != '\n').count().min(span.len()).max(1);
    let (line, before, marked) = cut(line, before[line_start..].chars().count(), marked);
    let blanks: String = line.chars().take(before).map(|c| if c == '\t' { c } else { ' ' }).collect();
    Some(format!(
        "  {number} | {line}\n  {:width$} | {blanks}{}\n",
        "",
        "^".repeat(marked),
        width = number.len()
    ))
}

/// What is shown of a line, the letters before the place and those marked: all of them, or of a long line those around the place.
fn cut(line: &str, before: usize, marked: usize) -> (String, usize, usize) {
    let letters = line.chars().count();
    if letters <= LONG_LINE {
        return (line.to_owned(), before, marked);
    }
    let marked = marked.min(AROUND);
    let (first, end) = (before.saturating_sub(AROUND), (before + marked + AROUND).min(letters));
    let part = line.chars().skip(first).take(end - first);
    let (left, right) = ((first > 0).then_some('…'), (end < letters).then_some('…'));
    let before = before - first + usize::from(first > 0);
    (left.into_iter().chain(part).chain(right).collect(), before, marked)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{TomlError, TomlFile};
    use std::path::Path;

    fn refused(text: &str) -> TomlError {
        let file = TomlFile::from_text(Path::new("a.toml"), text);
        file.error(text.find('!').expect("a mark")..text.len(), "this cannot be", "write another")
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let line = format!("a = \"{}!{}\"", "x".repeat(70_000), "y".repeat(300));
        let reported = plain(&refused(&line));
        let [_, shown, marks, _] = reported.lines().collect::<Vec<_>>()[..] else { panic!("{reported}") };
        assert_eq!(shown, format!("  1 | …{}!{}…", "x".repeat(60), "y".repeat(119)));
        assert_eq!(marks, format!("    | {}{}", " ".repeat(61), "^".repeat(60)));
    }

    #[test]
    fn control_characters_are_shown_instead_of_obeyed() {
        let reported = plain(&refused("a = \"\u{1b}[2J!\""));
        assert!(reported.contains("␛[2J!") && !reported.contains('\u{1b}'), "{reported}");
    }

    #[test]
    fn a_long_message_keeps_its_ends() {
        assert_eq!(shortened("abcdef", 6), "abcdef");
        assert_eq!(shortened("abcdefgh", 6), "abc…fgh");
        let word = format!("`{}` is no number", "x".repeat(700));
        assert_eq!(reported_of(&word), format!("`{}…{}` is no number", "x".repeat(59), "x".repeat(58)));
    }
}
