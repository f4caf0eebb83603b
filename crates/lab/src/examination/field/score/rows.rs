//! Answers counted, some kind of rig at a time.

use super::rating::{Asked, Rating};
use crate::blind::Confusion;
use crate::examination::Share;
use crate::field::design::Kind;
use crate::generate::EFFECTS;

/// The answers about one kind of rig.
#[derive(Debug, Clone, PartialEq)]
pub struct AnswerRow {
    /// Which.
    pub of: String,
    /// Whether the base's model was given.
    pub with_model: bool,
    /// Answers, those that nobody can judge among them.
    pub asked: usize,
    /// Exactly the fault was named.
    pub exact: Share,
    /// The right class was reported, or exactly the fault.
    pub class: Share,
    /// Nothing was named.
    pub silent: Share,
    /// Something else was named.
    pub wrong: Share,
}

/// The share of judged answers with one of some ratings.
pub(super) fn share<'a, 'c: 'a>(asked: impl Iterator<Item = &'a Asked<'c>>, wanted: &[Rating]) -> Share {
    let ratings: Vec<Rating> = asked.filter_map(Asked::rating).collect();
    Share::over(ratings.iter(), |rating| wanted.contains(rating))
}

/// The right class, or better.
pub(super) const RIGHT: [Rating; 2] = [Rating::Exact, Rating::Class];

/// Rows by what `key` says of an answer; none leaves it out.
pub(super) fn by<'c>(asked: &[Asked<'c>], key: impl Fn(&Asked<'c>) -> Option<String>) -> Vec<AnswerRow> {
    let keyed: Vec<(String, &Asked<'_>)> = asked.iter().filter_map(|a| Some((key(a)?, a))).collect();
    let mut kinds: Vec<(String, bool)> =
        keyed.iter().map(|(of, a)| (of.clone(), a.answer.with_model)).collect();
    kinds.sort();
    kinds.dedup();
    let row = |(of, with_model): (String, bool)| {
        let inside = || {
            let is_inside =
                |(key, a): &&(String, &Asked<'_>)| *key == of && a.answer.with_model == with_model;
            keyed.iter().filter(is_inside).map(|(_, a)| *a)
        };
        AnswerRow {
            with_model,
            asked: inside().count(),
            exact: share(inside(), &[Rating::Exact]),
            class: share(inside(), &RIGHT),
            silent: share(inside(), &[Rating::Silent]),
            wrong: share(inside(), &[Rating::Wrong]),
            of: of.clone(),
        }
    };
    kinds.into_iter().map(row).collect()
}

/// What was put in, at a size of 2 at least, against what was said beyond the base's own verdict.
pub(super) fn confusion(asked: &[Asked<'_>]) -> Confusion {
    let rows: Vec<_> = EFFECTS.into_iter().chain(["none", "outside"]).collect();
    let rest = ["several", "class", "ambiguous", "none", "refit", "unexplained", "failed"];
    let columns: Vec<_> = EFFECTS.into_iter().chain(rest).collect();
    let mut counts = vec![vec![0; columns.len()]; rows.len()];
    for one in asked.iter().filter(|a| a.rating().is_some()) {
        let truth = match one.case.kind {
            Kind::Injected if one.is_large() => one.truth().unwrap_or_default(),
            Kind::Injected => continue,
            Kind::Outside => "outside",
            Kind::Bare | Kind::Resampled => "none",
        };
        let news = one.news().unwrap_or_default();
        let said = match (one.answer.reply.status, news.as_slice()) {
            ("named", [effect]) => *effect,
            ("named", [_, ..]) => "several",
            (status @ ("class" | "ambiguous"), [_, ..]) => status,
            (status @ ("refit" | "unexplained" | "failed"), _) => status,
            _ => "none",
        };
        let row = rows.iter().position(|r| *r == truth);
        let column = columns.iter().position(|c| *c == said);
        if let (Some(row), Some(column)) = (row, column) {
            counts[row][column] += 1;
        }
    }
    Confusion { rows, columns, counts }
}
