//! The verdicts of parts of the records, in a sentence and in JSON.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_io::diagnosis;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stability {
    /// Share of all parts, samples and recordings, with the verdict of all records; null where there is none.
    #[schemars(range(min = 0, max = 1))]
    pub share: Option<f64>,
    /// Samples of three quarters of every record, in one piece.
    pub samples: Vec<PartVerdict>,
    /// Each recording alone; empty where there is only one.
    pub recordings: Vec<PartVerdict>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PartVerdict {
    /// The recording, or the number of the sample.
    pub part: String,
    /// Its verdict in words, or the reason why it has none.
    pub verdict: String,
    /// Whether it is that of all records.
    pub agrees: bool,
}

impl Stability {
    pub(super) fn of(stability: &diagnosis::Stability) -> Self {
        let diagnosis::Stability { samples, recordings } = stability;
        let written = |part: &diagnosis::PartVerdict| PartVerdict {
            part: part.part.clone(),
            verdict: part.verdict.clone(),
            agrees: part.agrees,
        };
        let [one, other] = [samples, recordings].map(|parts| diagnosis::Stability::agreeing(parts));
        let (agreeing, count) = (one.0 + other.0, one.1 + other.1);
        Self {
            share: (count > 0).then(|| agreeing as f64 / count as f64),
            samples: samples.iter().map(written).collect(),
            recordings: recordings.iter().map(written).collect(),
        }
    }
}

/// How many parts give the verdict of all records, and what the others say.
pub(super) fn sentences(stability: &diagnosis::Stability) -> Vec<String> {
    let diagnosis::Stability { samples, recordings } = stability;
    let of = |parts: &[diagnosis::PartVerdict], what: &str| {
        let (agreeing, count) = diagnosis::Stability::agreeing(parts);
        (count > 0).then(|| format!("{agreeing} of {count} {what}"))
    };
    let parts = [of(samples, "samples of three quarters of the records"), of(recordings, "recordings alone")];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    if parts.is_empty() {
        return vec![
            "How stable the verdict is cannot be said: there is one recording, too short or designed to be taken in parts."
                .to_owned(),
        ];
    }
    let mut sentences = vec![format!("The same verdict comes from {}.", parts.join(" and from "))];
    let others: Vec<&diagnosis::PartVerdict> = recordings.iter().filter(|part| !part.agrees).collect();
    for other in &others {
        sentences.push(format!("{} alone says: {}.", other.part, other.verdict));
    }
    if let ([_, _, ..], [one, ..]) = (&recordings[..], &others[..]) {
        sentences.push(format!(
            "`switchback gap {0} --against` the other recordings shows in what {0} differs from them.",
            one.part
        ));
    }
    let mut said: Vec<(&str, usize)> = Vec::new();
    for other in samples.iter().filter(|part| !part.agrees) {
        let verdict = other.verdict.split(", probability").next().unwrap_or_default();
        match said.iter_mut().find(|(known, _)| *known == verdict) {
            Some((_, count)) => *count += 1,
            None => said.push((verdict, 1)),
        }
    }
    said.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    if !said.is_empty() {
        let said: Vec<String> = said.iter().map(|(verdict, count)| format!("{verdict} ({count})")).collect();
        sentences.push(format!("Other samples say: {}.", said.join("; ")));
    }
    sentences
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_agree_are_counted_and_other_verdicts_quoted() {
        let part = |part: &str, verdict: &str, agrees| diagnosis::PartVerdict {
            part: part.to_owned(),
            verdict: verdict.to_owned(),
            agrees,
        };
        let named = "named: backlash (operator), probability 0.90";
        let stability = diagnosis::Stability {
            samples: vec![
                part("sample 1", named, true),
                part("sample 2", "none, probability 0.90", false),
                part("sample 3", "none, probability 0.80", false),
            ],
            recordings: vec![part("monday", named, true), part("tuesday", "none, probability 0.70", false)],
        };
        let text = sentences(&stability).join(" ");
        assert_eq!(
            text,
            "The same verdict comes from 1 of 3 samples of three quarters of the records and from 1 of 2 recordings alone. tuesday alone says: none, \
             probability 0.70. `switchback gap tuesday --against` the other recordings shows in what tuesday differs from them. Other samples say: none (2)."
        );
        assert_eq!(Stability::of(&stability).share, Some(0.4));
        let nothing = diagnosis::Stability { samples: Vec::new(), recordings: Vec::new() };
        assert_eq!(Stability::of(&nothing).share, None);
        assert!(sentences(&nothing)[0].contains("cannot be said"));
    }
}
