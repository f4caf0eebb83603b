//! Paragraphs of a page for a person.

use std::fmt::Write;

/// Letters a line.
const WIDTH: usize = 100;

/// Lines of at most [`WIDTH`] letters, all but the first begun with `indent`; blanks before the first word are kept.
pub fn wrapped(text: &str, indent: &str) -> String {
    let words = text.trim_start();
    let mut page = String::new();
    let mut line = text[..text.len() - words.len()].to_owned();
    let mut begun = false;
    for word in words.split(' ') {
        if begun && line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(page, "{line}");
            line = indent.to_owned();
        } else if begun {
            line.push(' ');
        }
        line.push_str(word);
        begun = true;
    }
    let _ = writeln!(page, "{line}");
    page
}
