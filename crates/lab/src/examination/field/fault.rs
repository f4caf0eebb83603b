//! A fault as it is put in, and what the base's model makes of it.

use super::key::PutIn;
use super::made;
use crate::examination::how::How;
use crate::examination::wanted::Wanted;
use crate::generate::InjectedFault;
use switchback_identify::free::{FreeError, Identified, InputMap, Model, Settings, identify};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Usage};

/// What the default of `identify` gives.
pub(super) fn nominal(rig: &Rig) -> Result<Identified, String> {
    let records: Vec<&Record> = rig.fit_records().map(|record| &record.record).collect();
    let open = Settings {
        order: rig.order,
        interval: rig.interval,
        input_noise: false,
        ..Settings::new(InputMap::Borders)
    };
    identify(&records, &open).map_err(|error: FreeError| error.to_string())
}

/// A fault that the maker simulates in the machine itself.
pub(super) fn by_maker(seed: u64, fault: &Wanted) -> Result<PutIn, String> {
    let found = made::with_fault(seed, fault).map_err(reported)?;
    let model = nominal(&found.before)?.model;
    let differences = left(&model, &found.rig).zip(left(&model, &found.before)).map(|(now, then)| now - then);
    let raw = (mean_square(differences) / mean_square(left(&model, &found.before))).sqrt();
    let put_in = found.key.effects.first().ok_or("the maker put nothing in")?;
    Ok(PutIn {
        effect: put_in.effect.to_owned(),
        law: put_in.law.to_owned(),
        how: How::Made,
        magnitude: put_in.magnitude,
        unit: put_in.unit.to_owned(),
        wanted: put_in.wanted,
        size: put_in.size,
        raw,
        noise_sd: Some(found.key.noise_sd),
    })
}

pub(super) fn injected(fault: InjectedFault) -> PutIn {
    PutIn {
        effect: fault.effect.to_owned(),
        law: fault.law.to_owned(),
        how: if fault.injection.is_exact() { How::Exact } else { How::Carried },
        magnitude: fault.magnitude,
        unit: fault.unit.to_owned(),
        wanted: fault.wanted,
        size: fault.size,
        raw: fault.raw,
        noise_sd: None,
    }
}

pub(super) fn reported(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Simulation errors of a model on the held-out records, all where none is held out.
pub(super) fn left<'r>(model: &'r Model, rig: &'r Rig) -> impl Iterator<Item = f64> + 'r {
    let any = rig.holdout_records().next().is_some();
    let judged = rig.records.iter().filter(move |r| !any || r.usage == Usage::Holdout);
    judged.flat_map(move |record: &RigRecord| {
        let run = model.free_run(&record.record);
        let y = record.record.y();
        (0..y.len()).map(move |t| if t < run.start { 0.0 } else { y[t] - run.y[t] }).collect::<Vec<f64>>()
    })
}

pub(super) fn mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), x| (sum + x * x, count + 1));
    sum / count.max(1) as f64
}
