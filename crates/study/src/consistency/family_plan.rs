//! What cells of one border, m and N have in common, whatever their noise level and method.

use super::setting::Setting;
use std::ops::Range;
use switchback_identify::simulation::LaneSuperposition;

/// What the cells of one border, m and N have in common.
#[derive(Debug, Clone)]
pub(super) struct FamilyPlan {
    /// Their noise levels, among the settings of the noise group.
    pub(super) settings: Range<usize>,
    /// Index of the number of samples.
    pub(super) checkpoint: usize,
    pub(super) samples: usize,
    pub(super) superpositions: [LaneSuperposition; 2],
}

impl FamilyPlan {
    /// The families of some settings, the noise levels of a border and m next to each other, at these numbers of samples.
    pub(super) fn all(settings: &[Setting], checkpoints: &[usize]) -> Vec<Self> {
        let same = |s: &Setting, t: &Setting| (s.border, s.bench.points) == (t.border, t.bench.points);
        let mut families = Vec::new();
        let mut first = 0;
        for levels in settings.chunk_by(same) {
            let settings = first..first + levels.len();
            first = settings.end;
            families.extend(checkpoints.iter().enumerate().map(|(checkpoint, &samples)| Self {
                settings: settings.clone(),
                checkpoint,
                samples,
                superpositions: levels[0].bench.superpositions(samples),
            }));
        }
        families
    }
}
