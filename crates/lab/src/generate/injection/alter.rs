//! Records with a fault.

use super::InjectionError;
use super::host_model::HostModel;
use crate::generate::dataset::Passage;
use crate::generate::law::{Injection, Scene};
use crate::generate::machine::Machine;
use crate::generate::simulate::{Active, Noise, simulate};
use crate::generate::stream::{Purpose, stream};
use switchback_model::record::Record;
use switchback_model::rig::{Rig, RigRecord};

/// The rig's records with an effect in each.
pub(super) fn altered(
    rig: &Rig,
    host_model: &HostModel,
    active: &Active,
    seed: u64,
) -> Result<Rig, InjectionError> {
    let with = |(record, passage): (&RigRecord, &Passage)| {
        let (mut v, mut y) = (record.record.v().to_vec(), record.record.y().to_vec());
        alter(&host_model.machine, passage, (active, seed), (&mut v, &mut y));
        Ok(RigRecord { record: Record::new(v, y)?, predicted: None, ..record.clone() })
    };
    let records =
        rig.records.iter().zip(&host_model.passages).map(with).collect::<Result<_, InjectionError>>()?;
    Ok(Rig { records, ..rig.clone() })
}

/// Puts the effect into input and output of a record.
pub(crate) fn alter(
    machine: &Machine,
    passage: &Passage,
    (active, seed): (&Active, u64),
    (v, y): (&mut [f64], &mut [f64]),
) {
    // The record without its lead-in, for what acts on the measured signals themselves.
    let alone = Passage {
        v: passage.recorded(&passage.v).to_vec(),
        lead: 0,
        start: passage.start + passage.lead,
        ..passage.clone()
    };
    let rng = stream(seed, Purpose::Effect { effect: active.slot, record: passage.index });
    let mut scene = Scene { machine, passage: &alone, amount: active.amount, rng };
    match active.law.injection() {
        Injection::Reading => active.law.sensor(&mut scene, y),
        Injection::Gain => active.law.dynamics(&mut scene, y),
        Injection::Recording => active.law.recording(&mut scene, v),
        Injection::Carried => {
            let run = |effects: &[Active]| {
                let trace = simulate(machine, effects, passage, seed, Noise::Recorded);
                passage.recorded(&trace.y).to_vec()
            };
            let (without, with) = (run(&[]), run(std::slice::from_ref(active)));
            y.iter_mut().zip(with.iter().zip(&without)).for_each(|(y, (with, without))| *y += with - without);
        }
    }
}
