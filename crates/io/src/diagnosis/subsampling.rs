//! Whether parts of the records give the verdict of all of them.

use super::stability::{PartVerdict, Stability};
use super::{Report, Subject, examine};
use crate::progress::Stages;
use crate::rig::is_rest_of;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::ops::Range;
use switchback_diagnose::{Diagnosis, Settings, Status};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// Share of a record in a sample.
const TAKEN: f64 = 0.75;
/// Samples of a record of which a share is taken, at least.
const LEAST_LENGTH: usize = 800;
/// Share of a recording that is held out where all of it is fitted, or none.
const HELD_OUT: f64 = 1.0 / 3.0;

/// Diagnoses samples of the records, so many, and every recording alone; `report` is that of all of them.
pub fn stability(
    subject: &Subject,
    settings: &Settings,
    (report, samples): (&Report, usize),
    progress: &dyn Stages,
) -> Stability {
    let rig = &subject.rig;
    let recordings = recordings(rig);
    let alone: Vec<(String, Vec<RigRecord>)> = match recordings.len() {
        0 | 1 => Vec::new(),
        _ => recordings.into_iter().map(|(name, records)| (name, divided(records))).collect(),
    };
    let can_be_cut = rig.records.iter().any(can_be_cut);
    let sampled: Vec<(String, Vec<RigRecord>)> = (0..if can_be_cut { samples } else { 0 })
        .map(|number| (format!("sample {}", number + 1), sampled(rig, number as u64)))
        .collect();
    progress.begin("stability");
    progress.found(alone.len() + sampled.len());
    let judged = |parts: Vec<(String, Vec<RigRecord>)>| -> Vec<PartVerdict> {
        let one = |(part, records): (String, Vec<RigRecord>)| {
            let subject = Subject { rig: Rig { records, ..rig.clone() }, ..subject.clone() };
            let found = examine(subject, settings);
            progress.did_one();
            match found {
                Ok(found) => PartVerdict {
                    part,
                    verdict: found.diagnosis.verdict.to_string(),
                    agrees: agree(&found.diagnosis, &report.diagnosis),
                },
                Err(error) => PartVerdict { part, verdict: error.to_string(), agrees: false },
            }
        };
        parts.into_par_iter().with_max_len(1).map(one).collect()
    };
    Stability { samples: judged(sampled), recordings: judged(alone) }
}

/// Whether two diagnoses say the same: that nothing is missing, that none of the effects is the cause, or the same effects, likeliest first, or the same values.
fn agree(one: &Diagnosis, other: &Diagnosis) -> bool {
    let said = |d: &Diagnosis| {
        let verdict = &d.verdict;
        let mut effects: Vec<&str> = verdict.effects.iter().map(|effect| effect.name()).collect();
        effects.sort_unstable();
        let mut off: Vec<String> = match (&d.differences, verdict.status) {
            (Some(differences), Status::Parameters) => {
                differences.rows.iter().filter(|row| row.differs).map(|row| row.what.clone()).collect()
            }
            _ => Vec::new(),
        };
        off.sort_unstable();
        let effects: Vec<String> = effects.into_iter().map(str::to_owned).collect();
        (verdict.status, effects, verdict.class.first().map(|effect| effect.name()), off)
    };
    said(one) == said(other)
}

/// The records that were taken in one piece, by its name.
fn recordings(rig: &Rig) -> Vec<(String, Vec<RigRecord>)> {
    let mut all: Vec<(String, Vec<RigRecord>)> = Vec::new();
    for record in &rig.records {
        let same = |name: &str| is_rest_of(&record.name, name) || is_rest_of(name, &record.name);
        match all.iter_mut().find(|(name, _)| same(name)) {
            Some((_, records)) => records.push(record.clone()),
            None => all.push((record.name.clone(), vec![record.clone()])),
        }
    }
    all
}

/// A recording with its last third held out, where all of it is for one use.
fn divided(records: Vec<RigRecord>) -> Vec<RigRecord> {
    let has = |usage| records.iter().any(|record: &RigRecord| record.usage == usage);
    if has(Usage::Fit) && has(Usage::Holdout) {
        return records;
    }
    let divide = |record: RigRecord| {
        let count = record.record.len();
        let cut = count - (HELD_OUT * count as f64) as usize;
        let name = record.name.clone();
        [(0..cut, Usage::Fit, name.clone()), (cut..count, Usage::Holdout, format!("{name}-held-out"))]
            .map(|(range, usage, name)| RigRecord { usage, name, ..part(&record, range) })
    };
    records.into_iter().flat_map(divide).collect()
}

/// Consecutive samples of a record.
fn part(record: &RigRecord, range: Range<usize>) -> RigRecord {
    let cut = |x: &[f64]| x[range.clone()].to_vec();
    RigRecord {
        record: Record::new(cut(record.record.v()), cut(record.record.y()))
            .expect("a part of a record is one"),
        predicted: record.predicted.as_deref().map(cut),
        ..record.clone()
    }
}

/// Whether a share of a record can be taken: one that is designed, or short, stays whole.
fn can_be_cut(record: &RigRecord) -> bool {
    record.role == Role::Free && record.record.len() >= LEAST_LENGTH
}

/// All records with three quarters of each, in one piece.
fn sampled(rig: &Rig, seed: u64) -> Vec<RigRecord> {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let window = |record: &RigRecord| {
        if !can_be_cut(record) {
            return record.clone();
        }
        let count = record.record.len();
        let length = (TAKEN * count as f64) as usize;
        let from = rng.random_range(0..=count - length);
        part(record, from..from + length)
    };
    rig.records.iter().map(window).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig(records: &[(&str, Usage, usize)]) -> Rig {
        let record = |(name, usage, count): &(&str, Usage, usize)| RigRecord {
            name: (*name).to_owned(),
            role: Role::Free,
            usage: *usage,
            record: Record::new((0..*count).map(|t| t as f64).collect(), vec![1.0; *count]).unwrap(),
            predicted: Some((0..*count).map(|t| t as f64).collect()),
        };
        Rig {
            name: "rig".to_owned(),
            sample_time: 0.01,
            order: None,
            interval: None,
            input_label: "v".to_owned(),
            output_label: "y".to_owned(),
            records: records.iter().map(record).collect(),
        }
    }

    #[test]
    fn a_sample_has_three_quarters_of_every_long_record_in_one_piece() {
        let rig = rig(&[("a", Usage::Fit, 1607), ("b", Usage::Holdout, 700)]);
        let mut starts = Vec::new();
        for seed in 0..50 {
            let records = sampled(&rig, seed);
            let [a, b] = &records[..] else { panic!("two records") };
            assert_eq!((a.record.len(), a.predicted.as_deref()), (1205, Some(a.record.v())));
            assert!(a.record.v().windows(2).all(|v| v[1] == v[0] + 1.0));
            starts.push(a.record.v()[0]);
            // Too short to be cut.
            assert_eq!(*b, rig.records[1]);
        }
        assert!(starts.iter().any(|s| *s < 100.0) && starts.iter().any(|s| *s > 300.0), "{starts:?}");
        assert_eq!(sampled(&rig, 1), sampled(&rig, 1));
    }

    #[test]
    fn recordings_are_judged_alone_with_a_part_held_out() {
        let cut = rig(&[("a", Usage::Fit, 200), ("a-held-out", Usage::Holdout, 100), ("b", Usage::Fit, 300)]);
        let alone = recordings(&cut);
        let names: Vec<&str> = alone.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a", "b"]);
        assert_eq!(divided(alone[0].1.clone()), cut.records[..2]);
        let b = divided(alone[1].1.clone());
        assert_eq!(
            b.iter().map(|r| (r.usage, r.record.len())).collect::<Vec<_>>(),
            [(Usage::Fit, 200), (Usage::Holdout, 100)]
        );
        assert!(is_rest_of(&b[1].name, &b[0].name));
    }
}
