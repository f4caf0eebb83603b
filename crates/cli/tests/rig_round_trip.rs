//! A rig that is written reads back as the same rig.

use proptest::prelude::*;
use switchback_io::output::OutputFolder;
use switchback_io::rig;
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};
use tempfile::TempDir;

fn finite() -> impl Strategy<Value = f64> {
    prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO
}

fn record(index: usize) -> impl Strategy<Value = RigRecord> {
    let role = prop::sample::select(vec![
        Role::StepHigh,
        Role::StepLow,
        Role::Descendant,
        Role::Ascendant,
        Role::Free,
    ]);
    let samples = prop::collection::vec((finite(), finite(), finite()), 63..80);
    (role, any::<bool>(), any::<bool>(), samples).prop_map(move |(role, held_out, predicted, samples)| {
        let mut v: Vec<f64> = samples.iter().map(|s| s.0).collect();
        v[0] = v[1] / 2.0 + 1.0;
        RigRecord {
            name: format!("record {index}"),
            role,
            // The first is fitted: a rig needs one that is.
            usage: if held_out && index > 0 { Usage::Holdout } else { Usage::Fit },
            record: Record::new(v, samples.iter().map(|s| s.1).collect()).expect("finite samples"),
            predicted: predicted.then(|| samples.iter().map(|s| s.2).collect()),
        }
    })
}

fn any_rig() -> impl Strategy<Value = Rig> {
    let interval = prop::option::of(
        (-1e6..0.0, 1e-3..1e6).prop_map(|(low, high)| Interval::new(low, high).expect("an interval")),
    );
    let sample_time = prop_oneof![Just(0.01), Just(1.0 / 3.0), Just(86_400.0), 1e-9..1e3f64];
    (
        "[^\\s\\pC]\\PC{0,20}",
        sample_time,
        prop::option::of(1usize..=20),
        interval,
        "\\PC{0,20}",
        (record(0), record(1)),
    )
        .prop_map(|(name, sample_time, order, interval, label, records)| Rig {
            name,
            sample_time,
            order,
            interval,
            input_label: label.clone(),
            output_label: format!("{label} [\"µm\"]"),
            records: vec![records.0, records.1],
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn what_is_written_reads_back_bit_for_bit(rig in any_rig()) {
        let root = TempDir::new().expect("a temporary folder");
        let folder = root.path().join("rig");
        OutputFolder::claim(&folder, false)
            .and_then(|claimed| claimed.commit(&rig::artefacts(&rig)))
            .expect("a writable temporary folder");
        let read = rig::read(&folder.join(rig::RIG_FILE)).expect("a rig that was written can be read");
        prop_assert_eq!(read, rig);
    }
}
