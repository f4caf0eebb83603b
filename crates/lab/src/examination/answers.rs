//! The table of answers: one row a diagnosis, what was put in and what was said.

use super::case::Case;
use super::design::Design;
use super::fault::Fault;
use super::rating::{Asked, BaseVerdicts, Rating};
use super::table::csv;

/// A column: its head, and its field of an answer.
type Column = (&'static str, fn(&Asked<'_>) -> String);

/// The table of answers. That of a part shows what it can before the others are judged.
pub fn answers(design: Design, cases: &[Case]) -> String {
    let columns = match design {
        Design::Laboratory => [&LABORATORY[..], &REPLY, &BASELINE, &CLOSURE, &PAIR].concat(),
        Design::Field => [&FIELD[..], &REPLY, &RATING, &CLOSURE].concat(),
    };
    let head = |(head, _): &Column| match (*head, design) {
        ("effects", Design::Laboratory) => "named",
        (head, _) => head,
    };
    let header: Vec<&str> = columns.iter().map(head).collect();
    let verdicts = BaseVerdicts::of(cases);
    let row = |asked: &Asked<'_>| columns.iter().map(|(_, field)| field(asked)).collect();
    csv(&header, verdicts.asked(cases).iter().map(row))
}

const LABORATORY: [Column; 8] = [
    ("id", |a| a.case.id.to_string()),
    ("kind", |a| Design::Laboratory.name(a.case.kind).to_owned()),
    ("system", |a| a.case.base.clone()),
    ("truth", |a| a.case.truth().join("+")),
    ("law", |a| of_fault(a, |fault| fault.law.clone())),
    ("plain", |a| a.case.is_plain().to_string()),
    ("wanted", |a| a.case.wanted().to_string()),
    ("size", |a| format!("{:.3}", a.case.size())),
];

const FIELD: [Column; 11] = [
    ("id", |a| a.case.id.to_string()),
    ("kind", |a| Design::Field.name(a.case.kind).to_owned()),
    ("base", |a| a.case.base.clone()),
    ("measured", |a| a.case.is_measured.to_string()),
    ("effect", |a| of_fault(a, |fault| fault.effect.to_owned())),
    ("law", |a| of_fault(a, |fault| fault.law.clone())),
    ("planting", |a| of_fault(a, |fault| fault.how.name().to_owned())),
    ("wanted", |a| of_fault(a, |fault| fault.wanted.to_string())),
    ("size", |a| of_fault(a, |fault| format!("{:.4}", fault.size))),
    ("raw", |a| of_fault(a, |fault| figure(fault.raw))),
    ("with_model", |a| a.answer.with_model.to_string()),
];

const REPLY: [Column; 7] = [
    ("status", |a| a.answer.reply.status.to_owned()),
    ("effects", |a| a.answer.reply.effects.join("+")),
    ("class", |a| a.answer.reply.class.join("|")),
    ("stage", |a| word(a.answer.reply.stage)),
    ("probability", |a| format!("{:.4}", a.answer.reply.probability)),
    ("top", |a| a.answer.reply.top.0.to_owned()),
    ("top_probability", |a| format!("{:.4}", a.answer.reply.top.1)),
];

const BASELINE: [Column; 3] = [
    ("lowest_rmse", |a| word(a.answer.baseline.and_then(|rules| rules.lowest_rmse))),
    ("heldout_winner", |a| word(a.answer.baseline.and_then(|rules| rules.heldout_winner))),
    ("plain_bic", |a| word(a.answer.baseline.and_then(|rules| rules.plain_bic))),
];

/// Empty where nobody can show, or cannot show yet.
const RATING: [Column; 1] = [("rating", |a| word(a.rating().map(Rating::name)))];

const CLOSURE: [Column; 6] = [
    ("closure", |a| figure(a.answer.closure.map(|closure| closure.estimate))),
    ("closure_low", |a| figure(a.answer.closure.map(|closure| closure.ci90[0]))),
    ("closure_high", |a| figure(a.answer.closure.map(|closure| closure.ci90[1]))),
    ("closure_actual", |a| figure(a.answer.closure.map(|closure| closure.actual))),
    ("left", |a| format!("{:.0}", a.answer.evidence.left)),
    ("gains", |a| a.answer.evidence.gains()),
];

/// The best pair as `effects:gain over the best single one:left by both:left by the single one`.
const PAIR: [Column; 2] = [
    ("samples", |a| a.answer.evidence.samples.to_string()),
    ("together", |a| {
        let pair = a.answer.evidence.together.as_ref();
        pair.map_or_else(String::new, |p| {
            format!("{}:{:.0}:{:.0}:{:.0}", p.effects.join("+"), p.gain, p.left, p.left_by_single)
        })
    }),
];

fn figure(x: Option<f64>) -> String {
    x.map_or_else(String::new, |x| format!("{x:.4}"))
}

fn word(word: Option<&str>) -> String {
    word.unwrap_or_default().to_owned()
}

fn of_fault(asked: &Asked<'_>, field: fn(&Fault) -> String) -> String {
    asked.case.fault.as_ref().map_or_else(String::new, field)
}
