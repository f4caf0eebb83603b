//! What cells of one border, m and N have in common, whatever their noise level and method.

use super::cell_design::CellDesign;
use std::ops::Range;
use switchback_identify::simulation::LaneSuperposition;

/// What the cells of one border, m and N have in common.
#[derive(Debug, Clone)]
pub(super) struct CellGroupPlan {
    /// Their noise levels, among the settings of the noise group.
    pub(super) cell_designs: Range<usize>,
    /// Index of the number of samples.
    pub(super) checkpoint: usize,
    pub(super) samples: usize,
    pub(super) superpositions: [LaneSuperposition; 2],
}

impl CellGroupPlan {
    /// The families of some settings, the noise levels of a border and m next to each other, at these numbers of samples.
    pub(super) fn all(cell_designs: &[CellDesign], checkpoints: &[usize]) -> Vec<Self> {
        let same = |s: &CellDesign, t: &CellDesign| (s.border, s.setup.points) == (t.border, t.setup.points);
        let mut cell_groups = Vec::new();
        let mut first = 0;
        for levels in cell_designs.chunk_by(same) {
            let cell_designs = first..first + levels.len();
            first = cell_designs.end;
            cell_groups.extend(checkpoints.iter().enumerate().map(|(checkpoint, &samples)| Self {
                cell_designs: cell_designs.clone(),
                checkpoint,
                samples,
                superpositions: levels[0].setup.superpositions(samples),
            }));
        }
        cell_groups
    }
}
