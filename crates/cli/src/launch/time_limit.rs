//! `--time`, as sbatch takes it.

use std::fmt;
use std::str::FromStr;

/// A time limit, written as `M`, `M:S`, `H:M:S`, `D-H`, `D-H:M` or `D-H:M:S`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TimeLimit {
    text: String,
    seconds: u64,
}

impl TimeLimit {
    /// In seconds, at least one.
    pub(crate) fn seconds(&self) -> u64 {
        self.seconds
    }
}

impl fmt::Display for TimeLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl FromStr for TimeLimit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds = seconds(text).filter(|seconds| *seconds > 0);
        let seconds = seconds.ok_or(
            "give minutes, or hours:minutes:seconds, or days-hours:minutes:seconds, as in 90 or 1:30:00",
        )?;
        Ok(Self { text: text.to_owned(), seconds })
    }
}

fn seconds(text: &str) -> Option<u64> {
    let (days, rest) = match text.split_once('-') {
        Some((days, rest)) => (Some(days.parse::<u64>().ok()?), rest),
        None => (None, text),
    };
    let fields: Vec<u64> = rest.split(':').map(|field| field.parse().ok()).collect::<Option<_>>()?;
    // Behind days come hours first; without them minutes, unless there are three.
    let units: &[u64] = match (days.is_some(), fields.len()) {
        (true, 1..=3) | (false, 3) => &[3600, 60, 1],
        (false, 1 | 2) => &[60, 1],
        _ => return None,
    };
    let parts = fields.iter().zip(units).map(|(field, unit)| field.checked_mul(*unit));
    let days = days.unwrap_or(0).checked_mul(86_400);
    [days].into_iter().chain(parts).try_fold(0_u64, |sum, part| sum.checked_add(part?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_that_sbatch_documents_is_read() {
        let read = |text: &str| text.parse::<TimeLimit>().ok().map(|limit| limit.seconds());
        for (text, expected) in [
            ("5", 300),
            ("5:30", 330),
            ("1:00:00", 3600),
            ("2-0", 172_800),
            ("1-2:03", 93_780),
            ("1-2:03:04", 93_784),
            ("1000", 60_000),
        ] {
            assert_eq!(read(text), Some(expected), "{text}");
        }
        for bad in ["", "0", "0:00", "1h", "1:2:3:4", "-5", "1-", "1-2:3:4:5", "5.5", "99999999999999999999"]
        {
            assert_eq!(read(bad), None, "{bad}");
        }
    }
}
