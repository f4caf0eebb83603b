//! Drawing a training rig.

use super::cause::{Cause, PutIn, nominal};
use super::family::Family;
use super::made;
use super::measured::MeasuredBases;
use super::random::weighted;
use super::reidentification::{Reidentification, derivatives};
use super::setup::{Setup, Signals};
use super::training_rig::{TrainingRig, TrainingTruth};
use crate::examination::scramble;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;

/// How often each family is drawn, in the order of [`Family::ALL`]: half of all on measured bases.
const FAMILIES: [f64; 5] = [0.14, 0.10, 0.26, 0.25, 0.25];
/// The same where there are none.
const MADE: [f64; 3] = [0.28, 0.20, 0.52];
/// Machines tried until one shows the cause at a size within a factor of 1.4, and until there is any at all.
const ATTEMPTS: u64 = 6;
const MOST_ATTEMPTS: u64 = 16;
const CLOSE: f64 = 0.34;
/// What limits the size of many effects is the noise: each further machine is drawn so much quieter.
const QUIETER: f64 = 0.4;

/// The training rig of a number in the population of a seed; it depends on nothing else but the bases.
///
/// None where no machine that was tried gives finite records.
pub fn draw(seed: u64, index: u64, bases: &MeasuredBases) -> Option<TrainingRig> {
    draw_if(|_| true, (seed, index), bases)
}

/// The same where a model is given, else none.
pub fn draw_given(seed: u64, index: u64, bases: &MeasuredBases) -> Option<TrainingRig> {
    draw_if(|is_given| is_given, (seed, index), bases)
}

fn draw_if(
    wanted: impl Fn(bool) -> bool,
    (seed, index): (u64, u64),
    bases: &MeasuredBases,
) -> Option<TrainingRig> {
    let root = scramble(seed, index);
    let mut rng = stream(root, Purpose::Cause);
    let weights: &[f64] = if bases.is_empty() { &MADE } else { &FAMILIES };
    let family = Family::ALL[weighted(&mut rng, weights)];
    let cause = Cause::draw(family, &mut rng);
    let is_given = rng.random_bool(0.5);
    if !wanted(is_given) {
        return None;
    }
    let mut best: Option<Candidate> = None;
    for attempt in 0..MOST_ATTEMPTS {
        if attempt >= ATTEMPTS && best.is_some() {
            break;
        }
        let Some(candidate) = Candidate::new(
            family,
            &cause,
            (scramble(root, attempt + 1), QUIETER.powi(attempt.min(5) as i32), bases),
        ) else {
            continue;
        };
        let is_close = candidate.put_in.miss < CLOSE;
        if best.as_ref().is_none_or(|other| candidate.put_in.miss < other.put_in.miss) {
            best = Some(candidate);
        }
        if is_close {
            break;
        }
    }
    best?.rig(&cause, is_given)
}

/// A machine with the cause put in.
struct Candidate {
    setup: Setup,
    before: Vec<Signals>,
    anew: Reidentification,
    put_in: PutIn,
}

impl Candidate {
    fn new(
        family: Family,
        cause: &Cause,
        (seed, quieter, bases): (u64, f64, &MeasuredBases),
    ) -> Option<Self> {
        let spared = cause.names();
        let setup = match family {
            Family::Laboratory => made::laboratory(seed),
            Family::Field => made::field(seed, &spared),
            Family::Wide => made::wide(seed, &spared, quieter)?,
            Family::Measured | Family::Resampled => bases.setup(family, seed, quieter)?,
        };
        let before = setup.signals(&[]);
        let anew = Reidentification::new(&setup)?;
        let put_in = cause.put_into(&setup, &before, &anew)?;
        Some(Self { setup, before, anew, put_in })
    }

    fn rig(self, cause: &Cause, is_given: bool) -> Option<TrainingRig> {
        let predicted = is_given.then(|| self.predictions());
        let Self { setup, before, put_in, .. } = self;
        let rig = setup.rig(&put_in.signals, predicted).ok()?;
        let before = setup.rig(&before, None).ok()?;
        let truth = TrainingTruth {
            kind: cause.kind,
            effects: put_in.effects,
            size: put_in.size,
            family: setup.family,
            base: setup.base,
            own: setup.own.iter().map(|active| active.law.effect()).collect(),
            order: setup.order,
            borders: setup.borders,
            noise: setup.noise,
        };
        Some(TrainingRig { rig, before, is_given, truth })
    }

    /// What a model identified before the cause came predicts: the nominal system as the records without the cause would have it, to first
    /// order. Of measured records the model that was identified from the whole rig.
    fn predictions(&self) -> Vec<Vec<f64>> {
        let is_measured = self.setup.family == Family::Measured;
        let change =
            (!is_measured).then(|| self.anew.parameters(&Setup::change(&nominal(&self.setup), &self.before)));
        let one = |(run, signals): (&super::setup::Run, &Signals)| {
            let mut y = run.nominal.clone();
            if let Some(moved) = &signals.moved {
                y.iter_mut().zip(moved).for_each(|(y, m)| *y += m);
            }
            if let Some(change) = &change {
                let columns = derivatives(&self.setup.machine, self.setup.order, &run.passage.v);
                for (column, step) in columns.iter().zip(change.iter()) {
                    y.iter_mut().zip(run.passage.recorded(column)).for_each(|(y, c)| *y += step * c);
                }
            }
            y
        };
        self.setup.runs.iter().zip(&self.put_in.signals).map(one).collect()
    }
}
