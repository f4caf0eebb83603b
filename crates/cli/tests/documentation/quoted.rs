//! Whether a quote is what was printed.

/// How far a figure may be off: another processor's mathematical library changes what an optimisation ends at.
const SLACK: f64 = 0.02;

/// The first part of a quote that was not printed; parts are divided by lines `…`.
pub(crate) fn missing(quote: &str, printed: &str) -> Option<String> {
    let words: Vec<&str> = printed.split_whitespace().collect();
    let mut from = 0;
    for part in quote.split("…\n").filter(|part| !part.trim().is_empty()) {
        let wanted: Vec<&str> = part.split_whitespace().collect();
        let place = (from..words.len()).find(|at| begins(&words[*at..], &wanted));
        match place {
            Some(at) => from = at + wanted.len(),
            None => return Some(part.to_owned()),
        }
    }
    None
}

fn begins(words: &[&str], wanted: &[&str]) -> bool {
    words.len() >= wanted.len() && words.iter().zip(wanted).all(|(word, wanted)| is_same(word, wanted))
}

/// The same word, or nearly the same figure with the same signs around it.
fn is_same(word: &str, wanted: &str) -> bool {
    if word == wanted {
        return true;
    }
    let (Some(x), Some(y)) = (figure(word), figure(wanted)) else { return false };
    (x.0, x.2) == (y.0, y.2) && (x.1 - y.1).abs() <= SLACK * x.1.abs().max(y.1.abs()) + x.3.max(y.3)
}

/// What stands before a figure, the figure, what stands behind it, and one unit of its last digit.
fn figure(word: &str) -> Option<(&str, f64, &str, f64)> {
    let start = word.find(|c: char| c.is_ascii_digit())?;
    let (before, rest) = word.split_at(start);
    let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(rest.len());
    let (digits, behind) = rest.split_at(end);
    let (digits, behind) =
        digits.strip_suffix('.').map_or((digits, behind), |whole| (whole, &rest[whole.len()..]));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Some((before, digits.parse().ok()?, behind, 10f64.powi(-(decimals as i32))))
}

#[cfg(test)]
mod tests {
    use super::missing;

    #[test]
    fn figures_may_differ_a_little_and_words_may_not() {
        let printed = "Cause: backlash (play 1.003 [1.000, 1.004] mm), probability > 0.99.\nAdding it closes 99.6 % [96, 102].\n";
        for same in [
            "backlash (play 1.004 [1.000,\n1.004] mm),\n",
            "Cause:\n…\ncloses 99.5 % [96, 102].\n",
            "closes 98.6 %\n",
        ] {
            assert_eq!(missing(same, printed), None, "{same}");
        }
        for other in [
            "backlash (play 1.103 [1.000,\n",
            "Cause: creep\n",
            "closes 90.0 %\n",
            "closes 99.6 mm\n",
            "play −1.003 [1.000,\n",
            "Adding it\n…\nCause:\n",
        ] {
            assert!(missing(other, printed).is_some(), "{other}");
        }
    }
}
