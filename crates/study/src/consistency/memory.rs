//! Working memory that one family of cells leaves to the next.

use super::cell_design::MethodCase;
use super::setup::Setup;
use std::array;
use switchback_identify::pulse::lanes::{
    LaneControl, LaneFit, LaneSample, LaneStatistics, LaneStep, LaneTerms,
};
use switchback_identify::pulse::{PulseData, StepMean};
use switchback_identify::simulation::{LaneCross, LaneSuperposition};
use switchback_identify::statistics::LaneEstimates;

/// Groups of eight replicates that a cell takes in before the next: so many statistics, and one cell's sums, stay in the cache.
pub(super) const LANES_AT_ONCE: usize = 4;

/// What one family leaves to the next: memory.
#[derive(Default)]
pub(super) struct Memory {
    /// One a group of eight replicates.
    pub(super) crosses: Vec<[LaneCross; 2]>,
    pub(super) few: Few,
}

/// A few groups of eight replicates at one noise level.
#[derive(Default)]
pub(super) struct Few {
    /// The replicates themselves.
    pub(super) own: Side,
    /// Their antithetic partners: the same noise with its sign changed.
    pub(super) mirrored: Side,
}

/// The records of a few groups of eight replicates, and what a method makes of them.
#[derive(Default)]
pub(super) struct Side {
    pub(super) statistics: [[LaneStatistics; 2]; LANES_AT_ONCE],
    pub(super) steps: [[LaneStep; 2]; LANES_AT_ONCE],
    pub(super) fits: [LaneFit; LANES_AT_ONCE],
    pub(super) terms: [LaneTerms; LANES_AT_ONCE],
}

impl Few {
    /// Makes room for the statistics of a family.
    pub(super) fn shape(&mut self, superpositions: &[LaneSuperposition; 2]) {
        for statistics in self.own.statistics.iter_mut().chain(&mut self.mirrored.statistics) {
            statistics.iter_mut().zip(superpositions).for_each(|(s, from)| from.shape(s));
        }
    }
}

impl Side {
    /// Estimates and the leading terms of their errors, from the first `groups` groups.
    pub(super) fn estimate(&mut self, method_case: &MethodCase, control: &LaneControl, groups: usize) {
        let Self { statistics, steps, fits, terms } = self;
        let experiments = method_case.kind.experiments();
        let (first, last) = (experiments[0], experiments[experiments.len() - 1]);
        let parts = statistics.each_ref().map(|both| both.each_ref());
        let samples: [LaneSample<'_>; LANES_AT_ONCE] = array::from_fn(|i| LaneSample {
            parts: &parts[i][first..=last],
            step: method_case.kind.needs_step().then_some(steps[i][first]),
        });
        method_case.lanes.fit(&samples[..groups], fits);
        control.terms(&samples[..groups], terms);
    }

    /// What was estimated from group `i`.
    pub(super) fn estimates(&self, i: usize) -> LaneEstimates<'_> {
        LaneEstimates {
            values: &self.fits[i].values,
            variances: &self.fits[i].variances,
            first_order: &self.terms[i].first,
            second_order: &self.terms[i].second,
        }
    }

    /// The records of one replicate by themselves.
    pub(super) fn alone(&self, setup: &Setup, i: usize, lane: usize) -> ([PulseData; 2], [StepMean; 2]) {
        let steps = self.steps[i].map(|s| StepMean { mean: s.mean.0[lane], samples: s.samples });
        (setup.replicate(&self.statistics[i], lane), steps)
    }
}
