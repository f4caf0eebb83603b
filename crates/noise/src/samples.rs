//! The noise itself, for engines that simulate sample by sample.

use super::plan::{NoisePlan, NoisePlanError};
use super::white::{BLOCK, StreamId, WhiteNoise};
use super::width::Width;
use switchback_model::linear::filter;

/// The noise of one replicate, from the rest before the burn-in on.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseSamples {
    /// Unit white noise: `w[burn_in + t]` is w(t).
    pub w: Vec<f64>,
    /// Filtered noise: `e[burn_in + t]` is e(t).
    pub e: Vec<f64>,
    /// Index of `t = 0`.
    pub burn_in: usize,
}

/// The first `count` samples of `w`, the unit white noise of one stream.
pub fn white_samples(stream: StreamId, count: usize) -> Vec<f64> {
    let mut noise = WhiteNoise::new(Width::SINGLE, stream);
    let mut w = vec![0.0; count.next_multiple_of(BLOCK)];
    for block in w.chunks_exact_mut(BLOCK) {
        noise.fill(block);
    }
    w.truncate(count);
    w
}

/// The very noise that [`NoisePass`](super::NoisePass) sums over for this replicate: the burn-in and `count`
/// samples from `t = 0` on.
///
/// `w` is the same to the bit, `e` to rounding. The checkpoints, lags and periods of the plan play no part.
///
/// # Errors
/// If the plan is not valid.
pub fn samples(plan: &NoisePlan, stream: StreamId, count: usize) -> Result<NoiseSamples, NoisePlanError> {
    plan.validate()?;
    let w = white_samples(stream, plan.burn_in + count);
    let e = filter(&plan.ar, &plan.ma, &w, &w, 0.0, 0.0);
    Ok(NoiseSamples { w, e, burn_in: plan.burn_in })
}
