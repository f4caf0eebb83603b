//! Border features: `u(t)` as a sparse combination of border values; and disturbance columns.

mod equation;
mod sensitivity;
mod sparse_rows;
mod working_point;

pub(crate) use self::equation::{EquationColumns, equation_columns};
use self::sensitivity::ascending;
pub(crate) use self::sensitivity::sensitivity_rows;
pub(crate) use self::sparse_rows::Rows;
use self::working_point::WorkingPoint;
use crate::model::assembly::{BorderColumn, Clock, Resting, Slow};
use crate::model::borders::Grid;
use crate::model::parts::Operator;
use crate::records::campaign::{Campaign, Track};
use crate::records::motion::Motion;

/// The value of a clock at a sample.
pub(crate) fn clock(clock: Clock, campaign: &Campaign, track: &Track, t: usize, path: f64) -> f64 {
    if track.standing {
        let records = campaign.tracks.iter().filter(|track| !track.standing).count();
        return at_the_end(clock, campaign.total, records);
    }
    match clock {
        Clock::Campaign => (track.clock + t) as f64 / campaign.total as f64,
        Clock::Samples => (track.clock + t) as f64,
        Clock::Record => t as f64 / track.v.len() as f64,
        Clock::Pauses => track.before as f64 / campaign.tracks.len() as f64,
        Clock::Travel => (track.travelled + path) / campaign.travel,
    }
}

/// The value of a clock where a campaign of so many samples and records, or its last record, ends.
pub(crate) fn at_the_end(clock: Clock, samples: usize, records: usize) -> f64 {
    let records = records.max(1);
    match clock {
        Clock::Campaign | Clock::Record | Clock::Travel => 1.0,
        Clock::Samples => samples as f64,
        Clock::Pauses => (records - 1) as f64 / records as f64,
    }
}

/// The rows of one track: first the border values of `grid`, then the operator's columns.
pub(crate) fn rows(
    (campaign, number, track): (&Campaign, usize, &Track),
    moves: &[Motion],
    grid: &Grid,
    operator: &Operator<'_>,
) -> Rows {
    let Operator { jitter, transition, wear, widening, relaxation, columns: added, gain } = *operator;
    let columns = grid.len() as u32;
    let mut out = Rows::with_capacity(track.v.len());
    let mut point = WorkingPoint::new((grid, added.len()), transition, track.v[0], campaign.criterion);
    let begins_here = |c: &BorderColumn| matches!(c, BorderColumn::Start { track } if *track == number);
    if let Some(start) = added.iter().position(begins_here) {
        point.terms.push((columns + start as u32, 1.0));
    }
    let mut stopped: Option<usize> = None;
    let mut held: Vec<f64> = vec![0.0; added.len()];
    for (t, m) in moves.iter().enumerate() {
        let slow = |s: &Slow| s.at(clock(s.clock, campaign, track, t, m.path));
        if m.reversal {
            point.turn(m);
        }
        if jitter > 0.0 {
            point.jittered(ascending(m.step, jitter), track.v[t]);
        } else if m.moves {
            let widening = widening.map_or(0.0, |widening| widening.at(m.step.abs()));
            let narrowing = wear.map_or(0.0, slow) - widening;
            point.step(m, track.v[t], narrowing);
            stopped = Some(t);
        } else if let (Some(relaxation), Some(stopped)) = (relaxation, stopped) {
            if stopped + 1 == t {
                point.stop();
            }
            point.relax(track.v[stopped], relaxation.after(t - stopped));
        }
        let gain = 1.0 + gain.map_or(0.0, slow);
        out.extend(&point.terms, gain);
        for (j, column) in added.iter().enumerate() {
            if let BorderColumn::Start { .. } = column {
                // Part of the working point.
                continue;
            }
            let s = match column {
                BorderColumn::BranchSlow { clock: c } | BorderColumn::SideSlow { clock: c, .. } => {
                    clock(*c, campaign, track, t, m.path)
                }
                _ => 0.0,
            };
            held[j] = column_value(column, m, s, held[j]);
            out.extend(&[(columns + j as u32, held[j])], gain);
        }
        out.end_row();
    }
    out
}

fn column_value(column: &BorderColumn, m: &Motion, s: f64, held: f64) -> f64 {
    let speed = m.step.abs();
    match *column {
        BorderColumn::Speed { power, scale, while_resting } => match (m.step == 0.0, while_resting) {
            (true, Resting::Held) => held,
            (true, Resting::Zero) => 0.0,
            _ => m.branch * (speed / scale).powf(power),
        },
        BorderColumn::LowSpeed { power, scale, while_resting } => match (m.step == 0.0, while_resting) {
            (true, Resting::Held) => held,
            (true, Resting::Zero) => m.branch,
            _ => m.branch * (-(speed / scale).powf(power)).exp(),
        },
        BorderColumn::Bristle { power, scale, length } => {
            let aim = m.branch * (-(speed / scale).powf(power)).exp();
            held - (aim - held) * (-speed / length).exp_m1()
        }
        BorderColumn::RestingLog { scale } => m.branch * (m.rest as f64 / scale).ln_1p(),
        BorderColumn::ReversalLog { scale } => m.branch * (m.since as f64 / scale).ln_1p(),
        BorderColumn::RestingRise { scale } => -m.branch * (-(m.rest as f64) / scale).exp_m1(),
        BorderColumn::SideSlow { branch, .. } if m.moves => {
            if m.branch == branch {
                s
            } else {
                0.0
            }
        }
        BorderColumn::SideSlow { .. } | BorderColumn::Start { .. } => held,
        BorderColumn::BranchSlow { .. } => {
            if m.moves {
                m.branch * s
            } else {
                held
            }
        }
    }
}
