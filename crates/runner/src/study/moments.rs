//! The noise of one replicate, as a world needs it.

use super::world::World;
use std::ops::Range;
use switchback_estimator::simulation::NoiseMoments;
use switchback_estimator::simulation::noise::{NoisePass, NoiseRecord, Width};

/// Moments of one replicate: for both experiments, by number of samples and period; means of the step noise by number of samples.
#[derive(Debug, Clone, Default)]
pub(super) struct ReplicateNoise {
    pulses: [Vec<Vec<NoiseMoments>>; 2],
    steps: [Vec<f64>; 2],
}

impl ReplicateNoise {
    /// The moments of both experiments.
    pub(super) fn pulses(&self, checkpoint: usize, period: usize) -> [&NoiseMoments; 2] {
        [0, 1].map(|k| &self.pulses[k][checkpoint][period])
    }

    /// The mean noise in both step experiments; zero where none is run.
    pub(super) fn step_means(&self, checkpoint: usize) -> [f64; 2] {
        [0, 1].map(|k| self.steps[k].get(checkpoint).copied().unwrap_or(0.0))
    }
}

/// Draws the noise of a run of replicates, lanes abreast.
pub(super) fn draw(world: &World, seed: u64, replicates: Range<u32>) -> Vec<ReplicateNoise> {
    let mut noise = vec![ReplicateNoise::default(); replicates.len()];
    let start = replicates.start;
    let mut pulses =
        NoisePass::new(world.pulses.clone(), Width::detect()).expect("a world's noise plan is valid");
    for k in 0..2 {
        pulses.run(seed, world.stream + k as u32, replicates.clone(), |r, record| {
            noise[(r - start) as usize].pulses[k] = moments(record);
        });
    }
    if let Some(plan) = &world.steps {
        let mut steps = NoisePass::new(plan.clone(), Width::detect()).expect("a world's noise plan is valid");
        for k in 0..2 {
            steps.run(seed, world.stream + 2 + k as u32, replicates.clone(), |r, record| {
                noise[(r - start) as usize].steps[k] =
                    record.checkpoints.iter().map(|c| c.folds[0][0] / c.samples as f64).collect();
            });
        }
    }
    noise
}

fn moments(record: &NoiseRecord) -> Vec<Vec<NoiseMoments>> {
    record
        .checkpoints
        .iter()
        .map(|c| (0..c.folds.len()).map(|k| NoiseMoments::from_checkpoint(&record.head, c, k)).collect())
        .collect()
}
