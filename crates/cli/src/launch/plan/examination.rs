//! What an examination costs.

use super::clock::{most_memory, processor, timed};
use super::{Costs, Ingredient, Plan, Share};
use switchback_io::output::sha256;
use switchback_lab::examination::{Examination, Judged, case_lines, key_file};
use switchback_report::examination::{Drawn, report};

/// Rigs that are judged, and seconds of processor time after which no other is begun.
const ENOUGH: (usize, f64) = (24, 60.0);

/// Makes and judges the first rigs of an examination, which come in random order, and makes a report of them.
///
/// # Errors
/// A rig that cannot be made, or a figure that cannot be drawn.
pub fn measure<E: Drawn>(examination: &E) -> miette::Result<Plan<'static>> {
    let tickets = examination.design()?;
    let rigs = tickets.len();
    let start = processor();
    let (mut sealed, mut cases, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for ticket in tickets.into_iter().take(ENOUGH.0) {
        let (judged, seconds) = timed(|| {
            let rig = examination.seal(vec![ticket], "", &|| ())?.pop();
            let case = rig.as_ref().map(|rig| examination.judge(rig)).transpose()?;
            miette::Result::<_>::Ok(rig.zip(case))
        });
        times.push(seconds);
        if let Some((rig, case)) = judged? {
            sealed.push(rig);
            cases.push(case);
        }
        if times.iter().sum::<f64>() > ENOUGH.1 && times.len() > 2 {
            break;
        }
    }
    let memory = most_memory().unwrap_or(0.0);
    let keys = key_file(&sealed);
    let (text, making) = timed(|| {
        let text = case_lines(&cases) + &keys + &E::Case::answers(&cases);
        sha256(&text);
        text
    });
    let (made, report) = timed(|| report(examination, &sha256(&keys), &cases));
    made?;
    let judged = times.len() as f64;
    let per_piece = times.iter().sum::<f64>() / judged;
    let variance = times.iter().map(|time| (time - per_piece).powi(2)).sum::<f64>() / (judged - 1.0).max(1.0);
    let bytes_of_a_rig = text.len() as f64 / judged;
    let per_byte = making / text.len() as f64;
    let costs = Costs {
        piece: "rig",
        pieces: rigs,
        start,
        per_piece,
        per_piece_error: (variance / judged).sqrt(),
        of_a_piece: vec![Ingredient { name: "rig made and judged", count: 1.0, seconds: per_piece }],
        per_byte_out: per_byte,
        per_byte_in: per_byte,
        per_byte_added: 0.0,
        report,
        memory,
    };
    let shares = move |tasks: usize| {
        let of = |k: usize| (rigs + tasks - 1 - k) / tasks;
        let share = |pieces: usize| Share { pieces, bytes: pieces as f64 * bytes_of_a_rig };
        (0..tasks).map(|k| share(of(k))).collect()
    };
    Ok(Plan { costs, shares: Box::new(shares), whole: rigs as f64 * bytes_of_a_rig })
}
