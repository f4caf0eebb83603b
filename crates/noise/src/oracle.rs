//! The pass, done slowly and obviously.

use nalgebra::DMatrix;

use super::plan::{NoisePlan, NoisePlanError};
use super::record::{Checkpoint, NoiseRecord};
use super::samples::samples;
use super::white::StreamId;

/// The record of one replicate, from its whole noise and by the definitions of the sums.
///
/// # Errors
/// If the plan is not valid.
pub(crate) fn record_by_definition(
    plan: &NoisePlan,
    stream: StreamId,
) -> Result<NoiseRecord, NoisePlanError> {
    let longest = plan.checkpoints.iter().copied().max().unwrap_or(0);
    let noise = samples(plan, stream, longest)?;
    let e = |t: isize| match plan.burn_in.checked_add_signed(t) {
        Some(index) => noise.e[index],
        None => 0.0,
    };
    let n = plan.lags as isize;
    let edge = |end: isize| (end - n..end).map(e).collect::<Vec<_>>();
    let checkpoint = |&samples: &usize| {
        let times = || 0..samples as isize;
        Checkpoint {
            samples,
            lag_products: DMatrix::from_fn(plan.lags + 1, plan.lags + 1, |i, l| {
                times().map(|t| e(t - i as isize) * e(t - l as isize)).sum()
            }),
            folds: plan
                .periods
                .iter()
                .map(|&period| {
                    (0..period).map(|p| (p..samples).step_by(period).map(|t| e(t as isize)).sum()).collect()
                })
                .collect(),
            tail: edge(samples as isize),
        }
    };
    Ok(NoiseRecord { head: edge(0), checkpoints: plan.checkpoints.iter().map(checkpoint).collect() })
}
