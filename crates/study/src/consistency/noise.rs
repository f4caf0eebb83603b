//! The noise of replicates that cells share: one by one, and eight at once.

use std::ops::Range;
use switchback_identify::pulse::lanes::{LANES, Lane};
use switchback_identify::simulation::{Grouping, LaneGroupedNoise, LaneMoments, NoiseMoments};
use switchback_noise::{MeanNoise, NoisePass, NoisePlan, NoiseRecord, Width};

/// Streams of a noise group: descendant, ascendant, and the two step experiments.
pub(super) const STREAMS: u32 = 4;

/// What one pass over the noise of a replicate draws and records.
#[derive(Debug, Clone)]
pub(super) struct NoiseSource {
    /// First of its [`STREAMS`] noise streams.
    pub(super) stream: u32,
    /// What to record of the pulse experiments' noise.
    pub(super) pulses: NoisePlan,
    /// Order `n` of the regressions: lags beyond it are recorded for what the folds leave.
    pub(super) order: usize,
    /// The mean noise in a step experiment; `None` where no method asks for it.
    pub(super) steps: Option<MeanNoise>,
    /// Whether any method looks at the descendant, at the ascendant experiment.
    pub(super) experiments: [bool; 2],
    /// How samples are sorted into groups, by number of samples and period.
    pub(super) groupings: Vec<Vec<Grouping>>,
}

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

/// Draws the noise of a run of replicates, lanes at once.
pub(super) fn draw(source: &NoiseSource, seed: u64, replicates: Range<u32>) -> Vec<ReplicateNoise> {
    let mut noise = vec![ReplicateNoise::default(); replicates.len()];
    let start = replicates.start;
    let mut pulses =
        NoisePass::new(source.pulses.clone(), Width::detect()).expect("a group's noise plan is valid");
    for k in 0..2 {
        pulses.run(seed, source.stream + k as u32, replicates.clone(), |r, record| {
            noise[(r - start) as usize].pulses[k] = moments(source.order, record);
        });
    }
    for k in 0..2 {
        draw_steps(source, k, seed, replicates.clone(), |r, means| {
            noise[(r - start) as usize].steps[k] = means.to_vec();
        });
    }
    noise
}

/// Visits the mean noise of every replicate in step experiment `k`, one a number of samples; nothing where no method asks for it.
fn draw_steps(
    source: &NoiseSource,
    k: usize,
    seed: u64,
    replicates: Range<u32>,
    visit: impl FnMut(u32, &[f64]),
) {
    if let Some(steps) = &source.steps {
        steps.draw(Width::detect(), seed, source.stream + 2 + k as u32, replicates, visit);
    }
}

fn moments(order: usize, record: &NoiseRecord) -> Vec<Vec<NoiseMoments>> {
    record
        .checkpoints
        .iter()
        .map(|c| {
            (0..c.folds.len()).map(|k| NoiseMoments::from_checkpoint(order, &record.head, c, k)).collect()
        })
        .collect()
}

/// Noise of eight replicates, sorted into the groups of each design: by experiment, number of samples and period; step means by experiment and
/// number of samples.
///
/// What no method of the noise group looks at is left empty.
#[derive(Debug, Clone, Default)]
pub(super) struct LaneNoise {
    /// The first of them.
    pub(super) first: u32,
    /// Which of them are to be run.
    pub(super) chosen: [bool; LANES],
    pub(super) pulses: [Vec<Vec<LaneGroupedNoise>>; 2],
    pub(super) steps: [Vec<Lane>; 2],
}

impl LaneNoise {
    /// How many are to be run.
    pub(super) fn replicates(&self) -> usize {
        self.chosen.into_iter().filter(|chosen| *chosen).count()
    }

    /// Whether all are.
    pub(super) fn is_whole(&self) -> bool {
        self.chosen == [true; LANES]
    }
}

/// Draws the noise of a run of replicates into `noise`, an entry eight of them, the first of which is a multiple of eight.
pub(super) fn draw_lanes(source: &NoiseSource, seed: u64, replicates: Range<u32>, noise: &mut [LaneNoise]) {
    let eights = eights(&replicates);
    let start = eights.start;
    for (first, noise) in eights.step_by(LANES).zip(&mut *noise) {
        let chosen = std::array::from_fn(|l| replicates.contains(&(first + l as u32)));
        *noise = LaneNoise { first, chosen, ..LaneNoise::default() };
    }
    let replicates = start..replicates.end;
    let place = |r: u32| ((r - start) as usize / LANES, (r - start) as usize % LANES);
    let plan = &source.pulses;
    let mut pass = NoisePass::new(plan.clone(), Width::detect()).expect("a group's noise plan is valid");
    let zeros = |period: &usize| {
        let zeros = LaneMoments::zeros(source.order, *period);
        if plan.lags > source.order { zeros.with_left(plan.lags) } else { zeros }
    };
    let mut moments: Vec<LaneMoments> =
        plan.checkpoints.iter().flat_map(|_| plan.periods.iter().map(zeros)).collect();
    for k in (0..2).filter(|k| source.experiments[*k]) {
        pass.run_batched(seed, source.stream + k as u32, replicates.clone(), |first, records| {
            let (lanes, at_once) = (records.lanes(), records.lanes().min(LANES));
            for from in (0..lanes).step_by(at_once) {
                let (batch, lane) = place(first + from as u32);
                let Some(into) = noise.get_mut(batch) else { break };
                for (at, moments) in moments.iter_mut().enumerate() {
                    let (c, period) = (at / plan.periods.len(), at % plan.periods.len());
                    moments.take(lane..lane + at_once, records, from, (c, period));
                }
                let last =
                    lane + at_once == LANES || first as usize + from + at_once >= replicates.end as usize;
                if last {
                    into.pulses[k] = sort(&source.groupings, &moments);
                }
            }
        });
        draw_steps(source, k, seed, replicates.clone(), |r, means| {
            let (batch, lane) = place(r);
            let into = &mut noise[batch].steps[k];
            into.resize(means.len(), Lane::ZERO);
            into.iter_mut().zip(means).for_each(|(into, mean)| into.0[lane] = *mean);
        });
    }
}

/// The replicates from the first of their eight on.
pub(super) fn eights(replicates: &Range<u32>) -> Range<u32> {
    replicates.start / LANES as u32 * LANES as u32..replicates.end
}

/// Sorts moments, by number of samples and then period, into the groups of their designs.
fn sort(groupings: &[Vec<Grouping>], moments: &[LaneMoments]) -> Vec<Vec<LaneGroupedNoise>> {
    let of_checkpoint = |(groupings, moments): (&Vec<Grouping>, &[LaneMoments])| {
        groupings
            .iter()
            .zip(moments)
            .map(|(grouping, moments)| LaneGroupedNoise::new(grouping, moments))
            .collect()
    };
    groupings.iter().zip(moments.chunks(groupings[0].len())).map(of_checkpoint).collect()
}
