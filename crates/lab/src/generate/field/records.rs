//! The records of a dataset in the field.

use super::drive::Drive;
use crate::generate::dataset::{Passage, lead_in, one_after_the_other};
use crate::generate::machine::Machine;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::ops::Range;
use switchback_model::rig::{Role, Usage};

/// Records of a dataset, at most.
const MOST: usize = 4;
/// What of a single record is held out, at its end.
const HELD_OUT: f64 = 0.3;
/// What most of the input takes there and back, in slowest time constants.
const PERIOD: Range<f64> = 6.0..10.0;
/// Length of a record in periods, and its bounds in samples.
const PERIODS: Range<f64> = 15.0..40.0;
const SAMPLES: (f64, f64) = (800.0, 4000.0);
/// The share of the working interval that records after the first use.
const REACH: Range<f64> = 0.6..1.0;
/// Nothing comes closer to the ends of the working interval, in its widths.
const MARGIN: f64 = 0.01;
/// Time constants that a record's input has run before anybody records it: the output need not have settled.
const RUN_IN: f64 = 2.0;

/// Draws one to four records; one is held out, or the last part of a single one.
pub(super) fn dataset(machine: &Machine, time_constant: f64, rng: &mut ChaCha8Rng) -> Vec<Passage> {
    let count = rng.random_range(1..=MOST);
    // The first record visits the whole interval: it is one of those that are fitted, and what is held out asks for no more.
    let held_out = if count > 1 { rng.random_range(1..count) } else { MOST };
    let record = |index: usize| {
        let usage = if index == held_out { Usage::Holdout } else { Usage::Fit };
        let drives = if index == 0 { &Drive::THOROUGH } else { Drive::ALL.as_slice() };
        let drive = drives[rng.random_range(0..drives.len())];
        let period = time_constant * rng.random_range(PERIOD);
        let samples = (period * rng.random_range(PERIODS)).clamp(SAMPLES.0, SAMPLES.1) as usize;
        let run_in = (RUN_IN * time_constant).ceil() as usize;
        let reach = if index == 0 { 1.0 } else { rng.random_range(REACH) };
        let low = rng.random_range(0.0..=1.0 - reach);
        let place = |z: f64| {
            let share = MARGIN + (1.0 - 2.0 * MARGIN) * (low + reach * z);
            machine.interval.low() + machine.interval.width() * share
        };
        let mut before: Vec<f64> =
            drive.samples(run_in + samples, period, rng).into_iter().map(place).collect();
        let recorded = before.split_off(run_in);
        let mut lead = lead_in(machine.interval, before[0], 0);
        lead.extend(before);
        let name = format!("{}-{}", drive.name(), index + 1);
        Passage::of(index, name, (Role::Free, usage), (lead, recorded))
    };
    let passages = one_after_the_other((0..count).map(record).collect());
    match <[Passage; 1]>::try_from(passages) {
        Ok([single]) => {
            let kept = ((1.0 - HELD_OUT) * (single.v.len() - single.lead) as f64).round() as usize;
            single.parted(kept).into()
        }
        Err(several) => several,
    }
}
