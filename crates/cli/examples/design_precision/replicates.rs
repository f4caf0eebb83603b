//! Machines of known truth, and how well a planned dataset identifies them, over many replicates.

use rayon::prelude::*;
use std::path::Path;
use switchback_identify::excitation::{Dataset, PlannedRecord};
use switchback_identify::pulse::{PulseData, PulseMethod};
use switchback_model::Record;
use switchback_model::hysteresis::{
    BorderPair, Interval, LeafSpring, NonMonotone, Relay, SwitchedHysteresis, Wave,
};
use switchback_model::linear::{LinearSystem, filter};
use switchback_model::rig::{Rig, RigRecord};
use switchback_noise::{StreamId, white_samples};
use switchback_study::design::{Forecast, Length, Plan, PlanMethod, Request, Truth};

/// A machine whose truth is known.
pub(crate) struct Machine {
    /// What it is called.
    pub(crate) name: &'static str,
    /// Its linear part.
    pub(crate) system: LinearSystem,
    /// Its borders.
    pub(crate) hysteresis: SwitchedHysteresis,
    /// Standard deviation of its equation error, output units.
    pub(crate) noise_sd: f64,
    /// Levels to visit on each border.
    pub(crate) points: usize,
    /// The precision to plan for.
    pub(crate) precision: f64,
}

/// Orders 1 to 3, borders of four kinds, noise from a hundredth of the output's span to a tenth and more.
pub(crate) fn machines() -> Vec<Machine> {
    let wave = Wave { offset: 0.3, slope: 0.5, amplitude: 0.3, wavelength: 1.5, phase: 0.0 };
    vec![
        machine(
            "first order, relay",
            (&[-0.7], &[0.5]),
            (-1.0, 1.0),
            Relay::new((-0.4, 0.6), 0.3, -0.2),
            0.05,
        )
        .planned(5, 0.01),
        machine(
            "second order, leaf spring",
            (&[-1.2, 0.5], &[0.4, 0.2]),
            (-40.0, 40.0),
            LeafSpring::hardening(0.2, 1e-4, 2.0),
            2.0,
        )
        .planned(8, 0.02),
        machine(
            "second order, resonant",
            (&[-1.5, 0.9], &[0.3, 0.1]),
            (0.0, 5.0),
            LeafSpring::constant(0.3, 0.4),
            0.4,
        )
        .planned(6, 0.03),
        machine(
            "third order, borders that turn",
            (&[-1.8, 1.3, -0.4], &[0.2, 0.1, 0.05]),
            (-1.0, 1.0),
            NonMonotone::new(wave, Wave { offset: -0.3, ..wave }),
            0.02,
        )
        .planned(8, 0.01),
    ]
}

fn machine<B: BorderPair + 'static, E: std::fmt::Debug>(
    name: &'static str,
    (a, b): (&[f64], &[f64]),
    (low, high): (f64, f64),
    borders: Result<B, E>,
    noise_sd: f64,
) -> Machine {
    let interval = Interval::new(low, high).expect("an interval");
    let borders = Box::new(borders.expect("borders"));
    Machine {
        name,
        system: LinearSystem::new(a.to_vec(), b.to_vec()).expect("a stable system"),
        hysteresis: SwitchedHysteresis::new(interval, borders).expect("Assumption 1"),
        noise_sd,
        points: 0,
        precision: 0.0,
    }
}

impl Machine {
    fn planned(self, points: usize, precision: f64) -> Self {
        Self { points, precision, ..self }
    }

    /// The machine that an identification takes for the true one.
    pub(crate) fn believed(truth: &Truth, like: &Self) -> Self {
        Self {
            name: like.name,
            system: truth.system.clone(),
            hysteresis: truth.hysteresis.clone(),
            noise_sd: truth.noise_sd,
            ..*like
        }
    }

    /// What to design for it.
    pub(crate) fn request(&self) -> Request {
        Request {
            name: self.name.to_owned(),
            order: self.system.order(),
            points: self.points,
            interval: self.hysteresis.interval(),
            sample_time: 0.01,
            labels: ["travel [mm]".to_owned(), "force [N]".to_owned()],
            amplitude: None,
            max_speed: None,
            free_only: false,
            seed: 1,
        }
    }

    /// The output for an input that begins at an end of the interval, where the machine has rested long.
    pub(crate) fn measure(&self, v: &[f64], stream: StreamId) -> Vec<f64> {
        let resting = if v[0] == self.hysteresis.interval().low() {
            self.hysteresis.u_low()
        } else {
            self.hysteresis.u_high()
        };
        let rest = self.system.settling_samples(1e-12);
        let mut u = vec![resting; rest];
        u.extend(self.hysteresis.output(v, resting));
        let xi: Vec<f64> = white_samples(stream, u.len()).iter().map(|w| self.noise_sd * w).collect();
        let held = self.system.static_gain() * resting;
        filter(self.system.a(), self.system.b(), &u, &xi, held, resting).split_off(rest)
    }

    /// All records of a plan, measured on it.
    pub(crate) fn dataset(&self, plan: &Plan, seed: u64) -> Rig {
        let request = plan.request();
        let record = |(k, record): (usize, PlannedRecord)| {
            let y = self.measure(&record.v, StreamId { seed, experiment: k as u32, replicate: 0 });
            RigRecord {
                name: record.name.to_owned(),
                role: record.role,
                usage: record.usage,
                record: Record::new(record.v, y).expect("finite samples"),
                predicted: None,
            }
        };
        Rig {
            name: request.name.clone(),
            sample_time: request.sample_time,
            order: Some(request.order),
            interval: Some(request.interval),
            input_label: request.labels[0].clone(),
            output_label: request.labels[1].clone(),
            records: plan.records().into_iter().enumerate().map(record).collect(),
        }
    }

    /// `a`, `b` and the borders at the levels of a plan, for `u_M − u_m = 1`.
    fn parameters(&self, dataset: &Dataset) -> Vec<f64> {
        let span = self.hysteresis.span();
        let mut all = self.system.a().to_vec();
        all.extend(self.system.b().iter().map(|b| b * span));
        for pulses in dataset.pulses() {
            let branch = pulses.direction().visited_branch();
            all.extend(pulses.levels().iter().map(|v| self.hysteresis.border(branch, *v) / span));
        }
        all
    }

    /// Root mean square error of every parameter over replicates of both pulse experiments, identified from their records.
    pub(crate) fn errors(&self, dataset: &Dataset, method: PlanMethod, replicates: u32) -> Vec<f64> {
        let truth = self.parameters(dataset);
        let order = self.system.order();
        let inputs = dataset.pulses().each_ref().map(|p| p.record_input(dataset.samples()));
        let estimate = |replicate: u32| -> Vec<f64> {
            let data = [0, 1].map(|k: usize| {
                let stream = StreamId { seed: 2009, experiment: k as u32, replicate };
                let y = self.measure(&inputs[k], stream);
                let record = Record::new(inputs[k].clone(), y).expect("finite samples");
                let branch = dataset.pulses()[k].direction().visited_branch();
                PulseData::from_record(&record, branch, order, 0).expect("a pulse experiment")
            });
            let fit = match method {
                PlanMethod::Efficient => PulseMethod::Efficient(&[&data[0], &data[1]]).fit(),
                PlanMethod::Joint => PulseMethod::Joint { descendant: &data[0], ascendant: &data[1] }.fit(),
            };
            fit.expect("an excited system").parameters().map(|x| x.value).collect()
        };
        let estimates: Vec<Vec<f64>> = (0..replicates).into_par_iter().map(estimate).collect();
        (0..truth.len())
            .map(|k| {
                let squares: f64 = estimates.iter().map(|e| (e[k] - truth[k]).powi(2)).sum();
                (squares / f64::from(replicates)).sqrt()
            })
            .collect()
    }
}

/// A plan made from a pilot of the default length on a machine: what it believes, its length and its prediction.
pub(crate) struct Planned {
    /// What the pilot was identified as.
    pub(crate) believed: Machine,
    /// The plan that reaches the precision.
    pub(crate) plan: Plan,
    /// Predicted standard errors.
    pub(crate) predicted: Vec<f64>,
}

impl Planned {
    /// Measures a pilot, identifies it, and plans for the machine's precision.
    pub(crate) fn after_a_pilot(machine: &Machine, method: PlanMethod, seed: u64) -> Self {
        let pilot = Plan::new(machine.request(), Length::Periods(100)).expect("a pilot");
        let truth = Truth::of(&machine.dataset(&pilot, seed), Path::new("pilot")).expect("a system");
        let forecast = Forecast::new(&truth, pilot.dataset().pulses(), method).expect("a forecast");
        let periods = forecast.periods_for(machine.precision);
        let plan = Plan::new(machine.request(), Length::Periods(periods)).expect("a plan");
        let predicted = forecast.at(periods).errors.all().collect();
        Self { believed: Machine::believed(&truth, machine), plan, predicted }
    }

    /// Achieved over predicted, one ratio a parameter, over replicates measured on `machine`.
    pub(crate) fn ratios(&self, machine: &Machine, method: PlanMethod, replicates: u32) -> Vec<f64> {
        let achieved = machine.errors(self.plan.dataset(), method, replicates);
        achieved.iter().zip(&self.predicted).map(|(a, p)| a / p).collect()
    }
}

/// Root mean square.
pub(crate) fn rms(ratios: &[f64]) -> f64 {
    (ratios.iter().map(|r| r * r).sum::<f64>() / ratios.len() as f64).sqrt()
}
