//! A few groups of eight replicates at a time through the cells of a family.

use super::bench::Bench;
use super::family_plan::FamilyPlan;
use super::memory::{Few, LANES_AT_ONCE};
use super::noise::LaneNoise;
use super::sections::{CellSums, SectionSums, section};
use super::setting::{Contender, Setting};
use std::array;
use switchback_estimator::estimators::pulse::lanes::{LANES, Lane, LaneFit, LaneSample, LaneStep};
use switchback_estimator::estimators::pulse::{PulseData, StepMean};
use switchback_estimator::simulation::{LaneCross, LaneGroupedNoise};
use switchback_estimator::statistics::LaneErrors;

/// One method at one noise level.
pub(super) struct Cell<'a> {
    pub(super) contender: &'a Contender,
    pub(super) sums: &'a mut CellSums,
}

/// Where a family stands.
pub(super) struct Place<'a> {
    pub(super) plan: &'a FamilyPlan,
    pub(super) bench: &'a Bench,
    /// Index of its period.
    pub(super) period: usize,
}

impl Place<'_> {
    /// The noise of an experiment that any method looks at.
    fn pulses<'n>(&self, noise: &'n LaneNoise, k: usize) -> Option<&'n LaneGroupedNoise> {
        Some(&noise.pulses[k].get(self.plan.checkpoint)?[self.period])
    }

    /// What the responses have in common with the noise.
    pub(super) fn cross(&self, noise: &[LaneNoise], crosses: &mut Vec<[LaneCross; 2]>) {
        crosses.resize_with(noise.len(), Default::default);
        for (noise, crosses) in noise.iter().zip(crosses) {
            for (k, cross) in crosses.iter_mut().enumerate() {
                if let Some(pulses) = self.pulses(noise, k) {
                    self.plan.superpositions[k].cross(pulses, cross);
                }
            }
        }
    }

    /// The data of a few groups at a noise level.
    pub(super) fn superpose(
        &self,
        setting: &Setting,
        (noise, crosses): (&[LaneNoise], &[[LaneCross; 2]]),
        few: &mut Few,
    ) {
        for (i, (noise, crosses)) in noise.iter().zip(crosses).enumerate() {
            for (k, cross) in crosses.iter().enumerate() {
                let Some(pulses) = self.pulses(noise, k) else { continue };
                self.plan.superpositions[k].at((pulses, cross), setting.sigma, &mut few.statistics[i][k]);
                let unit = noise.steps[k].get(self.plan.checkpoint).copied().unwrap_or(Lane::ZERO);
                let mean = unit * setting.sigma + Lane::splat(setting.bench.satellite_output(k));
                few.steps[i][k] = LaneStep { mean, samples: self.plan.samples as f64 };
            }
        }
    }

    /// Adds one method's errors to the sums of a cell.
    pub(super) fn estimate(&self, cell: &mut Cell<'_>, noise: &[LaneNoise], few: &mut Few) {
        let Few { statistics, steps, fits, terms } = few;
        let Cell { contender, sums } = cell;
        let experiments = contender.kind.experiments();
        let (first, last) = (experiments[0], experiments[experiments.len() - 1]);
        let parts = statistics.each_ref().map(|both| both.each_ref());
        let samples: [LaneSample<'_>; LANES_AT_ONCE] = array::from_fn(|i| LaneSample {
            parts: &parts[i][first..=last],
            step: contender.kind.needs_step().then_some(steps[i][first]),
        });
        let samples = &samples[..noise.len()];
        contender.lanes.fit(samples, fits);
        let expansion = &contender.expansions[self.plan.checkpoint];
        expansion.control.terms(samples, terms);
        let errors: [LaneErrors<'_>; LANES_AT_ONCE] = array::from_fn(|i| LaneErrors {
            values: &fits[i].values,
            variances: &fits[i].variances,
            first_order: &terms[i].first,
            second_order: &terms[i].second,
            first_variances: expansion.variances.as_deref(),
        });
        sums.runs.replicates += noise.iter().map(LaneNoise::replicates).sum::<usize>();
        let plain = |(noise, fit): (&LaneNoise, &LaneFit)| noise.is_whole() && fit.sound == [true; LANES];
        if noise.len() == LANES_AT_ONCE && noise.iter().zip(&*fits).all(plain) {
            // Every other eight belongs to the same sections.
            let [a, b, c, d] = errors;
            sums.add_all(noise[0].first, &contender.truth, &[a, c]);
            sums.add_all(noise[1].first, &contender.truth, &[b, d]);
            return;
        }
        for (i, noise) in noise.iter().enumerate() {
            let solved = array::from_fn(|l| noise.chosen[l] && fits[i].sound[l]);
            sums.add(noise.first, &contender.truth, errors[i], &solved);
            for l in (0..LANES).filter(|&l| noise.chosen[l] && !fits[i].sound[l]) {
                let steps = steps[i].map(|s| StepMean { mean: s.mean.0[l], samples: s.samples });
                let data = self.bench.replicate(&statistics[i], l);
                let replicate = noise.first + l as u32;
                let mut alone = sums.section(section(replicate as usize));
                self.estimate_alone(&data, steps, (contender, replicate), &mut alone);
                sums.put_section(section(replicate as usize), &alone);
            }
        }
    }

    /// A replicate that the lanes could not solve, or its failure.
    fn estimate_alone(
        &self,
        data: &[PulseData; 2],
        steps: [StepMean; 2],
        (contender, replicate): (&Contender, u32),
        sums: &mut SectionSums,
    ) {
        contender.kind.with_input(data, steps, |method| match method.fit() {
            Ok(fit) => {
                let errors = fit.parameters().zip(&contender.truth).map(|(x, truth)| (x.value - truth, x.se));
                let variances = contender.expansions[self.plan.checkpoint].variances.as_deref();
                sums.push(errors, &contender.terms(self.plan.checkpoint, &method), variances);
            }
            Err(error) => sums.runs.fail(replicate, error.to_string()),
        });
    }
}
