//! "Did you mean …?"

use strsim::levenshtein;

/// The candidate that `word` most likely meant: the one at the least edit distance, at most two or a third of its length.
pub fn closest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| (levenshtein(word, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= (candidate.chars().count() / 3).max(2))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typo_finds_its_key_and_a_stranger_finds_none() {
        let keys = ["name", "sample_time", "order", "interval"];
        assert_eq!(closest("ordre", keys), Some("order"));
        assert_eq!(closest("sampletime", keys), Some("sample_time"));
        assert_eq!(closest("oder", keys), Some("order"));
        assert_eq!(closest("temperature", keys), None);
    }
}
