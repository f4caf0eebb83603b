use super::alter::altered;
use super::*;
use crate::generate::dataset::Plan;
use crate::generate::effects::{EFFECTS, FOREIGN, laws_of};
use crate::generate::law::Amount;
use crate::generate::make::MakeRig;
use crate::generate::simulate::{Active, Noise, simulate};
use switchback_identify::free::FreeError;
use switchback_model::record::Record;
use switchback_model::rig::{RigRecord, Role, Usage};

const SMALL: Plan = Plan { step: 200, periods: 10, sweep: 2500, drive: 1500, repeat_periods: 4 };

/// A rig without effects, whose seed gives a system of a loop that every law can act on.
fn plain() -> MakeRig {
    MakeRig::new(7).plan(SMALL)
}

fn active(effect: &str, law: usize, magnitude: f64) -> Active {
    let shape = [0.3, 0.6, 0.2, 0.8];
    Active { law: laws_of(effect)[law], amount: Amount { magnitude, shape }, slot: 0 }
}

fn root_mean_square(x: impl Iterator<Item = f64>) -> f64 {
    let all: Vec<f64> = x.collect();
    (all.iter().map(|x| x * x).sum::<f64>() / all.len() as f64).sqrt()
}

#[test]
fn of_magnitude_zero_every_law_leaves_the_records_as_they_were() {
    let rig = plain().make().expect("a rig").rig;
    let context = InjectionContext::new(&rig).expect("a model");
    for effect in EFFECTS.iter().chain(&FOREIGN) {
        for law in 0..laws_of(effect).len() {
            let same = altered(&rig, &context.host_model, &active(effect, law, 0.0), 3).expect("records");
            for (one, other) in same.records.iter().zip(&rig.records) {
                assert!(one.record == other.record, "{effect} {law}");
            }
        }
    }
}

/// The oracle: the same law on the true system.
#[test]
fn what_is_carried_is_what_the_true_system_would_do() {
    let generator = plain().generator();
    let rig = plain().make().expect("a rig").rig;
    let context = InjectionContext::new(&rig).expect("a model");
    for (effect, magnitude) in [("extra_pole", 0.7), ("border_wear", 0.5), ("resonance", 0.5)] {
        let with = active(effect, 0, magnitude);
        let injected = altered(&rig, &context.host_model, &with, 3).expect("records");
        let sweep = 4;
        let passage = &generator.passages[sweep];
        let run = |effects: &[Active]| {
            let trace = simulate(&generator.machine, effects, passage, 7, Noise::None);
            passage.recorded(&trace.y).to_vec()
        };
        let (without, truly) = (run(&[]), run(&[with]));
        let (before, after) = (rig.records[sweep].record.y(), injected.records[sweep].record.y());
        let skip = generator.machine.order() + 20;
        let true_change = || truly.iter().zip(&without).skip(skip).map(|(x, y)| x - y);
        let carried = after.iter().zip(before).skip(skip).map(|(x, y)| x - y);
        let off = root_mean_square(carried.zip(true_change()).map(|(x, y)| x - y));
        let size = root_mean_square(true_change());
        assert!(off < 0.25 * size, "{effect}: {off} of {size}");
    }
}

#[test]
fn sizes_are_what_survives_identification_anew() {
    let rig = plain().make().expect("a rig").rig;
    let context = InjectionContext::new(&rig).expect("a model");
    for (effect, is_exact) in [("sensor_drift", true), ("gain_drift", true), ("backlash", false)] {
        let requested_fault = RequestedFault::plain(effect, 2.0).expect("an effect");
        let InjectedRig { rig: injected, fault } = context.inject(&requested_fault, 11).expect("a fault");
        assert!((fault.size / 2.0 - 1.0).abs() < 0.1 && fault.is_observable(), "{fault:?}");
        assert_eq!(fault.injection.is_exact(), is_exact, "{fault:?}");
        assert!(fault.raw > 0.5 && fault.residual > 0.0, "{fault:?}");
        // The same seed, the same fault, searched for or not; another one, another.
        let known = context.again(&requested_fault, fault.magnitude, 11).expect("a fault");
        assert!(injected.records == known.records, "{fault:?}");
        let again = context.inject(&requested_fault, 11).expect("a fault").rig;
        assert!(injected.records == again.records, "{fault:?}");
    }
    let outliers = RequestedFault::plain("outliers", 2.0).expect("an effect");
    let of_seed = |seed| context.inject(&outliers, seed).expect("a fault").rig.records;
    assert!(of_seed(11) != of_seed(12));
}

#[test]
fn the_record_of_an_early_input_shows_a_delay() {
    let rig = plain().make().expect("a rig").rig;
    let context = InjectionContext::new(&rig).expect("a model");
    let injected = altered(&rig, &context.host_model, &active("input_delay", 0, 2.0), 3).expect("records");
    for (after, before) in injected.records.iter().zip(&rig.records) {
        let (after, before) = (&after.record, &before.record);
        assert_eq!(after.y(), before.y());
        assert!((2..before.len()).all(|t| after.v()[t - 2] == before.v()[t]));
    }
}

#[test]
fn records_that_give_no_context_are_refused() {
    let v: Vec<f64> = (0..400).map(|t| (f64::from(t) * 0.1).sin()).collect();
    let of = |y: Vec<f64>| RigRecord {
        name: "line".to_owned(),
        role: Role::Free,
        usage: Usage::Fit,
        record: Record::new(v.clone(), y).expect("a record"),
        predicted: None,
    };
    let rig = |records| Rig {
        name: "line".to_owned(),
        sample_time: 1.0,
        order: None,
        interval: None,
        input_label: "v".to_owned(),
        output_label: "y".to_owned(),
        records,
    };
    let refusal = |records| InjectionContext::new(&rig(records)).expect_err("a refusal");
    assert!(matches!(refusal(Vec::new()), InjectionError::Base(FreeError::NoRecords)));
    assert!(matches!(refusal(vec![of(vec![1.0; 400])]), InjectionError::Base(FreeError::ConstantOutput)));
    // A line without noise leaves nothing that a size could be measured against.
    assert!(matches!(refusal(vec![of(v.iter().map(|v| 2.0 * v).collect())]), InjectionError::NoResidual));
}

#[test]
fn other_records_of_the_machine_are_a_context_of_their_own() {
    let rig = plain().make().expect("a rig").rig;
    let context = InjectionContext::new(&rig).expect("a model");
    // A louder sensor: the same fault is smaller against it.
    let louder = |r: &RigRecord| {
        let run = context.identified().model.free_run(&r.record);
        let y = r.record.y().iter().zip(&run.y).map(|(y, simulated)| simulated + 3.0 * (y - simulated));
        let record = Record::new(r.record.v().to_vec(), y.collect()).expect("finite");
        RigRecord { record, ..r.clone() }
    };
    let loud = Rig { records: rig.records.iter().map(louder).collect(), ..rig.clone() };
    let other = context.with_records(&loud).expect("a model");
    let chosen = |context: &InjectionContext<'_>| context.identified().selection.structure;
    assert_eq!(chosen(&other), chosen(&context));
    assert!((other.base.residual / context.base.residual / 3.0 - 1.0).abs() < 0.1);
    let requested_fault = RequestedFault::plain("backlash", 2.0).expect("an effect");
    let [small, large] =
        [&context, &other].map(|context| context.inject(&requested_fault, 5).expect("records").fault);
    assert!(large.magnitude > 1.5 * small.magnitude, "{} {}", large.magnitude, small.magnitude);
}

#[test]
fn a_coarse_search_shows_the_size_that_it_reached() {
    let rig = plain().make().expect("a rig").rig;
    let context = InjectionContext::new(&rig).expect("a model");
    let requested_fault = RequestedFault::plain("creep", 2.0).expect("an effect");
    let InjectedRig { rig: injected, fault } =
        context.inject_to(Precision::COARSE, &requested_fault, 5).expect("records");
    assert!((fault.size / 2.0).ln().abs() < 0.5, "{}", fault.size);
    assert_eq!(context.base.surviving(&injected), fault.size);
}
