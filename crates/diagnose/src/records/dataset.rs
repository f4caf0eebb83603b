//! The records of a rig in dimensionless form: what every fit works on.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_model::rig::{Rig, Role, Usage};

use crate::error::DiagnoseError;
use crate::likelihood::whitener::LEAD;
use crate::model::borders::Grid;
use crate::records::motion::{Begins, Motion, Play, ReversalRule, motions};
use crate::records::passes::Passes;
use crate::records::scale::{Scale, check_plausible};
use crate::records::signal::Signal;

/// One record in dimensionless form.
#[derive(Debug, Clone)]
pub(crate) struct ScaledRecord {
    pub(crate) name: String,
    pub(crate) role: Role,
    pub(crate) usage: Usage,
    /// Input, 0 at the lower end of the working interval and 1 at the upper.
    pub(crate) v: Signal,
    /// Output, zero mean and unit standard deviation over the fit records.
    pub(crate) y: Signal,
    /// Sample of the dataset at which the record starts, counting the records in the order of the file.
    pub(crate) clock: usize,
    /// Records of the dataset before this one.
    pub(crate) before: usize,
    /// Travel of the dataset before the record starts, strokes.
    pub(crate) travelled: f64,
    /// Period of the input in samples, where it repeats exactly.
    pub(crate) period: Option<usize>,
    /// First sample from which residuals are counted.
    pub(crate) from: usize,
    /// How `v` moves, without play.
    pub(crate) moves: Arc<[Motion]>,
    /// Whether it is a record from outside the dataset, on which the dataset's clocks stand at their end.
    pub(crate) standing: bool,
}

impl ScaledRecord {
    pub(crate) fn is_fit(&self) -> bool {
        self.usage == Usage::Fit
    }

    /// The record whose positions act a share of a sample late.
    pub(crate) fn late(&self, share: f64, rule: ReversalRule) -> Self {
        let before = self.v.iter().take(1).chain(&self.v);
        let v: Signal = self.v.iter().zip(before).map(|(now, before)| now + share * (before - now)).collect();
        Self { moves: motions(&v, Play::default(), rule).into(), v, ..self.clone() }
    }

    /// Whether the input is a designed experiment with few levels.
    pub(crate) fn is_pulsed(&self) -> bool {
        self.role != Role::Free
    }
}

/// The records, and the scales that lead back to physical units.
#[derive(Debug, Clone)]
pub(crate) struct Dataset {
    pub(crate) scaled_records: Vec<ScaledRecord>,
    /// Seconds between samples.
    pub(crate) sample_time: f64,
    pub(crate) v_low: f64,
    pub(crate) v_width: f64,
    pub(crate) y_mean: f64,
    pub(crate) y_scale: f64,
    /// Levels that the designed experiments visit, ascending.
    pub(crate) levels: Vec<f64>,
    /// Samples of the whole dataset.
    pub(crate) total: usize,
    /// Travel of the whole dataset, strokes.
    pub(crate) travel: f64,
    /// What counts as a reversal.
    pub(crate) rule: ReversalRule,
    /// What a model is held against.
    pub(crate) criterion: Criterion,
    /// The knots of a model that is known: its `A`, `B` and border values stay, and only what effects add is fitted.
    pub(crate) known_borders: Option<Arc<Grid>>,
    /// Samples by which the input was [led](Self::led_by).
    pub(crate) lead: isize,
    /// Passes over the fit records.
    pub(crate) passes: Passes,
}

/// What a model is held against.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Criterion {
    /// The next sample, given the measured ones before it: efficient where the equation error is what the model says.
    OneStep,
    /// The whole record, given its beginning: the output error of the free run.
    Simulation {
        /// Independent errors per sample: errors of simulation are coloured, and each counts for less than one.
        share: f64,
    },
}

impl Criterion {
    pub(crate) fn simulates(self) -> bool {
        matches!(self, Self::Simulation { .. })
    }

    /// Independent errors per sample.
    pub(crate) fn share(self) -> f64 {
        match self {
            Self::OneStep => 1.0,
            Self::Simulation { share } => share,
        }
    }
}

/// Samples left out at the start of each record, besides those before the input first moves: no candidate's memory
/// reaches further back, so that all are scored on the same samples.
pub(crate) const WARM_UP: usize = 12;

/// Samples left out at the start of each record for a model of some order: whitened errors reach back beyond the order.
pub(crate) fn warm_up(order: usize) -> usize {
    WARM_UP.max(order + LEAD)
}

/// Highest order of a model.
pub(crate) const HIGHEST_ORDER: usize = 20;

/// Positions of the input closer than this are the same, in strokes; and readings, in standard deviations.
pub(crate) const RESOLUTION: f64 = 1e-10;

impl Dataset {
    /// Scales the records of a rig.
    ///
    /// # Errors
    /// [`DiagnoseError`] if nothing is marked for fitting, input or output never move, or a value is none that their sensors can have read.
    pub(crate) fn new(rig: &Rig) -> Result<Self, DiagnoseError> {
        if rig.fit_records().next().is_none() {
            return Err(DiagnoseError::NoFitRecord);
        }
        let Scale { origin: v_low, size: v_width } = Scale::of_input(rig)?;
        let Scale { origin: y_mean, size: y_scale } = Scale::of_output(rig)?;
        check_plausible(rig)?;
        let mut scaled_records = Vec::with_capacity(rig.records.len());
        let mut clock = 0;
        for r in &rig.records {
            let v = Signal::from(dimensionless(r.record.v(), v_low, v_width));
            let y = Signal::from(dimensionless(r.record.y(), y_mean, y_scale));
            let period = period_of(&v);
            scaled_records.push(ScaledRecord {
                name: r.name.clone(),
                role: r.role,
                usage: r.usage,
                from: first_counted(&v, WARM_UP),
                v,
                y,
                clock,
                before: scaled_records.len(),
                travelled: 0.0,
                period,
                moves: Arc::default(),
                standing: false,
            });
            clock += r.record.len();
        }
        let rule = ReversalRule { threshold: reversal_threshold(&scaled_records), ..ReversalRule::default() };
        let mut travel = 0.0;
        for scaled in &mut scaled_records {
            scaled.moves = motions(&scaled.v, Play::default(), rule).into();
            scaled.travelled = travel;
            travel += scaled.moves.last().map_or(0.0, |m| m.path);
        }
        let levels = levels(&scaled_records);
        Ok(Self {
            scaled_records,
            sample_time: rig.sample_time,
            v_low,
            v_width,
            y_mean,
            y_scale,
            levels,
            total: clock,
            travel,
            rule,
            criterion: Criterion::OneStep,
            known_borders: None,
            lead: 0,
            passes: Passes::default(),
        })
    }

    /// The same records for a model whose output follows the input `lead` samples sooner than in the paper: a sampled
    /// input may act within its sample, and a record of the position may trail the force. A negative lead is a delay.
    pub(crate) fn led_by(&self, lead: isize) -> Self {
        let mut sooner = self.clone();
        sooner.lead += lead;
        for scaled in &mut sooner.scaled_records {
            scaled.v = led(&scaled.v, lead).into();
            scaled.moves = motions(&scaled.v, Play::default(), self.rule).into();
        }
        sooner
    }

    /// The same records with branches that begin elsewhere.
    pub(crate) fn with_branches_from(&self, begins: Begins) -> Self {
        let mut other = self.clone();
        other.rule.begins = begins;
        for scaled in &mut other.scaled_records {
            scaled.moves = motions(&scaled.v, Play::default(), other.rule).into();
        }
        other
    }

    /// The same records, models held against another criterion.
    pub(crate) fn judged_by(&self, criterion: Criterion) -> Self {
        Self { criterion, ..self.clone() }
    }

    /// The same records, held against a nominal model that is known, by its knots.
    pub(crate) fn with_nominal_fixed(&self, borders: &Grid) -> Self {
        Self { known_borders: Some(borders.clone().into()), ..self.clone() }
    }

    /// Whether the nominal model is known, and stays.
    pub(crate) fn holds_nominal(&self) -> bool {
        self.known_borders.is_some()
    }

    /// The knots of a model, at the recorded input: known ones where a play has moved them to, others as they are.
    pub(crate) fn placed<'a>(&'a self, grid: &'a Grid, play: Play) -> Cow<'a, Grid> {
        match self.known_borders.as_deref() {
            None => Cow::Borrowed(grid),
            Some(known) if play.is_none() => Cow::Borrowed(known),
            Some(known) => Cow::Owned(known.seen_through(play)),
        }
    }

    /// The same, each record counted from where a model of some order has a past.
    pub(crate) fn counted_for(mut self, order: usize) -> Self {
        let more = warm_up(order) - WARM_UP;
        self.scaled_records
            .iter_mut()
            .for_each(|scaled| scaled.from = (scaled.from + more).min(scaled.v.len()));
        self
    }

    /// Whether any fit record is a designed experiment.
    pub(crate) fn is_designed(&self) -> bool {
        self.fit().any(ScaledRecord::is_pulsed)
    }

    pub(crate) fn fit(&self) -> impl Iterator<Item = &ScaledRecord> {
        self.scaled_records.iter().filter(|t| t.is_fit())
    }

    /// Samples on which residuals of the fit records are counted.
    pub(crate) fn fit_samples(&self) -> usize {
        self.fit().map(|t| t.v.len() - t.from).sum()
    }
}

/// A signal in shares of a scale from an origin; rounded, so that a difference of rounding errors is no move and no reversal, and
/// readings at the end of a sensor's range are equal.
pub(crate) fn dimensionless(signal: &[f64], origin: f64, scale: f64) -> Vec<f64> {
    signal.iter().map(|x| ((x - origin) / scale / RESOLUTION).round() * RESOLUTION).collect()
}

/// The first counted sample of an input, so many samples after it first moves.
pub(crate) fn first_counted(v: &[f64], warm_up: usize) -> usize {
    let moves = v.windows(2).position(|w| w[0] != w[1]).map_or(v.len(), |t| t + 1);
    (moves + warm_up).min(v.len())
}

/// An input so many samples sooner, or later where that is negative; before its beginning and after its end it rests.
pub(crate) fn led(v: &[f64], lead: isize) -> Vec<f64> {
    let last = v.len() - 1;
    (0..=last).map(|t| v[t.saturating_add_signed(lead).min(last)]).collect()
}

/// The period of a signal that repeats exactly at least three times after a start-up, at most a third of its length.
fn period_of(v: &[f64]) -> Option<usize> {
    let tail = &v[v.len().min(2)..];
    let longest = tail.len() / 3;
    if tail.windows(2).filter(|w| w[0] != w[1]).count() < 6 {
        return None;
    }
    (3..=longest).find(|&p| (p..tail.len()).all(|t| tail[t] == tail[t - p]))
}

/// Levels of the designed experiments.
fn levels(scaled_records: &[ScaledRecord]) -> Vec<f64> {
    let mut all: Vec<f64> = scaled_records
        .iter()
        .filter(|t| t.is_fit() && t.is_pulsed())
        .flat_map(|t| t.v.iter().copied())
        .collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    if all.len() > 40 { Vec::new() } else { all }
}

/// Noise on `v` fakes reversals: where most reversals of the fit records are tiny against the stroke, the smallest
/// move that counts is put above them.
fn reversal_threshold(scaled_records: &[ScaledRecord]) -> f64 {
    let mut swings = Vec::new();
    for scaled in scaled_records.iter().filter(|t| t.is_fit()) {
        let mut turn = scaled.v[0];
        let mut direction = 0.0;
        for w in scaled.v.windows(2) {
            let step = w[1] - w[0];
            if step * direction < 0.0 {
                swings.push((w[0] - turn).abs());
                turn = w[0];
            }
            if step != 0.0 {
                direction = step.signum();
            }
        }
    }
    let small: Vec<f64> = swings.iter().copied().filter(|&s| s < 0.01).collect();
    if swings.len() < 10 || small.len() * 5 < swings.len() {
        return 0.0;
    }
    let mut small = small;
    small.sort_by(f64::total_cmp);
    2.0 * small[(small.len() * 9 / 10).min(small.len() - 1)]
}
