//! Records with a fault.

use super::PlantingError;
use super::carrier::Carrier;
use crate::generate::campaign::Passage;
use crate::generate::law::{Planting, Scene};
use crate::generate::simulate::{Active, Noise, simulate};
use crate::generate::stream::{Purpose, stream};
use switchback_model::record::Record;
use switchback_model::rig::{Rig, RigRecord};

/// The rig's records with an effect in each.
pub(super) fn altered(
    rig: &Rig,
    carrier: &Carrier,
    active: &Active,
    seed: u64,
) -> Result<Rig, PlantingError> {
    let with = |(record, passage): (&RigRecord, &Passage)| {
        let (v, y) = signals(carrier, (record, passage), active, seed);
        Ok(RigRecord { record: Record::new(v, y)?, predicted: None, ..record.clone() })
    };
    let records =
        rig.records.iter().zip(&carrier.passages).map(with).collect::<Result<_, PlantingError>>()?;
    Ok(Rig { records, ..rig.clone() })
}

/// Input and output of a record with the effect.
fn signals(
    carrier: &Carrier,
    (record, passage): (&RigRecord, &Passage),
    active: &Active,
    seed: u64,
) -> (Vec<f64>, Vec<f64>) {
    let (mut v, mut y) = (record.record.v().to_vec(), record.record.y().to_vec());
    // The record without its lead-in, for what acts on the measured signals themselves.
    let alone = Passage {
        v: passage.recorded(&passage.v).to_vec(),
        lead: 0,
        start: passage.start + passage.lead,
        ..passage.clone()
    };
    let rng = stream(seed, Purpose::Effect { effect: active.slot, record: passage.index });
    let mut scene = Scene { plant: &carrier.plant, passage: &alone, dose: active.dose, rng };
    match active.law.planting() {
        Planting::Reading => active.law.sensor(&mut scene, &mut y),
        Planting::Gain => active.law.dynamics(&mut scene, &mut y),
        Planting::Recording => active.law.recording(&mut scene, &mut v),
        Planting::Carried => {
            let run = |effects: &[Active]| {
                let trace = simulate(&carrier.plant, effects, passage, seed, Noise::Recorded);
                passage.recorded(&trace.y).to_vec()
            };
            let (without, with) = (run(&[]), run(std::slice::from_ref(active)));
            y.iter_mut().zip(with.iter().zip(&without)).for_each(|(y, (with, without))| *y += with - without);
        }
    }
    (v, y)
}
