//! Text of others on the terminal and on pages.

use std::borrow::Cow;

/// A text whose control characters are shown instead of obeyed: `␛` for ESC, `␀` for NUL, `�` for those without a picture. Names in files may hold
/// any: they would steer a terminal, and an SVG with one is no XML. Ends of lines and tabs stay.
///
/// ```text
/// U+0000 … U+001F → U+2400 … U+241F   U+007F → U+2421   U+0080 … U+009F, U+202A … U+202E, U+2066 … U+2069, U+FFFE, U+FFFF → U+FFFD
/// ```
///
/// The pictures are the block "Control Pictures" of Unicode; what XML allows is production 2 of XML 1.0; the others turn the direction of what
/// follows.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let is_line_end = |k: usize| text[k..].starts_with("\r\n");
    let shown =
        text.char_indices().map(|(k, c)| if !is_obeyed(c) || is_line_end(k) { c } else { picture(c) });
    Cow::Owned(shown.collect())
}

fn is_obeyed(c: char) -> bool {
    let is_control = c.is_control() && c != '\n' && c != '\t';
    is_control || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{fffe}' | '\u{ffff}')
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
    fn controls_are_shown_and_all_else_stays() {
        assert_eq!(visible("a\u{1b}[31mb\0\u{7f}\u{9b}\rc"), "a␛[31mb␀␡\u{fffd}␍c");
        assert_eq!(visible("tab\tline\r\nµ 力 \u{202e}"), "tab\tline\r\nµ 力 \u{fffd}");
        assert!(matches!(visible("plain\n"), Cow::Borrowed(_)));
    }
}
