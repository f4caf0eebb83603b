//! What a candidate saves or spoils on the held-out records, beyond its error.
//!
//! The error is that of the mean over a record whose errors hang together: a block bootstrap, 95 %. A block is as long as the errors'
//! own correlation asks for, and as the model takes to settle at least.

use switchback_identify::statistics::MeanInterval;

use super::held_out::reported_by_rounding;
use super::plan::Plan;
use crate::attribution::explain::Hypothesis;
use crate::attribution::pairs::Causes;
use crate::effect::Effect;
use crate::likelihood::engine::Fit;
use crate::records::dataset::Criterion;
use crate::residuals::score::heldout_log_scores;
use crate::simulation::own_paths::without_own_paths;
use crate::simulation::simulate::free_run;
use switchback_model::spectrum::mean_square;

impl Plan {
    /// Whether a candidate makes any held-out record worse beyond its error: simulated, or predicted one step ahead where models are
    /// compared by that.
    ///
    /// What is all noise, or rounds, moves no simulation but by fitting the rest anew: of that the error counts, too, which no held-out record shows.
    pub(super) fn degrades_validation(&self, hypothesis: &Hypothesis) -> bool {
        let fit = &hypothesis.fit;
        let spared = if hypothesis.effects().iter().all(|e| e.moves_no_simulation()) {
            self.cost_of_fitting(fit)
        } else {
            0.0
        };
        let is_held_out = |number: &usize| !self.dataset.scaled_records[*number].is_fit();
        let saved = self.saved_beside_own_paths(fit);
        let simulated = self.judged.iter().zip(saved);
        let simulated = simulated.filter(|(number, _)| is_held_out(number));
        let simulated = simulated.map(|(_, saved)| saved.into_iter().map(|x| x + spared).collect());
        let predicted = match self.dataset.criterion {
            Criterion::OneStep => gained_in_prediction(self, &self.nominal.plain.fit, fit),
            Criterion::Simulation { .. } => Vec::new(),
        };
        simulated.chain(predicted).any(|saved| self.mean(&[saved], fit).is_some_and(|m| m.high < 0.0))
    }

    /// Squared error of the simulation that fitting `k` parameters to `N` samples costs elsewhere: `k/N` of that of the nominal model
    /// (H. Akaike, "Fitting autoregressive models for prediction", Ann. Inst. Stat. Math. 21, 1969). A rounding that repeats with the
    /// input is followed by a model that knows of none: one that does has all of it, a twelfth of the step's square.
    fn cost_of_fitting(&self, fit: &Fit) -> f64 {
        let errors = self.judged_errors(&self.nominal.plain.fit);
        let rounding = fit.augmented.noise.quantisation.map_or(0.0, |step| step * step / 12.0);
        fit.parameters / fit.samples.max(1) as f64 * mean_square(&errors) + rounding
    }

    /// Whether the effect that is reported beside one of the sensor shows on the held-out records: laws of sensors are never exact, and a
    /// second effect takes what they leave. True of any other pair; `alone` are the single effects fitted.
    pub(super) fn second_shows(&self, both: &Hypothesis, causes: &Causes, alone: &[Hypothesis]) -> bool {
        let [one, other] = causes.effects[..] else { return true };
        let known = |effect: Effect| alone.iter().position(|s| s.effect_terms[0].effect == effect);
        let (first, second) = match [one, other].map(|effect| effect.card().misreads) {
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
            self.squared_errors(|number| {
                free_run(&self.dataset, fit, number, &self.dataset.scaled_records[number])
            })
        };
        let moves = !other.is_noise() && !other.is_of_its_record();
        let predicts = self.dataset.criterion == Criterion::OneStep;
        (!moves || better(&differences(&runs(one), &runs(both))))
            && (!predicts || better(&gained_in_prediction(self, one, both)))
    }

    /// Squared error saved on each judged record by simulating with another model than the one under diagnosis, sample by sample, without what no record has
    /// of its own: a model with a zero or a wave free from record to record says nothing of these in another one.
    fn saved_beside_own_paths(&self, fit: &Fit) -> Vec<Vec<f64>> {
        let lasting = |errors| squared(without_own_paths(&self.dataset, fit, &self.judged, errors));
        let [before, after] = self.errors_before_and_after(fit).map(lasting);
        differences(&before, &after)
    }

    /// The judged record with a number, simulated by the model under diagnosis.
    pub(super) fn run_before(&self, number: usize) -> Vec<f64> {
        let at = self.judged.iter().position(|&judged| judged == number).unwrap_or_default();
        self.runs[at].clone()
    }

    /// Errors of the simulations by the model under diagnosis and by another one on each judged record.
    fn errors_before_and_after(&self, fit: &Fit) -> [Vec<Vec<f64>>; 2] {
        let after = |number| free_run(&self.dataset, fit, number, &self.dataset.scaled_records[number]);
        [self.errors(|number| self.run_before(number)), self.errors(after)]
    }

    /// Squared errors of a simulation on each judged record, sample by sample.
    pub(super) fn squared_errors(&self, run: impl Fn(usize) -> Vec<f64>) -> Vec<Vec<f64>> {
        squared(self.errors(run))
    }

    /// Errors of a simulation on each judged record, sample by sample.
    pub(super) fn errors(&self, run: impl Fn(usize) -> Vec<f64>) -> Vec<Vec<f64>> {
        let of_record = |&number: &usize| {
            let scaled = &self.dataset.scaled_records[number];
            scaled.y.iter().zip(run(number)).skip(scaled.from).map(|(y, x)| y - x).collect()
        };
        self.judged.iter().map(of_record).collect()
    }

    /// The mean of what hangs together as the errors of a model do.
    pub(super) fn mean(&self, records: &[Vec<f64>], fit: &Fit) -> Option<MeanInterval> {
        let records: Vec<&[f64]> = records.iter().map(Vec::as_slice).collect();
        MeanInterval::of_remembering(
            &records,
            fit.linear.settling().max(self.nominal.plain.fit.linear.settling()),
        )
    }
}

fn squared(mut records: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    records.iter_mut().flatten().for_each(|x| *x *= *x);
    records
}

/// Log predictive density that one model gains over another on each held-out record, on the samples that both predict; what a quantisation grid of
/// the outputs is worth counts with it.
fn gained_in_prediction(plan: &Plan, before: &Fit, after: &Fit) -> Vec<Vec<f64>> {
    let scores = |fit: &Fit| heldout_log_scores(&plan.dataset, fit);
    let mut gained = differences(&scores(after), &scores(before));
    let by_rounding = reported_by_rounding(after) - reported_by_rounding(before);
    for record in &mut gained {
        record.retain(|x| !x.is_nan());
        record.iter_mut().for_each(|x| *x += by_rounding);
    }
    gained
}

pub(super) fn differences(one: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of_record = |(x, y): (&Vec<f64>, &Vec<f64>)| x.iter().zip(y).map(|(x, y)| x - y).collect();
    one.iter().zip(other).map(of_record).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::model::augmented::EquationColumn;
    use crate::nominal::order::{Choice, structure};
    use crate::records::dataset::Dataset;
    use crate::settings::{Model, Settings};
    use crate::testing::white;
    use crate::workers::Serial;
    use switchback_model::Record;
    use switchback_model::rig::{Rig, RigRecord, Role, Usage};

    /// The plan of a first-order rig with straight borders, its second record held out.
    pub(in crate::diagnose) fn plan() -> Plan {
        let mut noise = white();
        let mut record = |name: &str, usage, phase: f64| {
            let v: Vec<f64> = (0..600)
                .map(|t| (0.17 * f64::from(t) + phase).sin() + 0.6 * (0.031 * f64::from(t)).cos())
                .collect();
            let (mut u, mut y) = (0.0, vec![0.0]);
            for t in 1..v.len() {
                y.push(0.6 * y[t - 1] + 0.4 * u + 0.02 * noise());
                u = v[t] + 0.4 * (v[t] - v[t - 1]).signum();
            }
            let record = Record::new(v, y).expect("finite and equally long");
            RigRecord { name: name.into(), role: Role::Free, usage, record, predicted: None }
        };
        let records = vec![record("fit", Usage::Fit, 0.0), record("held out", Usage::Holdout, 1.0)];
        let rig = Rig {
            name: "small".into(),
            sample_time: 1.0,
            order: Some(1),
            interval: None,
            input_label: "v".into(),
            output_label: "y".into(),
            records,
        };
        let dataset = Dataset::new(&rig).expect("a usable rig");
        match structure(&Serial, (&rig, dataset), Some(1), &Settings::default()).expect("a model") {
            Choice::One(chosen) => Plan::new(&rig, &Model::Identify, &Settings::default(), chosen),
            Choice::Either(..) => panic!("the order is declared"),
        }
        .expect("a plan")
    }

    #[test]
    fn what_is_worse_on_a_held_out_record_degrades_validation_and_what_is_no_better_is_no_second_effect() {
        let plan = plan();
        let good = &plan.nominal.plain;
        let mut poor = good.clone();
        poor.fit.linear.f.iter_mut().for_each(|f| *f *= 0.8);
        assert!(plan.degrades_validation(&poor) && !plan.degrades_validation(good));
        // Another zero harms, unless it is free from record to record; a wrong loop always does.
        let local = EquationColumn::Local { scaled: 0, piece: 0, pieces: 1 };
        let offset = EquationColumn::Offset { scaled: 0, against: None };
        for zero in [local, offset] {
            let with_zero = |of: &Hypothesis, d: f64| {
                let mut out = of.clone();
                out.fit.augmented.equation_columns.push(zero.clone());
                out.fit.linear.d.push(d);
                out
            };
            assert!(
                !plan.degrades_validation(&with_zero(good, 0.3))
                    && plan.degrades_validation(&with_zero(&poor, 0.0))
            );
        }
        let mut off = good.clone();
        off.fit.linear.f.iter_mut().for_each(|f| *f += 0.3);
        assert!(plan.degrades_validation(&off));
        for effect in [Effect::Backlash, Effect::ColouredNoise] {
            assert!(plan.is_gain(&good.fit, &poor.fit, effect));
            assert!(
                !plan.is_gain(&poor.fit, &good.fit, effect) && !plan.is_gain(&good.fit, &good.fit, effect)
            );
        }
        let both = Causes {
            effects: vec![Effect::SensorSaturation, Effect::Backlash],
            correction: None,
            rival: None,
        };
        let alone = |fit: &Fit| {
            let mut clipping = Hypothesis::detailed(fit.clone());
            clipping.effect_terms[0].effect = Effect::SensorSaturation;
            [clipping]
        };
        assert!(!plan.second_shows(good, &both, &alone(&good.fit)));
        assert!(plan.second_shows(good, &both, &alone(&poor.fit)));
        // Neither reads wrongly: nothing is asked.
        let others = Causes { effects: vec![Effect::Creep, Effect::Backlash], ..both };
        assert!(plan.second_shows(good, &others, &alone(&good.fit)));
    }
}
