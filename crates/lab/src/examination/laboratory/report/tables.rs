//! The tables as CSV.

use crate::blind::case::Case;
use crate::blind::score::{AbstentionRow, AccuracyRow, BaselineRow, Calibration, ClosureRow, PlaceRow};
use crate::examination::{csv, share_field as share};

/// One row a rig: what was put in, what was said.
pub(super) fn answers(cases: &[Case]) -> String {
    let header = [
        "id",
        "kind",
        "system",
        "truth",
        "law",
        "plain",
        "wanted",
        "size",
        "status",
        "named",
        "class",
        "stage",
        "probability",
        "top",
        "top_probability",
        "lowest_rmse",
        "heldout_winner",
        "plain_bic",
        "closure",
        "closure_low",
        "closure_high",
        "closure_actual",
        "left",
        "gains",
        "samples",
        "together",
    ];
    let rows = cases.iter().map(|c| {
        let figure = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4}"));
        let name = |x: Option<&str>| x.unwrap_or_default().to_owned();
        vec![
            c.id.to_string(),
            c.kind.name().to_owned(),
            c.system.to_string(),
            c.truth.join("+"),
            c.law.to_owned(),
            c.plain.to_string(),
            c.wanted.to_string(),
            format!("{:.3}", c.size),
            c.reply.status.to_owned(),
            c.reply.effects.join("+"),
            c.reply.class.join("|"),
            name(c.reply.stage),
            format!("{:.4}", c.reply.probability),
            c.reply.top.0.to_owned(),
            format!("{:.4}", c.reply.top.1),
            name(c.baseline.lowest_rmse),
            name(c.baseline.heldout_winner),
            name(c.baseline.plain_bic),
            figure(c.closure.map(|x| x.estimate)),
            figure(c.closure.map(|x| x.ci90[0])),
            figure(c.closure.map(|x| x.ci90[1])),
            figure(c.closure.map(|x| x.actual)),
            format!("{:.0}", c.evidence.left),
            c.evidence.gains(),
            c.evidence.samples.to_string(),
            together(c),
        ]
    });
    csv(&header, rows)
}

/// `effects:gain over the best single one:left by both:left by the single one` of the best pair.
fn together(case: &Case) -> String {
    let Some(pair) = &case.evidence.together else { return String::new() };
    format!("{}:{:.0}:{:.0}:{:.0}", pair.effects.join("+"), pair.gain, pair.left, pair.left_by_single)
}

pub(super) fn accuracy(rows: &[AccuracyRow]) -> String {
    let header = ["effect", "wanted", "plain", "reached", "rigs", "exact", "class", "none", "unexplained"];
    let rows = rows.iter().map(|r| {
        vec![
            r.effect.to_owned(),
            r.wanted.to_string(),
            r.plain.to_string(),
            format!("{:.3}", r.reached),
            r.exact.of.to_string(),
            share(r.exact),
            share(r.class),
            share(r.none),
            share(r.unexplained),
        ]
    });
    csv(&header, rows)
}

pub(super) fn calibration(table: &Calibration) -> String {
    let rows =
        table.bins.iter().map(|b| vec![format!("{:.4}", b.claimed), share(b.held), b.held.of.to_string()]);
    csv(&["claimed", "held", "rigs"], rows)
}

pub(super) fn abstention(rows: &[AbstentionRow]) -> String {
    let rows = rows
        .iter()
        .map(|r| vec![r.threshold.to_string(), share(r.answered), share(r.right), r.right.of.to_string()]);
    csv(&["threshold", "answered", "right", "rigs"], rows)
}

pub(super) fn closure(rows: &[ClosureRow]) -> String {
    let header = ["effect", "rigs", "stated", "actual", "oracle", "coverage", "error"];
    let rows = rows.iter().map(|r| {
        vec![
            r.effect.to_owned(),
            r.rigs.to_string(),
            format!("{:.4}", r.stated),
            format!("{:.4}", r.actual),
            "1".to_owned(),
            share(r.coverage),
            format!("{:.4}", r.error),
        ]
    });
    csv(&header, rows)
}

pub(super) fn places(rows: &[PlaceRow]) -> String {
    let rows = rows.iter().map(|r| {
        let figure = |x: f64| format!("{x:.4}");
        vec![r.axis.to_owned(), figure(r.precision), figure(r.recall), figure(r.f1), r.cells.to_string()]
    });
    csv(&["axis", "precision", "recall", "f1", "cells"], rows)
}

pub(super) fn baselines(rows: &[BaselineRow]) -> String {
    let rows = rows.iter().map(|r| {
        vec![
            r.rule.to_owned(),
            share(r.exact),
            share(r.false_alarm),
            share(r.outside_named),
            share(r.precision),
        ]
    });
    csv(&["rule", "exact", "false_alarm", "outside_named", "precision"], rows)
}
