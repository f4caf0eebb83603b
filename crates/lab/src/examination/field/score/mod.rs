//! Scoring the judged rigs.

mod calibration;
mod measure;
mod rating;
mod rows;

pub(crate) use calibration::Claims;
pub(crate) use calibration::Stratum;
pub(crate) use rating::Asked;
pub(crate) use rating::BaseVerdicts;
pub(crate) use rating::Rating;
pub(crate) use rating::WIDEST_CLASS;
pub use rows::AnswerRow;

use super::case::Case;
use super::scenario::Expect;
use crate::blind::Confusion;
use crate::examination::Measure;

/// All tables of a field examination.
#[derive(Debug, Clone)]
pub struct Scores {
    /// The summary: what must be reached, what was.
    pub measures: Vec<Measure>,
    /// Faults of size 2 at least, an effect at a time.
    pub by_effect: Vec<AnswerRow>,
    /// The same, a base at a time.
    pub by_base: Vec<AnswerRow>,
    /// The same, by how they were put in.
    pub by_planting: Vec<AnswerRow>,
    /// All faults by the size reached.
    pub by_size: Vec<AnswerRow>,
    /// Claimed probability against what holds.
    pub claims: Claims,
    /// The same a stratum at a time.
    pub strata: Vec<Stratum>,
    /// What was put in against what was said beyond the base's own verdict.
    pub confusion: Confusion,
    /// Faults that are too small to be asked for.
    pub not_observable: usize,
    /// Rigs that could not be made, by their number, and why.
    pub refused: Vec<(usize, String)>,
    /// Diagnoses that were refused.
    pub failed: usize,
}

/// Computes every table.
pub fn score(cases: &[Case], expect: &Expect) -> Scores {
    let verdicts = BaseVerdicts::of(cases);
    let asked = verdicts.asked(cases);
    let claims = Claims::of(asked.iter().filter_map(Asked::claim));
    let unobservable = |c: &&Case| c.fault.as_ref().is_some_and(|fault| !fault.is_observable());
    Scores {
        measures: measure::measures(&asked, &claims, expect),
        by_effect: rows::by(&asked, Asked::large_effect),
        by_base: rows::by(&asked, |a| a.is_large().then(|| a.case.base.clone())),
        by_planting: rows::by(&asked, |a| a.is_large().then(|| a.stratum())),
        by_size: rows::by(&asked, Asked::size_class),
        strata: calibration::strata(&asked),
        confusion: rows::confusion(&asked),
        not_observable: cases.iter().filter(unobservable).count(),
        refused: cases.iter().filter_map(|c| Some((c.id, c.refused.clone()?))).collect(),
        failed: asked.iter().filter(|a| a.answer.reply.status == "failed").count(),
        claims,
    }
}

#[cfg(test)]
mod tests;
