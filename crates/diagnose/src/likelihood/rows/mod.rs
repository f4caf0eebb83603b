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
use crate::model::augmented::{BorderColumn, Clock, Resting, Slow};
use crate::model::borders::Grid;
use crate::model::effect_terms::Operator;
use crate::records::dataset::{Dataset, ScaledRecord};
use crate::records::motion::Motion;

/// The value of a clock at a sample.
pub(crate) fn clock(clock: Clock, dataset: &Dataset, scaled: &ScaledRecord, t: usize, path: f64) -> f64 {
    if scaled.standing {
        let records = dataset.scaled_records.iter().filter(|scaled| !scaled.standing).count();
        return at_the_end(clock, dataset.total, records);
    }
    match clock {
        Clock::Dataset => (scaled.clock + t) as f64 / dataset.total as f64,
        Clock::Samples => (scaled.clock + t) as f64,
        Clock::Record => t as f64 / scaled.v.len() as f64,
        Clock::Pauses => scaled.before as f64 / dataset.scaled_records.len() as f64,
        Clock::Travel => (scaled.travelled + path) / dataset.travel,
    }
}

/// The value of a clock where a dataset of so many samples and records, or its last record, ends.
pub(crate) fn at_the_end(clock: Clock, samples: usize, records: usize) -> f64 {
    let records = records.max(1);
    match clock {
        Clock::Dataset | Clock::Record | Clock::Travel => 1.0,
        Clock::Samples => samples as f64,
        Clock::Pauses => (records - 1) as f64 / records as f64,
    }
}

/// The rows of one record: first the border values of `grid`, then the operator's columns.
pub(crate) fn rows(
    (dataset, number, scaled): (&Dataset, usize, &ScaledRecord),
    moves: &[Motion],
    grid: &Grid,
    operator: &Operator<'_>,
) -> Rows {
    let Operator { jitter, transition, wear, widening, relaxation, columns: added, gain } = *operator;
    let columns = grid.len() as u32;
    let mut out = Rows::with_capacity(scaled.v.len());
    let mut point = WorkingPoint::new((grid, added.len()), transition, scaled.v[0], dataset.criterion);
    let begins_here = |c: &BorderColumn| matches!(c, BorderColumn::Start { scaled } if *scaled == number);
    if let Some(start) = added.iter().position(begins_here) {
        point.terms.push((columns + start as u32, 1.0));
    }
    let mut stopped: Option<usize> = None;
    let mut fixed: Vec<f64> = vec![0.0; added.len()];
    for (t, m) in moves.iter().enumerate() {
        let slow = |s: &Slow| s.at(clock(s.clock, dataset, scaled, t, m.path));
        if m.reversal {
            point.turn(m);
        }
        if jitter > 0.0 {
            point.jittered(ascending(m.step, jitter), scaled.v[t]);
        } else if m.moves {
            let widening = widening.map_or(0.0, |widening| widening.at(m.step.abs()));
            let narrowing = wear.map_or(0.0, slow) - widening;
            point.step(m, scaled.v[t], narrowing);
            stopped = Some(t);
        } else if let (Some(relaxation), Some(stopped)) = (relaxation, stopped) {
            if stopped + 1 == t {
                point.stop();
            }
            point.relax(scaled.v[stopped], relaxation.after(t - stopped));
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
                    clock(*c, dataset, scaled, t, m.path)
                }
                _ => 0.0,
            };
            fixed[j] = column_value(column, m, s, fixed[j]);
            out.extend(&[(columns + j as u32, fixed[j])], gain);
        }
        out.end_row();
    }
    out
}

fn column_value(column: &BorderColumn, m: &Motion, s: f64, fixed: f64) -> f64 {
    let speed = m.step.abs();
    match *column {
        BorderColumn::Speed { power, scale, while_resting } => match (m.step == 0.0, while_resting) {
            (true, Resting::Held) => fixed,
            (true, Resting::Zero) => 0.0,
            _ => m.branch * (speed / scale).powf(power),
        },
        BorderColumn::LowSpeed { power, scale, while_resting } => match (m.step == 0.0, while_resting) {
            (true, Resting::Held) => fixed,
            (true, Resting::Zero) => m.branch,
            _ => m.branch * (-(speed / scale).powf(power)).exp(),
        },
        BorderColumn::Bristle { power, scale, length } => {
            let aim = m.branch * (-(speed / scale).powf(power)).exp();
            fixed - (aim - fixed) * (-speed / length).exp_m1()
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
        BorderColumn::SideSlow { .. } | BorderColumn::Start { .. } => fixed,
        BorderColumn::BranchSlow { .. } => {
            if m.moves {
                m.branch * s
            } else {
                fixed
            }
        }
    }
}
