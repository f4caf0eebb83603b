//! Rows of the table that a posterior is learnt from.

use super::draw::draw;
use super::measured::MeasuredBases;
use super::training_rig::TrainingRig;
use crate::learning::{Group, Truth};
use rayon::prelude::*;
use std::fmt::Write;
use std::ops::Range;
use switchback_diagnose::evidence::Judged;

/// Evidence of a training rig, with what is true of it.
#[derive(Debug, Clone, PartialEq)]
pub struct EvidenceRow {
    /// The outcome that holds.
    pub label: String,
    /// Where it comes from.
    pub group: Group,
    /// What else is true.
    pub truth: Truth,
    /// Named columns.
    pub columns: Vec<(String, f64)>,
}

impl EvidenceRow {
    /// By the nominal system that the program itself would identify; none where there is none.
    pub fn of(rig: &TrainingRig) -> Option<Self> {
        let judged = match rig.is_given {
            true => {
                let predicted =
                    rig.rig.records.iter().map(|r| r.predicted.clone()).collect::<Option<Vec<_>>>()?;
                Judged::beside(&rig.rig, &predicted)
            }
            false => Judged::identified(&rig.rig),
        };
        let truth = &rig.truth;
        let size = rig.surviving_size();
        let label = rig.outcome(size)?;
        let law = truth.effects.first().map_or(String::new(), |e| format!("{}: {}", e.effect, e.law));
        Some(Self {
            label: label.to_owned(),
            group: Group { family: truth.family.name().to_owned(), law, base: truth.base.clone() },
            truth: Truth {
                size,
                kind: truth.kind.name().to_owned(),
                is_given: rig.is_given,
                also: rig.true_names().into_iter().map(str::to_owned).collect(),
            },
            columns: judged.ok()??.evidence.columns,
        })
    }
}

/// Rows of the training table as CSV, in the order of their numbers: rigs of the population of a seed that give evidence.
///
/// Values have the precision of single numbers, in which they are learnt.
pub fn evidence_table(seed: u64, numbers: Range<u64>, bases: &MeasuredBases) -> String {
    let row = |index| EvidenceRow::of(&draw(seed, index, bases)?);
    let rows: Vec<EvidenceRow> = numbers.into_par_iter().filter_map(row).collect();
    let mut text = String::from("label,weight,family,law,base,size,kind,given,also");
    for (name, _) in rows.first().map_or(&[][..], |row| &row.columns) {
        let _ = write!(text, ",{name}");
    }
    text.push('\n');
    rows.iter().for_each(|row| row.write(&mut text));
    text
}

impl EvidenceRow {
    fn write(&self, text: &mut String) {
        let Self { label, group: Group { family, law, base }, truth, columns } = self;
        let given = if truth.is_given { "yes" } else { "no" };
        let _ = write!(
            text,
            "{label},1,{family},\"{law}\",\"{base}\",{},{},{given},{}",
            truth.size as f32,
            truth.kind,
            truth.also.join(";")
        );
        for (_, value) in columns {
            let _ = write!(text, ",{}", *value as f32);
        }
        text.push('\n');
    }
}
