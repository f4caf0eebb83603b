//! The words of a name, however it is written.

use super::words::{self, Words};
use std::cell::RefCell;
use std::collections::HashMap;

/// Bytes of a compound, at most: what is longer is no word.
const LONGEST: usize = 256;

/// Bytes of names that are kept with their words, at most.
const KEPT: usize = 1 << 24;

thread_local! {
    /// Names with their words, and their bytes: they are looked up for every part of a record, and again beside each other one.
    static KNOWN: RefCell<(HashMap<String, String>, usize)> = RefCell::default();
}

/// Lower case without accents, with single blanks for all that is neither letter nor digit, between words joined like `loadCell`, and between
/// those of compounds.
pub(super) fn simplified(name: &str) -> String {
    KNOWN.with_borrow_mut(|(known, bytes)| {
        if let Some(words) = known.get(name) {
            return words.clone();
        }
        *bytes += name.len();
        if *bytes > KEPT {
            known.clear();
            *bytes = name.len();
        }
        let words = in_words(name);
        known.insert(name.to_owned(), words.clone());
        words
    })
}

fn in_words(name: &str) -> String {
    let mut simple = String::new();
    let mut before = ' ';
    for letter in name.chars().filter(|letter| !is_accent(*letter)) {
        if letter.is_uppercase() && before.is_lowercase() {
            simple.push(' ');
        }
        before = letter;
        let lower = if letter.is_alphanumeric() { letter } else { ' ' }.to_lowercase();
        simple.extend(lower.map(without_accent));
    }
    let words = simple.split_whitespace().map(apart).collect::<Vec<_>>().join(" ");
    words.replace("set point", "setpoint")
}

/// What stands behind the last mark of a path: `pos_setpoint` of `axis0.controller.pos_setpoint`.
pub(super) fn last_part(name: &str) -> &str {
    let has_letter = |part: &&str| part.chars().any(char::is_alphabetic);
    name.rsplit(['/', '.', ':', '\\', '|']).find(has_letter).unwrap_or(name)
}

/// Marks that are written over the letter before.
fn is_accent(letter: char) -> bool {
    ('\u{300}'..='\u{36f}').contains(&letter)
}

fn without_accent(letter: char) -> char {
    const ACCENTS: [(&str, char); 14] = [
        ("àáâãäåąă", 'a'),
        ("çćč", 'c'),
        ("ďđ", 'd'),
        ("èéêëęě", 'e'),
        ("ìíîï", 'i'),
        ("ł", 'l'),
        ("ñńň", 'n'),
        ("òóôõöøő", 'o'),
        ("řŕ", 'r'),
        ("śšş", 's'),
        ("ťţ", 't'),
        ("ùúûüůű", 'u'),
        ("ýÿ", 'y'),
        ("źżž", 'z'),
    ];
    let plain = ACCENTS.iter().find(|(accented, _)| accented.contains(letter));
    plain.map_or(letter, |(_, plain)| *plain)
}

fn is_known(word: &str) -> bool {
    words::KNOWN.iter().any(|all| words::has(all, word))
}

/// Compounds as their words: `sollposition`, `standardkraft`, `目标位置`.
fn apart(word: &str) -> String {
    /// Letters before the word at the end of a compound, at least.
    const LEAST: usize = 3;
    if word.len() > LONGEST || is_known(word) {
        return word.to_owned();
    }
    if word.chars().any(is_ideographic) {
        return runs(word);
    }
    let is_signal = |rest: &str| {
        [words::MOTION, words::DRIVE, words::ANSWER, words::OUTPUT].iter().any(|all| words::has(all, rest))
    };
    let begins = longest(words::PREFIXES, |prefix| word.strip_prefix(prefix).filter(|rest| is_signal(rest)));
    if let Some((prefix, rest)) = begins {
        return format!("{prefix} {rest}");
    }
    let ends = longest(words::SUFFIXES, |suffix| {
        word.strip_suffix(suffix).filter(|rest| rest.chars().count() >= LEAST)
    });
    ends.map_or_else(|| word.to_owned(), |(suffix, rest)| format!("{} {suffix}", apart(rest)))
}

/// The longest word of a list that fits, and what it leaves.
fn longest<'w>(words: Words, fits: impl Fn(&str) -> Option<&'w str>) -> Option<(&'static str, &'w str)> {
    let all = words.iter().flat_map(|line| line.split(", "));
    all.filter_map(|word| Some((word, fits(word)?))).max_by_key(|(word, _)| word.len())
}

/// Letters of languages that set no blanks between words.
fn is_ideographic(letter: char) -> bool {
    ('\u{3040}'..='\u{30ff}').contains(&letter)
        || ('\u{3400}'..='\u{9fff}').contains(&letter)
        || ('\u{ac00}'..='\u{d7af}').contains(&letter)
}

/// Known words set apart from what stands between them, the longest first.
fn runs(word: &str) -> String {
    let (mut found, mut rest, mut between): (Vec<String>, &str, String) = (Vec::new(), word, String::new());
    while let Some(first) = rest.chars().next() {
        let all = || words::KNOWN.iter().filter_map(|all| longest(all, |known| rest.strip_prefix(known)));
        let known = all().filter(|(known, _)| known.chars().all(is_ideographic)).max_by_key(|(k, _)| k.len());
        match known {
            Some((known, behind)) => {
                found.extend((!between.is_empty()).then(|| std::mem::take(&mut between)));
                found.push(known.to_owned());
                rest = behind;
            }
            None => {
                between.push(first);
                rest = &rest[first.len_utf8()..];
            }
        }
    }
    found.extend((!between.is_empty()).then_some(between));
    found.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_all_spellings_become_words() {
        for (name, words) in [
            ("loadCell", "load cell"),
            ("Sollposition", "soll position"),
            ("Standardkraft", "standard kraft"),
            ("Traversenweg absolut", "traversenweg absolut"),
            ("LWS.Lenkradwinkel", "lws lenkrad winkel"),
            ("Lageistwert", "lage istwert"),
            ("Déplacement", "deplacement"),
            ("De\u{301}placement", "deplacement"),
            ("field.set_point", "field setpoint"),
            ("ThrVlv_rDes\\XETKC:1", "thr vlv r des xetkc 1"),
            ("目标位置", "目标 位置"),
            ("試験荷重", "試験 荷重"),
            ("実測トルク1", "実測 トルク 1"),
            ("payload", "payload"),
            ("Drehmoment", "drehmoment"),
        ] {
            assert_eq!(simplified(name), words, "{name}");
        }
    }

    #[test]
    fn what_is_too_long_to_be_a_word_is_none() {
        let (short, long) = ("force".repeat(4), "force".repeat(200_000));
        assert_eq!((simplified(&short), simplified(&long)), ("force force force force".to_owned(), long));
    }

    #[test]
    fn the_last_part_of_a_path_is_the_signal_s_own() {
        for (name, last) in [
            ("axis0.controller.pos_setpoint", "pos_setpoint"),
            ("/joint_states/effort[0]", "effort[0]"),
            ("EPS_Cmd::EPS_TargetAngle", "EPS_TargetAngle"),
            ("plain", "plain"),
        ] {
            assert_eq!(last_part(name), last);
        }
    }
}
