//! Whether the model lacks a cause or only the right order.

use super::degradation::differences;
use super::plan::Plan;
use super::report::{Conclusion, Other};
use crate::effects::Room;
use crate::likelihood::engine::Fit;
use crate::nominal::order::Chosen;
use crate::records::dataset::Dataset;
use crate::simulation::simulate::free_run;
use crate::verdict::answer::Verdict;
use crate::verdict::decide::{parameters_are_off, unresolved};

/// Whether a verdict names, alone or among others, an effect that a higher order or another delay could describe as well.
pub(super) fn shows_dynamics(verdict: &Verdict) -> bool {
    verdict.effects.iter().chain(&verdict.class).any(|effect| effect.card().room.is_some())
}

/// Whether a verdict shows a delay.
pub(super) fn shows_a_delay(verdict: &Verdict) -> bool {
    verdict.effects.iter().chain(&verdict.class).any(|effect| effect.card().room == Some(Room::Delay))
}

impl Plan {
    /// Whether a nominal model of another structure does as well on the judged records as a candidate, but for the error of the
    /// difference.
    pub(super) fn does_the_same(&self, chosen: &Chosen, explained: &Fit) -> bool {
        self.mean(&self.saved_over((&chosen.dataset, &chosen.fit), explained), explained)
            .is_some_and(|saved| saved.low <= 0.0)
    }

    /// Squared error that simulating the judged records with a candidate saves over another model, which sees them as a dataset of its
    /// own.
    fn saved_over(&self, (dataset, fit): (&Dataset, &Fit), explained: &Fit) -> Vec<Vec<f64>> {
        let run = |dataset: &Dataset, fit: &Fit, number: usize| {
            free_run(dataset, fit, number, &dataset.scaled_records[number])
        };
        let other = self.squared_errors(|number| run(dataset, fit, number));
        differences(&other, &self.squared_errors(|number| run(&self.dataset, explained, number)))
    }

    /// The conclusion that the order is off: `again` is the plan on the nominal model that does what the effects do.
    pub(super) fn refitted(&self, conclusion: Conclusion, again: &Self) -> Conclusion {
        let fit = &again.nominal.plain.fit;
        let runs = again.nominal.runs(&again.dataset, &again.judged);
        let other = Other { structure: again.structure, runs, floor: again.noise_floor(fit) };
        let mut verdict = match self.resolves_no_gap(&conclusion.augmented.fit) {
            true => unresolved(&conclusion.odds),
            false => parameters_are_off(&conclusion.verdict),
        };
        verdict.calibrated = self.is_calibrated;
        Conclusion { verdict, augmented: self.nominal.plain.clone(), other: Some(other), ..conclusion }
    }

    /// Whether the judged records show no gap beyond the noise of a model.
    pub(super) fn resolves_no_gap(&self, fit: &Fit) -> bool {
        self.gap(fit, self.settings.resamples).before.ci90[0] <= 0.0
    }
}
