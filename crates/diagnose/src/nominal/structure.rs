//! Order and lead of a nominal model, and how it is fitted as a simulator.

use crate::records::dataset::{Criterion, Dataset};
use crate::records::motion::Begins;

/// Orders above one chosen, and samples of delay beyond its own, at which a structure is asked whether it does what an effect does: a
/// mode is two orders more.
const HIGHER: usize = 2;
const LATER: isize = 3;
/// The lead at which an output follows the input within its sample, the largest in real time.
pub(super) const PRESENT: isize = 1;
/// Rounds of fitting as a simulator while structures are compared.
pub(super) const ROUNDS: usize = 10;

/// Each error counted for one.
pub(super) const SIMULATION: Criterion = Criterion::Simulation { share: 1.0 };

/// What is chosen besides the criterion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Structure {
    pub(crate) order: usize,
    /// Samples by which the output follows the input sooner than in the paper, or later where it is negative.
    pub(crate) lead: isize,
    pub(super) begins: Begins,
}

impl Structure {
    /// In words.
    pub(super) fn reported(&self) -> String {
        let lead = match self.lead {
            0 => String::new(),
            1 => " and an output that follows the input within its sample".to_owned(),
            lead if lead < 0 => format!(" and {} samples of extra delay", -lead),
            lead => format!(" and an output {} sample ahead of the input", lead - 1),
        };
        format!("the rig declares no order: order {}{lead}", self.order)
    }

    /// Structures that could describe an effect of the dynamics, or with `is_late` a delay, simpler ones first.
    pub(crate) fn wider(self, is_late: bool) -> Vec<Self> {
        let later = (1..=LATER).map(|by| Self { lead: self.lead - by, ..self });
        let higher = (1..=HIGHER).map(|by| Self { order: self.order + by, ..self });
        later.filter(|_| is_late).chain(higher).collect()
    }

    /// That of a model in the form of the paper.
    pub(crate) fn of_order(order: usize) -> Self {
        Self { order, lead: 0, begins: Begins::default() }
    }

    /// The records as this structure sees them.
    pub(crate) fn applied(&self, dataset: &Dataset) -> Dataset {
        dataset.with_branches_from(self.begins).led_by(self.lead).counted_for(self.order)
    }
}
