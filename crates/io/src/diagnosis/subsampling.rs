//! Whether parts of the records give the verdict of all of them.

use super::stability::{PartVerdict, Stability};
use super::{Report, Subject, examine};
use crate::progress::Stages;
use crate::rig::is_rest_of;
use rand::SeedableRng;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::ops::Range;
use switchback_diagnose::{Diagnosis, Settings, Status};
use switchback_model::Record;
use switchback_model::rig::{Rig, RigRecord, Role, Usage};

/// Blocks of a record, and of these in a sample.
const BLOCKS: usize = 8;
const TAKEN: usize = 6;
/// Samples of a block, at least.
const LEAST_BLOCK: usize = 100;
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
    let can_be_cut = rig.records.iter().any(|record| blocks(record).is_some());
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

/// The length of the blocks of a record; none where it is designed, or too short.
fn blocks(record: &RigRecord) -> Option<usize> {
    let length = record.record.len() / BLOCKS;
    (record.role == Role::Free && length >= LEAST_BLOCK).then_some(length)
}

/// All records with three quarters of their blocks; blocks that follow each other stay in one piece.
fn sampled(rig: &Rig, seed: u64) -> Vec<RigRecord> {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let mut all = Vec::new();
    for record in &rig.records {
        let Some(length) = blocks(record) else {
            all.push(record.clone());
            continue;
        };
        let mut taken = sample(rng, BLOCKS, TAKEN).into_vec();
        taken.sort_unstable();
        let pieces = taken.chunk_by(|a, b| a + 1 == *b);
        for (number, piece) in pieces.enumerate() {
            let (first, last) = (piece[0], piece[piece.len() - 1]);
            let end = if last + 1 == BLOCKS { record.record.len() } else { (last + 1) * length };
            let name = format!("{}-part-{}", record.name, number + 1);
            all.push(RigRecord { name, ..part(record, first * length..end) });
        }
    }
    all
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
    fn a_sample_has_three_quarters_of_every_long_record_and_repeats_nothing() {
        let rig = rig(&[("a", Usage::Fit, 1607), ("b", Usage::Holdout, 700)]);
        for seed in 0..50 {
            let records = sampled(&rig, seed);
            let mut of_a: Vec<f64> = Vec::new();
            for record in records.iter().filter(|record| record.usage == Usage::Fit) {
                assert_eq!(record.predicted.as_deref(), Some(record.record.v()));
                assert!(record.record.v().windows(2).all(|v| v[1] == v[0] + 1.0));
                of_a.extend(record.record.v());
            }
            assert!(of_a.len() == 6 * 200 || of_a.len() == 6 * 200 + 7);
            assert!(of_a.windows(2).all(|v| v[0] < v[1]));
            // Too short to be cut.
            assert_eq!(records.iter().filter(|r| r.usage == Usage::Holdout).count(), 1);
        }
        assert_ne!(sampled(&rig, 1), sampled(&rig, 2));
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
