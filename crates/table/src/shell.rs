//! Words of a command line, as a shell takes them.

use std::fmt::Write;
use std::path::Path;

/// A word as a POSIX shell takes it, on one line that a terminal can show.
///
/// Control characters, which may also end a comment or move the cursor, are written by number (`$'…'`, POSIX 2024, bash, zsh, ksh).
///
/// ```
/// # use switchback_table::shell::in_shell;
/// assert_eq!(in_shell("a b"), "'a b'");
/// assert_eq!(in_shell("a\nb"), r"$'a\012b'");
/// ```
pub fn in_shell(word: &str) -> String {
    quoted(word.as_bytes())
}

/// A path as a POSIX shell takes it, be it text or not.
pub fn path_in_shell(path: &Path) -> String {
    quoted(path.as_os_str().as_encoded_bytes())
}

fn quoted(word: &[u8]) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "._-/+:".contains(c);
    match std::str::from_utf8(word) {
        Ok(word) if !word.is_empty() && word.chars().all(is_plain) => word.to_owned(),
        Ok(word) if fits_a_line(word) => format!("'{}'", word.replace('\'', "'\\''")),
        _ => by_number(word),
    }
}

/// Whether a text stands on one line, and nothing in it is obeyed.
fn fits_a_line(text: &str) -> bool {
    !text.contains(|c| is_obeyed(c) || c == '\n' || c == '\t')
}

/// Whether a terminal or a reader of text obeys a character other than the ends of lines and tabulators: controls, and those that turn the direction of writing.
pub fn is_obeyed(c: char) -> bool {
    let is_control = c.is_control() && c != '\n' && c != '\t';
    is_control || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fffe}' | '\u{ffff}')
}

/// Printable ASCII as it is, the rest by number.
fn by_number(word: &[u8]) -> String {
    let mut text = "$'".to_owned();
    for byte in word {
        match byte {
            b'\'' | b'\\' => text.extend(['\\', char::from(*byte)]),
            b' '..=b'~' => text.push(char::from(*byte)),
            // Three digits: none of what follows can be taken for another.
            byte => drop(write!(text, "\\{byte:03o}")),
        }
    }
    text + "'"
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::ffi::OsStr;
    use std::process::Command;

    fn is_shown(text: &str) -> bool {
        !text.chars().any(char::is_control) && !text.contains('\u{202e}')
    }

    #[test]
    fn words_that_need_no_quotes_stay_as_they_are() {
        for word in ["a", "reports/a-1_2.toml", "ü+:", "-x"] {
            assert_eq!(in_shell(word), word);
        }
        assert_eq!((in_shell("").as_str(), in_shell("it's").as_str()), ("''", r"'it'\''s'"));
        assert_eq!(in_shell("\u{1b}[2J'\\\u{202e}"), r"$'\033[2J\'\\\342\200\256'");
    }

    #[cfg(unix)]
    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]
        #[test]
        fn bash_reads_the_word_that_was_given_and_a_comment_hides_it(word in prop::collection::vec(1..=255u8, 0..20)) {
            use std::os::unix::ffi::OsStrExt;
            let quoted = path_in_shell(Path::new(OsStr::from_bytes(&word)));
            prop_assert!(is_shown(&quoted), "{quoted:?}");
            let script = format!("# {quoted}\nprintf %s {quoted}x");
            let printed = Command::new("bash").args(["-c", &script]).output().expect("bash");
            prop_assert_eq!(printed.stdout, [&word[..], b"x"].concat());
        }
    }
}
