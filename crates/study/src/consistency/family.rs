//! Cells of one border, m and N: they share all but the noise level and the method.

use super::cell::ActiveCells;
use super::family_plan::FamilyPlan;
use super::lane_batch::{Cell, Place};
use super::memory::{LANES_AT_ONCE, Memory};
use super::noise::LaneNoise;
use super::setting::Setting;
use std::cmp::Reverse;

/// The cells of one border, m and N, with their sums.
pub(super) struct Family<'a> {
    place: Place<'a>,
    levels: Vec<NoiseLevel<'a>>,
}

/// The cells of a family at one noise level, a method each.
struct NoiseLevel<'a> {
    setting: &'a Setting,
    /// The active ones.
    cells: Vec<Cell<'a>>,
}

impl<'a> Family<'a> {
    /// The families that have anything active, from the largest to the smallest; `cells` are in the order of the noise group's.
    pub(super) fn all(plans: &'a [FamilyPlan], settings: &'a [Setting], cells: ActiveCells<'a>) -> Vec<Self> {
        let ActiveCells { mut active, sums: mut cells } = cells;
        let mut families = Vec::with_capacity(plans.len());
        for plans in plans.chunk_by(|p, q| p.settings == q.settings) {
            let settings = &settings[plans[0].settings.clone()];
            let first = families.len();
            families.extend(plans.iter().map(|plan| Self {
                place: Place { plan, bench: &settings[0].bench, period: settings[0].period },
                levels: Vec::with_capacity(settings.len()),
            }));
            for setting in settings {
                for family in &mut families[first..] {
                    let methods = setting.methods.len();
                    let (own, rest) = cells.split_at_mut(methods);
                    cells = rest;
                    let contenders = setting.methods.iter().zip(own).zip(&active[..methods]);
                    let cells: Vec<Cell<'a>> = contenders
                        .filter(|(_, active)| **active)
                        .map(|((contender, sums), _)| Cell { contender, sums })
                        .collect();
                    if !cells.is_empty() {
                        family.levels.push(NoiseLevel { setting, cells });
                    }
                    active = &active[methods..];
                }
            }
        }
        families.retain(|family| !family.levels.is_empty());
        // Those of one m and N take in the same noise: next to each other, they find it in the cache.
        families.sort_by_key(|family| Reverse((family.place.period, family.place.plan.checkpoint)));
        families
    }

    /// Estimates every active cell from the noise of some replicates, in order.
    pub(super) fn run(self, noise: &[LaneNoise], memory: &mut Memory) {
        let Self { place, levels } = self;
        let Memory { crosses, few } = memory;
        place.cross(noise, crosses);
        few.shape(&place.plan.superpositions);
        for NoiseLevel { setting, mut cells } in levels {
            for (noise, crosses) in noise.chunks(LANES_AT_ONCE).zip(crosses.chunks(LANES_AT_ONCE)) {
                place.superpose((setting, setting.sigma), (noise, crosses), &mut few.own);
                if cells.iter().any(|cell| cell.contender.is_paired()) {
                    place.superpose((setting, -setting.sigma), (noise, crosses), &mut few.mirrored);
                }
                cells.iter_mut().for_each(|cell| place.estimate(cell, noise, few));
            }
        }
    }
}
