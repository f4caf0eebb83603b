use super::*;
use crate::generate::law::Amount;
use crate::generate::simulate::Active;
use crate::generate::{EFFECTS, FOREIGN, FURTHER_FOREIGN, MakeRig, Setting, UNNAMED};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fmt::Write;
use switchback_io::output::sha256;
use switchback_model::record::Record;
use switchback_model::rig::Usage;

fn rigs(count: u64) -> Vec<TrainingRig> {
    let bases = MeasuredBases::default();
    (0..count).into_par_iter().filter_map(|index| draw(7, index, &bases)).collect()
}

/// Samples to four digits: what a golden hash pins beyond the last bits of a mathematical library.
fn digest(rigs: &[TrainingRig]) -> String {
    let mut text = String::new();
    for TrainingRig { rig, is_given, truth, .. } in rigs {
        let _ = write!(text, "{:?} {:?} {is_given}", truth.kind, truth.label());
        for record in &rig.records {
            for x in record.record.y().iter().step_by(50).chain(record.record.v().iter().step_by(50)) {
                let _ = write!(text, " {x:.3e}");
            }
        }
    }
    sha256(text)[..16].to_owned()
}

#[test]
fn a_number_gives_one_rig_at_any_number_of_threads() {
    let parallel = rigs(24);
    let bases = MeasuredBases::default();
    let serial: Vec<TrainingRig> = (0..24).filter_map(|index| draw(7, index, &bases)).collect();
    assert_eq!(parallel, serial);
    assert_eq!(digest(&serial), "48477d70ff050ca0");
}

#[test]
fn what_is_drawn_is_a_rig_that_a_user_could_have() {
    let rigs = rigs(160);
    assert!(rigs.len() >= 158, "{}", rigs.len());
    let (mut kinds, mut families) = (BTreeSet::new(), BTreeSet::new());
    for TrainingRig { rig, before, is_given, truth } in &rigs {
        kinds.insert(truth.kind);
        families.insert(truth.family);
        assert!(rig.records.iter().any(|r| r.usage == Usage::Fit), "{truth:?}");
        assert!(rig.records.iter().any(|r| r.usage == Usage::Holdout), "{truth:?}");
        assert!(rig.records.iter().all(|r| r.predicted.is_some() == *is_given), "{truth:?}");
        assert_eq!(rig.records.len(), before.records.len());
        assert_eq!(
            truth.kind == Kind::Nothing,
            rig.records.iter().zip(&before.records).all(|(a, b)| a.record == b.record)
        );
        assert_eq!(truth.effects.is_empty(), truth.kind == Kind::Nothing);
        assert!(truth.effects.windows(2).all(|w| w[0].size >= w[1].size), "{truth:?}");
        assert!((1e-5..1.5).contains(&truth.noise), "{truth:?}");
    }
    assert_eq!(kinds.len(), 4);
    assert_eq!(families.len(), 3);
    let met = |t: &TrainingTruth| t.effects.first().is_some_and(|e| (e.size / e.wanted).ln().abs() < 0.4);
    let asked = rigs.iter().filter(|r| r.truth.kind == Kind::One).count();
    let close = rigs.iter().filter(|r| r.truth.kind == Kind::One && met(&r.truth)).count();
    assert!(close * 10 >= asked * 8, "{close} of {asked}");
}

#[test]
fn every_effect_has_three_laws_and_of_magnitude_zero_each_changes_nothing() {
    assert!(FOREIGN.len() + FURTHER_FOREIGN.len() >= 14);
    let setup = made::wide(5, &[], 1.0).expect("a machine");
    let before = setup.signals(&[]);
    for effect in EFFECTS.into_iter().chain(UNNAMED).chain(FOREIGN).chain(FURTHER_FOREIGN) {
        let laws = cause::all_laws(effect);
        let least = if FOREIGN.contains(&effect) || FURTHER_FOREIGN.contains(&effect) { 1 } else { 3 };
        assert!(laws.len() >= least, "{effect}");
        for law in laws {
            assert_eq!(law.effect(), effect);
            let none =
                Active { law, amount: Amount { magnitude: 0.0, shape: [0.2, 0.7, 0.4, 0.9] }, slot: 0 };
            assert!(setup.signals(&[none]) == before, "{effect} {}", law.name());
            let some = |first: f64| {
                let amount = Amount { magnitude: law.limit().min(1e3), shape: [first, 0.7, 0.4, 0.9] };
                setup.signals(&[Active { amount, ..none }]) != before
            };
            assert!(some(0.2) || some(0.8), "{effect} {}", law.name());
        }
    }
}

#[test]
fn the_projection_leaves_nothing_of_a_change_of_the_nominal_system() {
    let setup = made::wide(5, &[], 1.0).expect("a machine");
    let anew = reidentification::Reidentification::new(&setup).expect("derivatives");
    let run = |machine: &crate::generate::Machine| -> Vec<Vec<f64>> {
        let output = |run: &setup::Run| {
            let y = crate::generate::simulate::simulate(
                machine,
                &[],
                &run.passage,
                1,
                crate::generate::simulate::Noise::None,
            )
            .y;
            run.passage.recorded(&y).to_vec()
        };
        setup.runs.iter().map(output).collect()
    };
    let mut slower = setup.machine.clone();
    slower.a[0] *= 1.0 + 1e-4;
    let change: Vec<Vec<f64>> = run(&slower)
        .iter()
        .zip(run(&setup.machine))
        .map(|(with, without)| with.iter().zip(without).map(|(w, o)| w - o).collect())
        .collect();
    let rms = (change.iter().flatten().map(|x| x * x).sum::<f64>()
        / change.iter().map(Vec::len).sum::<usize>() as f64)
        .sqrt();
    assert!(rms > 0.0);
    assert!(anew.left(&change) < 0.02 * rms, "{} of {rms}", anew.left(&change));
}

/// The oracle of sizes: the program's own identification, anew with the cause and without. It has more freedom than the projection (order,
/// delay, places of knots) and may end elsewhere, so that single sizes differ by a lot.
#[test]
fn sizes_are_those_of_identification_anew_in_the_middle() {
    let samples = |rig: &TrainingRig| rig.rig.records.iter().map(|r| r.record.len()).sum::<usize>();
    let mut ratios: Vec<f64> = rigs(50)
        .into_par_iter()
        .filter(|rig| samples(rig) < 3500 && (1.0..30.0).contains(&rig.truth.size))
        .filter_map(|rig| Some(rig.identified_size().ok()? / rig.truth.size))
        .collect();
    ratios.sort_by(f64::total_cmp);
    assert!(ratios.len() >= 10, "{ratios:?}");
    assert!((0.4..2.0).contains(&ratios[ratios.len() / 2]), "{ratios:?}");
    assert!(ratios.iter().filter(|ratio| **ratio < 2.0).count() * 4 >= 3 * ratios.len(), "{ratios:?}");
}

#[test]
fn nothing_survives_that_either_identification_takes() {
    let samples = |rig: &TrainingRig| rig.rig.records.iter().map(|r| r.record.len()).sum::<usize>();
    let rigs: Vec<TrainingRig> = rigs(16).into_iter().filter(|rig| samples(rig) < 3500).collect();
    let sizes: Vec<[f64; 3]> = rigs
        .par_iter()
        .with_max_len(1)
        .map(|rig| [rig.surviving_size(), rig.truth.size, rig.identified_size().unwrap_or(f64::INFINITY)])
        .collect();
    assert!(sizes.iter().all(|[size, first_order, identified]| *size == first_order.min(*identified)));
    assert!(sizes.iter().any(|[size, first_order, _]| size < first_order), "{sizes:?}");
    let nothing = |rig: &&TrainingRig| rig.truth.kind == Kind::Nothing;
    assert!(rigs.iter().filter(nothing).all(|rig| rig.surviving_size() == 0.0));
}

#[test]
fn half_of_a_population_stands_on_measured_bases_where_there_are_any() {
    let bench = MakeRig::new(3).setting(Setting::Field).make().expect("a rig").rig;
    let mut flat = bench.clone();
    flat.records.truncate(1);
    flat.records[0].record = Record::new(vec![0.5; 400], vec![1.0; 400]).expect("a record");
    let (bases, refused) =
        MeasuredBases::identified(vec![("bench".to_owned(), bench.clone()), ("flat".to_owned(), flat)]);
    assert_eq!(bases.names().collect::<Vec<_>>(), ["bench"]);
    assert_eq!(refused.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["flat"]);
    let rigs: Vec<TrainingRig> = (0..80).into_par_iter().filter_map(|index| draw(7, index, &bases)).collect();
    let on_measured = rigs.iter().filter(|rig| rig.truth.family.is_measured()).count();
    assert!(rigs.len() >= 78 && (28..52).contains(&on_measured), "{on_measured} of {}", rigs.len());
    for TrainingRig { before, truth, .. } in rigs.iter().filter(|rig| rig.truth.family.is_measured()) {
        assert_eq!(truth.base, "bench");
        for record in &before.records {
            // The input is a window of a measured one; of measured records the output is too.
            let (v, y) = (record.record.v(), record.record.y());
            let is_window = |source: &[f64], x: &[f64]| source.windows(x.len()).any(|window| window == x);
            let sources = || bench.records.iter().map(|source| &source.record);
            assert!(sources().any(|source| is_window(source.v(), v)), "{truth:?}");
            let is_measured = sources().any(|source| is_window(source.y(), y));
            assert_eq!(is_measured, truth.family == Family::Measured, "{truth:?}");
        }
    }
    let again: Vec<TrainingRig> = (0..12).filter_map(|index| draw(7, index, &bases)).collect();
    assert_eq!(again[..], rigs[..again.len()]);
}
