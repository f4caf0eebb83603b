//! What an explanation saves or spoils on the held-out records, beyond its error.
//!
//! The error is that of the mean over a record whose errors hang together: a block bootstrap, 95 %. A block is as long as the errors'
//! own correlation asks for, and as the model takes to settle at least.

use super::Plan;
use crate::attribution::explain::Explanation;
use crate::attribution::pairs::Causes;
use crate::effect::Effect;
use crate::likelihood::engine::Fit;
use crate::records::campaign::Criterion;
use crate::residuals::bootstrap::{Mean, mean};
use crate::residuals::score::heldout_log_scores;
use crate::simulation::simulate::free_run;

/// What is left of a move once the model has settled.
const SETTLED: f64 = 0.05;

impl Plan {
    /// Whether an explanation makes any held-out record worse beyond its error: simulated, or predicted one step ahead where models are
    /// compared by that.
    pub(super) fn harms(&self, explanation: &Explanation) -> bool {
        let fit = &explanation.fit;
        let is_held_out = |number: &usize| !self.campaign.tracks[*number].is_fit();
        let simulated = self.judged.iter().zip(self.saved_in_simulation(fit));
        let simulated = simulated.filter(|(number, _)| is_held_out(number)).map(|(_, saved)| saved);
        let predicted = match self.campaign.criterion {
            Criterion::OneStep => gained_in_prediction(self, &self.nominal.plain.fit, fit),
            Criterion::Simulation { .. } => Vec::new(),
        };
        simulated.chain(predicted).any(|saved| self.mean(&[saved], fit).is_some_and(|m| m.high < 0.0))
    }

    /// Whether the effect that is told beside one of the sensor shows on the held-out records: laws of sensors are never exact, and a
    /// second effect takes what they leave. True of any other pair; `alone` are the single effects fitted.
    pub(super) fn second_shows(&self, both: &Explanation, causes: &Causes, alone: &[Explanation]) -> bool {
        let [one, other] = causes.effects[..] else { return true };
        let known = |effect: Effect| alone.iter().position(|s| s.parts[0].effect == effect);
        let (first, second) = match [one, other].map(reads_wrongly) {
            [false, false] => return true,
            [true, false] => (one, other),
            [false, true] => (other, one),
            // `alone` is sorted, the best first.
            [true, true] if known(other) < known(one) => (other, one),
            [true, true] => (one, other),
        };
        known(first).is_none_or(|k| self.is_gain(&both.fit, &alone[k].fit, second))
    }

    /// Whether two effects do better than one of them on the held-out records beyond the error: simulated, unless the other one is in the
    /// noise or follows a clock, and predicted where models are compared by that. True without any.
    fn is_gain(&self, both: &Fit, one: &Fit, other: Effect) -> bool {
        let better = |saved: &[Vec<f64>]| self.mean(saved, both).is_none_or(|m| m.low > 0.0);
        let runs = |fit: &Fit| {
            self.squared_errors(|number| free_run(&self.campaign, fit, number, &self.campaign.tracks[number]))
        };
        let moves = !other.is_noise() && !other.is_of_its_record();
        let predicts = self.campaign.criterion == Criterion::OneStep;
        (!moves || better(&differences(&runs(one), &runs(both))))
            && (!predicts || better(&gained_in_prediction(self, one, both)))
    }

    /// Squared error saved on each judged record by simulating with another model than the one under diagnosis, sample by sample.
    pub(super) fn saved_in_simulation(&self, fit: &Fit) -> Vec<Vec<f64>> {
        let after = |number| free_run(&self.campaign, fit, number, &self.campaign.tracks[number]);
        let before = |number| {
            let at = self.judged.iter().position(|&judged| judged == number).unwrap_or_default();
            self.runs[at].clone()
        };
        differences(&self.squared_errors(before), &self.squared_errors(after))
    }

    /// Squared errors of a simulation on each judged record, sample by sample.
    pub(super) fn squared_errors(&self, run: impl Fn(usize) -> Vec<f64>) -> Vec<Vec<f64>> {
        let squares = |&number: &usize| {
            let track = &self.campaign.tracks[number];
            track.y.iter().zip(run(number)).skip(track.from).map(|(y, x)| (y - x).powi(2)).collect()
        };
        self.judged.iter().map(squares).collect()
    }

    /// The mean of what hangs together as the errors of a model do.
    pub(super) fn mean(&self, records: &[Vec<f64>], fit: &Fit) -> Option<Mean> {
        mean(records, settling(fit).max(settling(&self.nominal.plain.fit)), self.settings.seed)
    }
}

/// Whether an effect is what the sensor makes of an output that is right: it clips, rounds, or is curved.
fn reads_wrongly(effect: Effect) -> bool {
    matches!(effect, Effect::SensorSaturation | Effect::SensorQuantisation | Effect::SensorNonlinearity)
}

/// Log predictive density that one model gains over another on each held-out record, on the samples that both predict.
fn gained_in_prediction(plan: &Plan, before: &Fit, after: &Fit) -> Vec<Vec<f64>> {
    let scores = |fit: &Fit| heldout_log_scores(&plan.campaign, fit);
    let mut gained = differences(&scores(after), &scores(before));
    gained.iter_mut().for_each(|record| record.retain(|x| !x.is_nan()));
    gained
}

pub(super) fn differences(one: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of_record = |(x, y): (&Vec<f64>, &Vec<f64>)| x.iter().zip(y).map(|(x, y)| x - y).collect();
    one.iter().zip(other).map(of_record).collect()
}

/// Samples until a twentieth of a move is left.
fn settling(fit: &Fit) -> usize {
    let slowest = fit.linear.poles().iter().map(|pole| pole.norm()).fold(0.0, f64::max);
    match slowest {
        // What never settles remembers all: the blocks are as long as they may be.
        r if r >= 1.0 => usize::MAX,
        r if r <= 0.0 => 1,
        r => (SETTLED.ln() / r.ln()).ceil() as usize,
    }
}
