//! The model that carries faults into measured records.

use super::base::Base;
use super::injection_error::InjectionError;
use crate::generate::dataset::{Passage, lead_in, one_after_the_other};
use crate::generate::machine::{Machine, Shape, Table};
use switchback_identify::free::{InputMap, Model, Settings, identify};
use switchback_model::hysteresis::{Interval, SwitchedHysteresis};
use switchback_model::rig::{Rig, RigRecord};

/// Knots of each border: more than a diagnosis would choose.
const KNOTS: usize = 17;

/// A machine that is close to the measured one and lies outside the candidates' class.
#[derive(Debug)]
pub(crate) struct HostModel {
    /// The model that it was made of.
    pub(crate) model: Model,
    pub(crate) machine: Machine,
    /// The records as passages, in the rig's order.
    pub(crate) passages: Vec<Passage>,
}

impl HostModel {
    /// Identifies the host model: one pole more than the base's model and many knots; where no such model has a loop, it is the base's own.
    pub(super) fn identified(rig: &Rig, base: &Base) -> Result<Self, InjectionError> {
        let structure = base.identified.selection.structure;
        let rule = base.identified.model.rule();
        let settings = Settings {
            order: Some(structure.order + 1),
            delay: Some(structure.delay),
            knots: Some(KNOTS),
            threshold: Some(rule.threshold),
            timing: Some(rule.timing),
            interval: rig.interval,
            undersmooth: false,
            input_noise: false,
            ..Settings::new(InputMap::Borders)
        };
        let records: Vec<_> = rig.fit_records().map(|r| &r.record).collect();
        let larger = identify(&records, &settings).ok().and_then(|found| Self::of(rig, &found.model).ok());
        larger.map_or_else(|| Self::of(rig, &base.identified.model), Ok)
    }

    /// A model as the host model.
    pub(crate) fn of(rig: &Rig, model: &Model) -> Result<Self, InjectionError> {
        let mut machine = machine(model, rig)?;
        let lead = (-model.structure().delay).max(0) as usize;
        let passages = passages(rig, &machine, (lead, model.rule().threshold));
        machine.noise_sd = equation_error(&machine, &passages, rig);
        let centre = machine.y_centre();
        machine.reach = outputs(rig).map(|y| (y - centre).abs()).fold(0.0, f64::max);
        Ok(Self { model: model.clone(), machine, passages })
    }
}

fn outputs(rig: &Rig) -> impl Iterator<Item = f64> + '_ {
    rig.records.iter().flat_map(|r| r.record.y().iter().copied())
}

/// The model as a machine: its constant becomes part of `u`, its extra delay leading zeros of `B`.
fn machine(model: &Model, rig: &Rig) -> Result<Machine, InjectionError> {
    let basis = model.basis();
    let (down, up) = (basis.descending(), basis.ascending());
    let coefficients = model.coefficients();
    let mut f = vec![0.0];
    f.extend(&coefficients.f);
    let (of_down, of_up) = f.split_at(down.len());
    let mut levels = [down, up].concat();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let along = |knots: &[f64], values: &[f64]| -> Vec<f64> {
        let curve = Table { levels: knots.to_vec(), ascending: values.to_vec(), descending: Vec::new() };
        levels.iter().map(|v| curve.between(&curve.ascending, *v)).collect()
    };
    let (mut descending, mut ascending) = (along(down, of_down), along(up, of_up));
    let gain: f64 = coefficients.b.iter().sum();
    let offset = if gain == 0.0 { 0.0 } else { coefficients.c / gain };
    let span = ascending[levels.len() - 1] - descending[0];
    // The paper's normalisation; a border that falls where the other rises turns the sign of both.
    let scale = if span == 0.0 { 1.0 } else { span };
    for u in descending.iter_mut().chain(&mut ascending) {
        *u = (*u + offset) / scale;
    }
    let mut b = vec![0.0; model.structure().delay.max(0) as usize];
    b.extend(coefficients.b.iter().map(|b| b * scale));
    let mut a = coefficients.a;
    let order = a.len().max(b.len());
    a.resize(order, 0.0);
    b.resize(order, 0.0);
    let interval = Interval::new(levels[0], levels[levels.len() - 1]).expect("knots rise");
    let table = Table { levels: levels.clone(), ascending, descending };
    let hysteresis = SwitchedHysteresis::new(interval, Box::new(table))?;
    Ok(Machine {
        a,
        b,
        hysteresis,
        interval,
        levels,
        noise_sd: 0.0,
        reach: 0.0,
        sample_time: rig.sample_time,
        shape: Shape::General,
        curved: false,
    })
}

/// The records with their lead-ins. The input is led by the samples that the output precedes it, and follows moves beyond the threshold of
/// reversals only: noise on `v` must not switch the borders.
pub(crate) fn passages(rig: &Rig, machine: &Machine, (lead, threshold): (usize, f64)) -> Vec<Passage> {
    let settle = machine.settling();
    let passage = |(index, record): (usize, &RigRecord)| {
        let recorded = quiet(record.record.v(), threshold);
        let last = recorded.len() - 1;
        let led = (0..=last).map(|t| recorded[(t + lead).min(last)]).collect();
        let lead_in = lead_in(machine.interval, recorded[0], settle);
        Passage::of(index, record.name.clone(), (record.role, record.usage), (lead_in, led))
    };
    one_after_the_other(rig.records.iter().enumerate().map(passage).collect())
}

/// An input behind a play as wide as the threshold.
pub(crate) fn quiet(v: &[f64], threshold: f64) -> Vec<f64> {
    let half = 0.5 * threshold;
    let mut at = v[0];
    v.iter()
        .map(|&now| {
            at = at.clamp(now - half, now + half);
            at
        })
        .collect()
}

/// Standard deviation of `A y − B u` over the records: the noise that laws measure themselves against.
fn equation_error(machine: &Machine, passages: &[Passage], rig: &Rig) -> f64 {
    let (mut sum, mut count) = (0.0, 0_usize);
    for (passage, record) in passages.iter().zip(&rig.records) {
        let u = machine.hysteresis.output(&passage.v, machine.hysteresis.u_low());
        let (u, y) = (passage.recorded(&u), record.record.y());
        for t in machine.order()..y.len() {
            let past = |i: usize| machine.a[i] * y[t - 1 - i] - machine.b[i] * u[t - 1 - i];
            let error = y[t] + (0..machine.order()).map(past).sum::<f64>();
            sum += error * error;
            count += 1;
        }
    }
    (sum / count.max(1) as f64).sqrt()
}
