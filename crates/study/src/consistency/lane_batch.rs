//! A few groups of eight replicates at a time through the cells of a family.

use super::cell_design::{CellDesign, MethodCase};
use super::cell_group_plan::CellGroupPlan;
use super::memory::{Few, LANES_AT_ONCE, Side};
use super::noise::LaneNoise;
use super::sections::{CellSums, section};
use super::setup::Setup;
use std::array;
use switchback_identify::pulse::lanes::{LANES, Lane, LaneStep};
use switchback_identify::simulation::{LaneCross, LaneGroupedNoise};
use switchback_identify::statistics::LaneErrors;

/// One method at one noise level.
pub(super) struct Cell<'a> {
    pub(super) method_case: &'a MethodCase,
    pub(super) sums: &'a mut CellSums,
}

/// Where a family stands.
pub(super) struct Place<'a> {
    pub(super) plan: &'a CellGroupPlan,
    pub(super) setup: &'a Setup,
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

    /// The data of a few groups at a noise level, `sigma` times the unit noise: with its sign changed where that is negative.
    pub(super) fn superpose(
        &self,
        (cell_design, sigma): (&CellDesign, f64),
        (noise, crosses): (&[LaneNoise], &[[LaneCross; 2]]),
        side: &mut Side,
    ) {
        for (i, (noise, crosses)) in noise.iter().zip(crosses).enumerate() {
            for (k, cross) in crosses.iter().enumerate() {
                let Some(pulses) = self.pulses(noise, k) else { continue };
                self.plan.superpositions[k].at((pulses, cross), sigma, &mut side.statistics[i][k]);
                let unit = noise.steps[k].get(self.plan.checkpoint).copied().unwrap_or(Lane::ZERO);
                let mean = unit * sigma + Lane::splat(cell_design.setup.satellite_output(k));
                side.steps[i][k] = LaneStep { mean, samples: self.plan.samples as f64 };
            }
        }
    }

    /// Adds one method's errors to the sums of a cell.
    pub(super) fn estimate(&self, cell: &mut Cell<'_>, noise: &[LaneNoise], few: &mut Few) {
        let Few { own, mirrored } = few;
        let Cell { method_case, sums } = cell;
        let expansion = &method_case.expansions[self.plan.checkpoint];
        own.estimate(method_case, &expansion.control, noise.len());
        if method_case.is_paired() {
            mirrored.estimate(method_case, &expansion.control, noise.len());
        }
        let (own, mirrored) = (&*own, method_case.is_paired().then_some(&*mirrored));
        let first_variances = expansion.variances.as_deref();
        let errors: [LaneErrors<'_>; LANES_AT_ONCE] = array::from_fn(|i| LaneErrors {
            own: own.estimates(i),
            mirrored: mirrored.map(|mirrored| mirrored.estimates(i)),
            first_variances,
        });
        let is_sound =
            |i: usize, l: usize| own.fits[i].sound[l] && mirrored.is_none_or(|m| m.fits[i].sound[l]);
        sums.runs.replicates += noise.iter().map(LaneNoise::replicates).sum::<usize>();
        let is_plain =
            |(i, noise): (usize, &LaneNoise)| noise.is_whole() && (0..LANES).all(|l| is_sound(i, l));
        if noise.len() == LANES_AT_ONCE && noise.iter().enumerate().all(is_plain) {
            // Every other eight belongs to the same sections.
            let [a, b, c, d] = errors;
            sums.add_all(noise[0].first, &method_case.truth, &[a, c]);
            sums.add_all(noise[1].first, &method_case.truth, &[b, d]);
            return;
        }
        for (i, noise) in noise.iter().enumerate() {
            let solved = array::from_fn(|l| noise.chosen[l] && is_sound(i, l));
            // Of an order without compiled lanes none are solved, and there is nothing to add.
            if solved.contains(&true) {
                sums.add(noise.first, &method_case.truth, errors[i], &solved);
            }
            for l in (0..LANES).filter(|&l| noise.chosen[l] && !is_sound(i, l)) {
                let replicate = noise.first + l as u32;
                let outcome = |side: &Side| {
                    let (data, steps) = side.alone(self.setup, i, l);
                    method_case
                        .kind
                        .with_input(&data, steps, |m| method_case.outcome(self.plan.checkpoint, &m))
                };
                let mut alone = sums.section(section(replicate as usize));
                match outcome(own) {
                    Ok(own) => {
                        let partner = mirrored.and_then(|mirrored| outcome(mirrored).ok());
                        alone.push_pair(&own, partner.as_ref(), first_variances);
                    }
                    Err(error) => alone.runs.fail(replicate, error.to_string()),
                }
                sums.put_section(section(replicate as usize), &alone);
            }
        }
    }
}
