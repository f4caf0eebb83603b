//! The answer of a diagnosis.

use std::fmt;

use schemars::JsonSchema;

use crate::effect::{Effect, Stage};
use crate::figure::Figure;

/// How far the verdict goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum Status {
    /// Nothing significant, or no gap that the judged records resolve.
    None,
    /// Values of what was compared with the machine are off, and nothing is missing in it.
    Parameters,
    /// The parameters of the model under diagnosis are off, or its order: identifying it anew closes the gap.
    Refit,
    /// The effects found.
    Named,
    /// One of several confounded effects that no record here separates.
    Class,
    /// Several candidates that the next experiment would separate.
    Ambiguous,
    /// The likeliest effects, none of them likely enough to be named.
    Shortlist,
    /// A gap whose cause is none of the candidates.
    Unexplained,
}

impl Status {
    /// Every status.
    pub const ALL: [Self; 8] = [
        Self::None,
        Self::Parameters,
        Self::Refit,
        Self::Named,
        Self::Class,
        Self::Ambiguous,
        Self::Shortlist,
        Self::Unexplained,
    ];

    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Parameters => "parameters",
            Self::Refit => "refit",
            Self::Named => "named",
            Self::Class => "class",
            Self::Ambiguous => "ambiguous",
            Self::Shortlist => "shortlist",
            Self::Unexplained => "unexplained",
        }
    }
}

/// The answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// How far it goes.
    pub status: Status,
    /// The effects named (status `named`: all of them act; `class`: the likeliest member). Empty otherwise.
    pub effects: Vec<Effect>,
    /// The confounded effects or rivals left standing (status `class`, `ambiguous` or `shortlist`), likeliest first.
    pub class: Vec<Effect>,
    /// The stage that the gap points at, also when unexplained.
    pub stage: Option<Stage>,
    /// Probability that the verdict holds (for `class`: that one of its members is the cause).
    pub probability: f64,
    /// Whether the probability was calibrated for records like these: an order declared, models identified here and compared one step
    /// ahead, a record held out. Elsewhere it only ranks.
    pub calibrated: bool,
    /// An effect in the augmented model that is no cause of its own: it takes the little that the law of the one named leaves.
    pub corrected_by: Option<Effect>,
    /// The model identified anew (status `refit`).
    pub refit: Option<Refit>,
    /// How many times as much, in root mean square, the model errs on the held-out records as on those it was fitted to, where these show
    /// nothing missing and that is beyond chance (status `unexplained`): the records were taken under other conditions.
    pub held_out_error_ratio: Option<f64>,
}

impl fmt::Display for Verdict {
    /// One line: `named: backlash (operator), probability 0.97`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.status.name())?;
        let reported = if self.status == Status::Named { &self.effects } else { &self.class };
        let names: Vec<&str> = reported.iter().map(|effect| effect.name()).collect();
        if let Some((last, others)) = names.split_last() {
            let joint = if self.status == Status::Named { "and" } else { "or" };
            let others =
                if others.is_empty() { String::new() } else { format!("{} {joint} ", others.join(", ")) };
            write!(f, ": {others}{last}")?;
        }
        if let Some(stage) = self.stage {
            write!(f, " ({stage})")?;
        }
        write!(f, ", probability {:.2}", self.probability)?;
        if self.calibrated { Ok(()) } else { f.write_str(", not calibrated for such records") }
    }
}

/// A model of the same kind, identified anew, that closes the gap without any cause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refit {
    /// Its order.
    pub order: usize,
    /// Samples by which its output follows the input later than in the paper; −1 where it follows within the sample.
    pub delay: isize,
    /// Share of the gap on the judged records that it closes.
    pub closure: Figure,
}

pub(crate) fn naming_nothing(status: Status, stage: Option<Stage>, probability: f64) -> Verdict {
    Verdict {
        status,
        effects: Vec::new(),
        class: Vec::new(),
        stage,
        probability,
        calibrated: true,
        corrected_by: None,
        refit: None,
        held_out_error_ratio: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_is_one_line() {
        let verdict = Verdict {
            status: Status::Named,
            effects: vec![Effect::Backlash, Effect::Creep],
            class: Vec::new(),
            stage: Some(Stage::Operator),
            probability: 0.974,
            calibrated: true,
            corrected_by: None,
            refit: None,
            held_out_error_ratio: None,
        };
        assert_eq!(verdict.to_string(), "named: backlash and creep (operator), probability 0.97");
        let class = vec![Effect::Backlash, Effect::Creep, Effect::InputDelay];
        let rivals = Verdict {
            status: Status::Class,
            effects: vec![Effect::Backlash],
            class,
            calibrated: false,
            stage: None,
            ..verdict
        };
        let reported =
            "class: backlash, creep or input_delay, probability 0.97, not calibrated for such records";
        assert_eq!(rivals.to_string(), reported);
        let none = Verdict { status: Status::None, class: Vec::new(), calibrated: true, ..rivals };
        assert_eq!(none.to_string(), "none, probability 0.97");
    }
}
