//! A pulse experiment unrolled: what every phase of its period does to the system and to the regression.

use crate::excitation::PulseExperiment;
use crate::pulse::PulseData;
use switchback_model::hysteresis::{Branch, SwitchedHysteresis};

/// One period of a pulse experiment on a given hysteresis: `u` and the regression's group, phase for phase.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicDesign {
    /// The border it reveals.
    pub branch: Branch,
    /// `V₁…V_m`.
    pub levels: Vec<f64>,
    /// Where the input rests.
    pub satellite: f64,
    /// Order `n` of the regression, which may differ from the system's.
    pub order: usize,
    /// `u` at each phase, by the operator (2.3) itself, in units of the borders.
    pub u: Vec<f64>,
    /// The group (see [`PulseData`]) of each phase.
    pub groups: Vec<usize>,
}

impl PeriodicDesign {
    /// Unrolls `experiment` on `hysteresis` for a regression of order `order`.
    pub fn new(experiment: &PulseExperiment, hysteresis: &SwitchedHysteresis, order: usize) -> Self {
        let period = experiment.period();
        let v: Vec<f64> = experiment.record_input(2 * period);
        let u = hysteresis.output(&v, hysteresis.u_low()).split_off(1 + period);
        let visits: Vec<usize> = (0..experiment.points()).map(|j| experiment.visit_phase(j)).collect();
        let groups = (0..period)
            .map(|p| {
                (1..=order)
                    .find_map(|lag| {
                        let level = visits.iter().position(|&visit| (visit + lag) % period == p)?;
                        Some(PulseData::group(order, level, lag))
                    })
                    .unwrap_or(0)
            })
            .collect();
        Self {
            branch: experiment.direction().visited_branch(),
            levels: experiment.levels().to_vec(),
            satellite: experiment.satellite(),
            order,
            u,
            groups,
        }
    }

    /// The period `T` in samples.
    pub fn period(&self) -> usize {
        self.u.len()
    }

    /// The level (from 0) that the input visits at each phase; `None` where it rests.
    pub(crate) fn visits(&self) -> Vec<Option<usize>> {
        let seen_first = |group: usize| {
            (group > 0 && (group - 1).is_multiple_of(self.order)).then(|| (group - 1) / self.order)
        };
        (0..self.period()).map(|p| seen_first(self.groups[(p + 1) % self.period()])).collect()
    }

    /// Groups of the regression, `1 + nm`.
    pub fn group_count(&self) -> usize {
        1 + self.levels.len() * self.order
    }
}
