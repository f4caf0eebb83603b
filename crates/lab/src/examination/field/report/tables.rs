//! The tables as CSV.

use crate::examination::{csv, share_field};
use crate::field::case::Case;
use crate::field::score::{AnswerRow, Asked, BaseVerdicts, Rating, Scores};

const ANSWERS: [&str; 25] = [
    "id",
    "kind",
    "base",
    "measured",
    "effect",
    "law",
    "planting",
    "wanted",
    "size",
    "raw",
    "with_model",
    "status",
    "effects",
    "class",
    "stage",
    "probability",
    "top",
    "top_probability",
    "rating",
    "closure",
    "closure_low",
    "closure_high",
    "closure_actual",
    "left",
    "gains",
];

/// One row a diagnosis: what was put in, what was said, and what that is worth.
pub(in crate::examination::field) fn answers(cases: &[Case]) -> String {
    let verdicts = BaseVerdicts::of(cases);
    csv(&ANSWERS, verdicts.asked(cases).iter().map(row))
}

fn row(asked: &Asked<'_>) -> Vec<String> {
    let Asked { case, answer, .. } = asked;
    let figure = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4}"));
    let fault = case.fault.as_ref();
    let (reply, closure) = (&answer.reply, answer.closure);
    vec![
        case.id.to_string(),
        case.kind.name().to_owned(),
        case.base.clone(),
        case.is_measured.to_string(),
        fault.map_or_else(String::new, |f| f.effect.to_owned()),
        fault.map_or_else(String::new, |f| f.law.clone()),
        fault.map_or_else(String::new, |f| f.how.name().to_owned()),
        fault.map_or_else(String::new, |f| f.wanted.to_string()),
        figure(fault.map(|f| f.size)),
        figure(fault.map(|f| f.raw)),
        answer.with_model.to_string(),
        reply.status.to_owned(),
        reply.effects.join("+"),
        reply.class.join("|"),
        reply.stage.unwrap_or_default().to_owned(),
        format!("{:.4}", reply.probability),
        reply.top.0.to_owned(),
        format!("{:.4}", reply.top.1),
        rating(asked.rating()).to_owned(),
        figure(closure.map(|c| c.estimate)),
        figure(closure.map(|c| c.ci90[0])),
        figure(closure.map(|c| c.ci90[1])),
        figure(closure.map(|c| c.actual)),
        format!("{:.0}", answer.evidence.left),
        answer.evidence.gains(),
    ]
}

/// Empty where nobody can show, or cannot show yet.
fn rating(rating: Option<Rating>) -> &'static str {
    match rating {
        Some(Rating::Exact) => "exact",
        Some(Rating::Class) => "class",
        Some(Rating::Silent) => "silent",
        Some(Rating::Wrong) => "wrong",
        None => "",
    }
}

/// Answers counted, a kind of rig a row.
pub(super) fn rows(of: &str, rows: &[AnswerRow]) -> String {
    let header = [of, "with_model", "answers", "judged", "exact", "class", "silent", "wrong"];
    let rows = rows.iter().map(|row| {
        vec![
            row.of.clone(),
            row.with_model.to_string(),
            row.asked.to_string(),
            row.exact.of.to_string(),
            share_field(row.exact),
            share_field(row.class),
            share_field(row.silent),
            share_field(row.wrong),
        ]
    });
    csv(&header, rows)
}

/// Bins of the claims, all together and a stratum at a time.
pub(super) fn strata(scores: &Scores) -> String {
    let all = std::iter::once(("all".to_owned(), "", &scores.claims));
    let each = scores.strata.iter().map(|s| {
        let model = if s.with_model { "true" } else { "false" };
        (s.of.clone(), model, &s.claims)
    });
    let rows = all.chain(each).flat_map(|(of, model, claims)| {
        claims.bins.iter().map(move |bin| {
            vec![
                of.clone(),
                model.to_owned(),
                format!("{:.4}", bin.claimed),
                share_field(bin.held),
                bin.held.of.to_string(),
            ]
        })
    });
    csv(&["stratum", "with_model", "claimed", "held", "answers"], rows)
}
