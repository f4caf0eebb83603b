//! Cells of one border, m and N: they share all but the noise level and the method.

use super::cell::ActiveCells;
use super::cell_design::CellDesign;
use super::cell_group_plan::CellGroupPlan;
use super::lane_batch::{Cell, Place};
use super::memory::{LANES_AT_ONCE, Memory};
use super::noise::LaneNoise;
use std::cmp::Reverse;

/// The cells of one border, m and N, with their sums.
pub(super) struct CellGroup<'a> {
    place: Place<'a>,
    levels: Vec<NoiseLevel<'a>>,
}

/// The cells of a family at one noise level, a method each.
struct NoiseLevel<'a> {
    cell_design: &'a CellDesign,
    /// The active ones.
    cells: Vec<Cell<'a>>,
}

impl<'a> CellGroup<'a> {
    /// The families that have anything active, from the largest to the smallest; `cells` are in the order of the noise group's.
    pub(super) fn all(
        plans: &'a [CellGroupPlan],
        cell_designs: &'a [CellDesign],
        cells: ActiveCells<'a>,
    ) -> Vec<Self> {
        let ActiveCells { mut active, sums: mut cells } = cells;
        let mut cell_groups = Vec::with_capacity(plans.len());
        for plans in plans.chunk_by(|p, q| p.cell_designs == q.cell_designs) {
            let cell_designs = &cell_designs[plans[0].cell_designs.clone()];
            let first = cell_groups.len();
            cell_groups.extend(plans.iter().map(|plan| Self {
                place: Place { plan, setup: &cell_designs[0].setup, period: cell_designs[0].period },
                levels: Vec::with_capacity(cell_designs.len()),
            }));
            for cell_design in cell_designs {
                for cell_group in &mut cell_groups[first..] {
                    let methods = cell_design.methods.len();
                    let (own, rest) = cells.split_at_mut(methods);
                    cells = rest;
                    let method_cases = cell_design.methods.iter().zip(own).zip(&active[..methods]);
                    let cells: Vec<Cell<'a>> = method_cases
                        .filter(|(_, active)| **active)
                        .map(|((method_case, sums), _)| Cell { method_case, sums })
                        .collect();
                    if !cells.is_empty() {
                        cell_group.levels.push(NoiseLevel { cell_design, cells });
                    }
                    active = &active[methods..];
                }
            }
        }
        cell_groups.retain(|cell_group| !cell_group.levels.is_empty());
        // Those of one m and N take in the same noise: next to each other, they find it in the cache.
        cell_groups
            .sort_by_key(|cell_group| Reverse((cell_group.place.period, cell_group.place.plan.checkpoint)));
        cell_groups
    }

    /// Estimates every active cell from the noise of some replicates, in order.
    pub(super) fn run(self, noise: &[LaneNoise], memory: &mut Memory) {
        let Self { place, levels } = self;
        let Memory { crosses, few } = memory;
        place.cross(noise, crosses);
        few.shape(&place.plan.superpositions);
        for NoiseLevel { cell_design, mut cells } in levels {
            for (noise, crosses) in noise.chunks(LANES_AT_ONCE).zip(crosses.chunks(LANES_AT_ONCE)) {
                place.superpose((cell_design, cell_design.sigma), (noise, crosses), &mut few.own);
                if cells.iter().any(|cell| cell.method_case.is_paired()) {
                    place.superpose((cell_design, -cell_design.sigma), (noise, crosses), &mut few.mirrored);
                }
                cells.iter_mut().for_each(|cell| place.estimate(cell, noise, few));
            }
        }
    }
}
