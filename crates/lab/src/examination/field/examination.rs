//! The field examination: planting, diagnosing, scoring.

use super::bases::{Base, Bases};
use super::case::Case;
use super::design::{Kind, Ticket, design};
use super::fault::{by_maker, injected, left, mean_square, nominal, reported};
use super::made;
use super::resample::{resampled, runs_of};
use super::scenario::Study;
use super::score::Scores;
use super::seal::{Key, PutIn, Sealed, WrittenKeys};
use super::wanted::Wanted;
use super::{report, score};
use crate::examination::{Done, Examination, KEY_FILE, Report};
use crate::generate::{InjectionContext, Nature, laws_of};
use rayon::prelude::*;
use std::sync::OnceLock;
use switchback_diagnose::{DiagnoseError, Diagnosis, Model, Settings, diagnose};
use switchback_identify::free::Identified;
use switchback_io::INDEX;
use switchback_io::diagnosis::met_by;
use switchback_io::provenance::PROVENANCE_FILE;
use switchback_model::rig::Rig;

/// A field examination.
#[derive(Debug)]
pub struct Field<'a> {
    study: Study,
    bases: &'a Bases,
    examiner: Examiner,
    /// What is identified of each base, when it is first needed.
    known: Vec<OnceLock<Known<'a>>>,
}

/// Who diagnoses: a function of what a user's folder holds, of a model given or none, and of settings.
pub type Examiner = fn(&Rig, Model, &Settings) -> Result<Diagnosis, DiagnoseError>;

/// What is identified of a base once. Words say why something is not there.
#[derive(Debug)]
struct Known<'a> {
    nominal: Result<Identified, String>,
    context: Result<InjectionContext<'a>, String>,
}

/// A rig as it is diagnosed, the same machine before, and the model of that.
struct Opened {
    rig: Rig,
    before: Rig,
    nominal: Result<Identified, String>,
}

impl<'a> Field<'a> {
    /// An examination of the program's own diagnosis on some bases.
    pub fn new(study: Study, bases: &'a Bases) -> Self {
        Self::of(diagnose, study, bases)
    }

    /// The same of any diagnosis.
    pub fn of(examiner: Examiner, study: Study, bases: &'a Bases) -> Self {
        let known = bases.all.iter().map(|_| OnceLock::new()).collect();
        Self { study, bases, examiner, known }
    }

    fn base(&self, ticket: &Ticket) -> &'a Base {
        &self.bases.all[ticket.base]
    }

    fn known(&self, base: usize) -> &Known<'a> {
        self.known[base].get_or_init(|| {
            let rig = &self.bases.all[base].rig;
            if self.bases.spares().contains(&base) {
                let reason = "it stays without fault".to_owned();
                return Known { nominal: nominal(rig), context: Err(reason) };
            }
            let context = InjectionContext::new(rig).map_err(|error| error.to_string());
            let nominal = match &context {
                Ok(context) => Ok(context.identified().clone()),
                Err(_) => nominal(rig),
            };
            Known { nominal, context }
        })
    }

    /// Puts in what a ticket asks for.
    fn sealed(&self, ticket: Ticket, written: &WrittenKeys) -> Sealed {
        let base = &self.base(&ticket).name;
        if let Some(key) = written.of(&ticket, base) {
            return Sealed { key: key.clone(), ticket };
        }
        let found = ticket.fault.map(|fault| self.put_in(&ticket, &fault)).transpose();
        let (fault, refused) = match found {
            Ok(fault) => (fault, None),
            Err(reason) => (None, Some(reason)),
        };
        let (id, kind, seed) = (ticket.id, ticket.kind, ticket.seed);
        Sealed { key: Key { id, kind, base: base.clone(), seed, fault, refused }, ticket }
    }

    fn put_in(&self, ticket: &Ticket, fault: &Wanted) -> Result<PutIn, String> {
        let put_in = match self.base(ticket).made.filter(|_| fault.by_maker) {
            Some(seed) => by_maker(seed, fault)?,
            None => {
                let context = self.known(ticket.base).context.as_ref().map_err(Clone::clone)?;
                let requested_fault = fault.requested_fault().map_err(reported)?;
                injected(context.inject(&requested_fault, ticket.seed).map_err(reported)?.fault)
            }
        };
        let is_finite = [put_in.magnitude, put_in.size, put_in.raw].iter().all(|x| x.is_finite());
        is_finite.then_some(put_in).ok_or_else(|| "no model can be identified with the fault".to_owned())
    }

    /// The rig of a key.
    fn open(&self, Sealed { ticket, key }: &Sealed) -> Result<Opened, String> {
        if let Some(reason) = &key.refused {
            return Err(reason.clone());
        }
        let base = self.base(ticket);
        if let (Some(seed), Some(fault), Some(put_in)) = (base.made, &ticket.fault, &key.fault)
            && let Some(noise_sd) = put_in.noise_sd
        {
            let found = (noise_sd, put_in.magnitude, put_in.size);
            let found =
                made::again(seed, fault, found).map_err(reported)?.ok_or("a fault without magnitude")?;
            return Ok(Opened { nominal: nominal(&found.before), rig: found.rig, before: found.before });
        }
        let known = self.known(ticket.base);
        let rig = match (&ticket.fault, &key.fault, ticket.kind) {
            (Some(fault), Some(put_in), _) => {
                let context = known.context.as_ref().map_err(Clone::clone)?;
                let requested_fault = fault.requested_fault().map_err(reported)?;
                context.again(&requested_fault, put_in.magnitude, ticket.seed).map_err(reported)?
            }
            (.., Kind::Resampled) => {
                let nominal = known.nominal.as_ref().map_err(Clone::clone)?;
                resampled(&base.rig, runs_of(&nominal.model), ticket.seed).map_err(reported)?
            }
            _ => base.rig.clone(),
        };
        Ok(Opened { rig, before: base.rig.clone(), nominal: known.nominal.clone() })
    }

    /// Diagnoses without the model and with it, then opens the key.
    fn judged(&self, sealed: &Sealed) -> Case {
        let base = self.base(&sealed.ticket);
        match self.open(sealed) {
            Ok(opened) => {
                let errors = opened.errors().filter(|_| moves_simulation(&sealed.ticket));
                Case::judge(sealed, base, opened.diagnoses(self.examiner), errors)
            }
            Err(reason) => {
                let key = Key { refused: Some(reason), ..sealed.key.clone() };
                Case::judge(&Sealed { ticket: sealed.ticket.clone(), key }, base, Vec::new(), None)
            }
        }
    }
}

impl Field<'static> {
    /// One that cannot be run, only scored: for cases that were judged elsewhere.
    pub fn scored_only(study: Study) -> Self {
        static NONE: Bases = Bases { all: Vec::new(), spare: 0 };
        Self::new(study, &NONE)
    }
}

impl Opened {
    fn diagnoses(&self, examiner: Examiner) -> Vec<(bool, Option<Diagnosis>)> {
        let settings = Settings::default();
        let without = examiner(&self.rig, Model::Identify, &settings).ok();
        let with = self.nominal.as_ref().ok().and_then(|nominal| {
            let (rig, model) = met_by(self.rig.clone(), &nominal.model);
            examiner(&rig, model, &settings).ok()
        });
        vec![(false, without), (true, with)]
    }

    /// Mean squares of the simulation error of the base's model, without and with the fault.
    fn errors(&self) -> Option<[f64; 2]> {
        let model = &self.nominal.as_ref().ok()?.model;
        let errors = [&self.before, &self.rig].map(|rig| mean_square(left(model, rig)));
        errors.iter().all(|error| error.is_finite()).then_some(errors)
    }
}

fn moves_simulation(ticket: &Ticket) -> bool {
    let law = ticket.fault.and_then(|fault| laws_of(fault.effect).get(fault.law));
    law.is_some_and(|law| law.nature() == Nature::Systematic)
}

impl Examination for Field<'_> {
    type Ticket = Ticket;
    type Sealed = Sealed;
    type Case = Case;
    type Scores = Scores;

    const FILES: &'static [&'static str] = &[
        KEY_FILE,
        PROVENANCE_FILE,
        "results.json",
        INDEX,
        "summary.md",
        "answers.csv",
        "cases.jsonl",
        "by-*.csv",
        "confusion.*",
        "calibration.*",
    ];

    /// Two diagnoses of records that nobody designed: 397 processor seconds for the 13 rigs of `scenarios/field-slice.toml`.
    const SECONDS: f64 = 30.0;

    fn name(&self) -> &str {
        &self.study.name
    }

    fn question(&self) -> &str {
        &self.study.question
    }

    fn design(&self) -> miette::Result<Vec<Ticket>> {
        Ok(design(&self.study, self.bases))
    }

    fn seal(&self, tickets: Vec<Ticket>, before: &str, done: Done<'_>) -> miette::Result<Vec<Sealed>> {
        let written = WrittenKeys::read(before);
        let mut needed: Vec<usize> = tickets.iter().map(|ticket| ticket.base).collect();
        needed.sort_unstable();
        needed.dedup();
        // Beforehand, so that no thread waits for another's.
        needed.into_par_iter().with_max_len(1).for_each(|base| {
            self.known(base);
        });
        let sealed = tickets.into_par_iter().with_max_len(1).map(|ticket| {
            let sealed = self.sealed(ticket, &written);
            done();
            sealed
        });
        Ok(sealed.collect())
    }

    fn judge(&self, rig: &Sealed) -> miette::Result<Case> {
        Ok(self.judged(rig))
    }

    fn score(&self, cases: &[Case]) -> Scores {
        score::score(cases, &self.study.expect)
    }

    fn report(&self, key_sha256: &str, cases: &[Case], scores: &Scores) -> miette::Result<Report> {
        report::report(&self.study, key_sha256, cases, scores)
    }
}
