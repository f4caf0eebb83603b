//! Border features: `u(t)` as a sparse combination of border values; and disturbance columns.

mod equation;
mod sensitivity;
mod working_point;

pub(crate) use self::equation::{EquationColumns, equation_columns};
use self::sensitivity::ascending;
pub(crate) use self::sensitivity::sensitivity_rows;
use self::working_point::WorkingPoint;
use crate::model::assembly::{BorderColumn, Clock, Resting, Slow};
use crate::model::borders::Grid;
use crate::model::parts::Operator;
use crate::records::campaign::{Campaign, Track};
use crate::records::motion::Motion;

/// Sparse rows, one a sample: indices and values.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    start: Vec<u32>,
    terms: Vec<(u32, f64)>,
}

impl Rows {
    pub(crate) fn with_capacity(samples: usize) -> Self {
        let mut start = Vec::with_capacity(samples + 1);
        start.push(0);
        Self { start, terms: Vec::with_capacity(2 * samples) }
    }

    pub(crate) fn push(&mut self, row: &[(u32, f64)], scale: f64) {
        self.extend(row, scale);
        self.end_row();
    }

    /// Adds terms to the row that is being written.
    fn extend(&mut self, terms: &[(u32, f64)], scale: f64) {
        for &(i, x) in terms {
            if x != 0.0 {
                self.terms.push((i, x * scale));
            }
        }
    }

    fn end_row(&mut self) {
        self.start.push(self.terms.len() as u32);
    }

    /// Non-zeros of row `t`.
    #[inline]
    pub(crate) fn row(&self, t: usize) -> &[(u32, f64)] {
        &self.terms[self.start[t] as usize..self.start[t + 1] as usize]
    }

    /// Whether each of `count` columns has a non-zero.
    pub(crate) fn touched(&self, count: usize) -> Vec<bool> {
        let mut touched = vec![false; count];
        self.terms.iter().for_each(|&(i, _)| touched[i as usize] = true);
        touched
    }

    /// `u(t)` for border values (and column coefficients) `f`.
    #[inline]
    pub(crate) fn dot(&self, t: usize, f: &[f64]) -> f64 {
        self.row(t).iter().map(|&(i, x)| x * f[i as usize]).sum()
    }

    /// `u` for border values (and column coefficients) `f`.
    pub(crate) fn times(&self, f: &[f64]) -> Vec<f64> {
        let mut rest = &self.terms[..];
        let of_row = |w: &[u32]| {
            let (row, later) = rest.split_at((w[1] - w[0]) as usize);
            rest = later;
            row.iter().map(|&(i, x)| x * f[i as usize]).sum()
        };
        self.start.windows(2).map(of_row).collect()
    }
}

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
