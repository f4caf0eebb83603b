//! A measured base as its model would have it: the simulation, and residuals in another order.

use crate::examination::random::scramble;
use switchback_identify::free::Model;
use switchback_identify::statistics::MeanInterval;
use switchback_model::Record;
use switchback_model::record::RecordError;
use switchback_model::rig::{Rig, RigRecord};

/// The rig with `y = ŷ + r*`: `ŷ` the free run of a model, `r*` its residuals drawn anew in circular blocks (Politis and Romano 1992), whose
/// length is that of [`MeanInterval::of_remembering`]. Noise stays what it is, and whatever hangs together for longer than a block is torn apart:
/// nothing is left that a cause could explain. Samples before the free run stay. `run` gives the free run and the first sample that it simulates;
/// a record without one stays as it is.
pub(crate) fn resampled(
    rig: &Rig,
    run: impl Fn(&Record) -> Option<(Vec<f64>, usize)>,
    seed: u64,
) -> Result<Rig, RecordError> {
    let with = |(number, record): (usize, &RigRecord)| {
        let y = match run(&record.record) {
            Some(run) => redrawn(record.record.y(), run, scramble(seed, number as u64)),
            None => record.record.y().to_vec(),
        };
        let record_anew = Record::new(record.record.v().to_vec(), y)?;
        Ok(RigRecord { record: record_anew, predicted: None, ..record.clone() })
    };
    let records = rig.records.iter().enumerate().map(with).collect::<Result<_, RecordError>>()?;
    Ok(Rig { records, ..rig.clone() })
}

/// The free run of an identified model, as [`resampled`] takes it.
pub(crate) fn runs_of(model: &Model) -> impl Fn(&Record) -> Option<(Vec<f64>, usize)> {
    |record| {
        let run = model.free_run(record);
        Some((run.y, run.start))
    }
}

fn redrawn(measured: &[f64], (simulated, start): (Vec<f64>, usize), seed: u64) -> Vec<f64> {
    let mut y = measured.to_vec();
    let left: Vec<f64> =
        y[start..].iter().zip(&simulated[start..]).map(|(y, simulated)| y - simulated).collect();
    let Some(interval) = MeanInterval::of_remembering(&[&left], 1) else { return y };
    for t in 0..left.len() {
        let (block, within) = (t / interval.block, t % interval.block);
        let first = (scramble(seed, block as u64) % left.len() as u64) as usize;
        y[start + t] = simulated[start + t] + left[(first + within) % left.len()];
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{InjectionContext, MakeRig};

    #[test]
    fn residuals_are_the_same_in_another_order() {
        let rig = MakeRig::new(7).make().expect("a rig").rig;
        let context = InjectionContext::new(&rig).expect("a model");
        let model = &context.identified().model;
        let anew = resampled(&rig, runs_of(model), 3).expect("records");
        for (record, before) in anew.records.iter().zip(&rig.records) {
            let run = model.free_run(&before.record);
            let left = |y: &[f64]| -> Vec<f64> {
                y.iter().zip(&run.y).skip(run.start).map(|(y, x)| y - x).collect()
            };
            let (now, then) = (left(record.record.y()), left(before.record.y()));
            let known =
                |x: &f64| then.iter().any(|other| (x - other).abs() < 1e-9 * (1.0 + run.y[run.start].abs()));
            assert!(now != then && now.iter().all(known), "{}", record.name);
            assert_eq!(record.record.v(), before.record.v());
        }
        assert_eq!(anew, resampled(&rig, runs_of(model), 3).expect("records"));
        assert_ne!(anew, resampled(&rig, runs_of(model), 4).expect("records"));
    }
}
