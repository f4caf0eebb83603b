//! Every draw as a row.

use super::{Answer, Draw, Finding, Power};
use crate::examination;

/// The columns of `power.csv`: sizes are ratios, the magnitude is in `unit`; of a draw that was refused only the answer is there, with the reason.
const HEADER: [&str; 10] =
    ["effect", "draw", "law", "planting", "size", "raw_size", "magnitude", "unit", "found", "answer"];

/// A row a draw.
pub fn csv(power: &Power) -> String {
    examination::csv(&HEADER, power.findings.iter().flat_map(rows))
}

fn rows(finding: &Finding) -> impl Iterator<Item = Vec<String>> {
    finding.draws.iter().enumerate().map(|(number, draw)| {
        let mut row = vec![finding.effect.to_owned(), (number + 1).to_string()];
        row.extend(match draw {
            Draw::Diagnosed { fault, answer } => vec![
                fault.law.to_owned(),
                fault.injection.name().to_owned(),
                fault.size.to_string(),
                fault.raw.to_string(),
                fault.magnitude.to_string(),
                fault.unit.to_owned(),
                answer.is_found().to_string(),
                answer.reported().to_owned(),
            ],
            Draw::Refused(reason) => [vec![String::new(); 7], vec![reason.clone()]].concat(),
        });
        row
    })
}

impl Answer {
    /// The answer in a word or a few.
    pub(crate) fn reported(&self) -> &str {
        match self {
            Self::Named => "named",
            Self::InClass => "class",
            Self::Other(reported) => reported,
        }
    }
}
