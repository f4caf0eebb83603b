//! The field examination: planting, diagnosing, scoring.

use super::bases::{Base, Bases};
use super::case::Case;
use super::design::{Kind, Ticket, Wanted, design};
use super::made;
use super::resample::resampled;
use super::scenario::Study;
use super::seal::{How, Key, PutIn, Sealed, WrittenKeys};
use super::{report, score};
use crate::diagnosis::met_by;
use crate::examination::{Done, Examination, KEY_FILE, Report};
use rayon::prelude::*;
use std::sync::OnceLock;
use switchback_estimator::Record;
use switchback_estimator::estimators::free::{FreeError, Identified, InputMap, Model, Settings, identify};
use switchback_estimator::rig::{Rig, RigRecord};
use switchback_gap::{DiagnoseError, Diagnosis, diagnose};
use switchback_maker::{Nature, PlantedFault, PlantingGround, laws_of};

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
pub type Examiner =
    fn(&Rig, switchback_gap::Model, &switchback_gap::Settings) -> Result<Diagnosis, DiagnoseError>;

/// What is identified of a base once. Words say why something is not there.
#[derive(Debug)]
struct Known<'a> {
    nominal: Result<Identified, String>,
    ground: Result<PlantingGround<'a>, String>,
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
                return Known { nominal: nominal(rig), ground: Err(reason) };
            }
            let ground = PlantingGround::new(rig).map_err(|error| error.to_string());
            let nominal = match &ground {
                Ok(ground) => Ok(ground.identified().clone()),
                Err(_) => nominal(rig),
            };
            Known { nominal, ground }
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
                let ground = self.known(ticket.base).ground.as_ref().map_err(Clone::clone)?;
                let ingredient = fault.ingredient().map_err(told)?;
                planted(ground.plant(&ingredient, ticket.seed).map_err(told)?.fault)
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
            let found = made::again(seed, fault, found).map_err(told)?.ok_or("a fault without magnitude")?;
            return Ok(Opened { nominal: nominal(&found.before), rig: found.rig, before: found.before });
        }
        let known = self.known(ticket.base);
        let rig = match (&ticket.fault, &key.fault, ticket.kind) {
            (Some(fault), Some(put_in), _) => {
                let ground = known.ground.as_ref().map_err(Clone::clone)?;
                let ingredient = fault.ingredient().map_err(told)?;
                ground.again(&ingredient, put_in.magnitude, ticket.seed).map_err(told)?
            }
            (.., Kind::Resampled) => {
                let nominal = known.nominal.as_ref().map_err(Clone::clone)?;
                resampled(&base.rig, &nominal.model, ticket.seed).map_err(told)?
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
                let actual = opened.closure().filter(|_| moves_simulation(&sealed.ticket));
                Case::judge(sealed, base, opened.diagnoses(self.examiner), actual)
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
        let settings = switchback_gap::Settings::default();
        let without = examiner(&self.rig, switchback_gap::Model::Identify, &settings).ok();
        let with = self.nominal.as_ref().ok().and_then(|nominal| {
            let (rig, model) = met_by(self.rig.clone(), &nominal.model);
            examiner(&rig, model, &settings).ok()
        });
        vec![(false, without), (true, with)]
    }

    /// `1 − E(base)/E(with the fault)` of the base's model.
    fn closure(&self) -> Option<f64> {
        let model = &self.nominal.as_ref().ok()?.model;
        let [before, after] = [&self.before, &self.rig].map(|rig| mean_square(left(model, rig)));
        (after > 0.0 && after.is_finite()).then(|| 1.0 - before / after)
    }
}

/// What the default of `identify` gives.
fn nominal(rig: &Rig) -> Result<Identified, String> {
    let records: Vec<&Record> = rig.fit_records().map(|record| &record.record).collect();
    let open = Settings { order: rig.order, interval: rig.interval, ..Settings::new(InputMap::Borders) };
    identify(&records, &open).map_err(|error: FreeError| error.to_string())
}

/// A fault that the maker simulates in the machine itself.
fn by_maker(seed: u64, fault: &Wanted) -> Result<PutIn, String> {
    let found = made::with_fault(seed, fault).map_err(told)?;
    let model = nominal(&found.before)?.model;
    let differences = left(&model, &found.rig).zip(left(&model, &found.before)).map(|(now, then)| now - then);
    let raw = (mean_square(differences) / mean_square(left(&model, &found.before))).sqrt();
    let put_in = found.key.effects.first().ok_or("the maker put nothing in")?;
    Ok(PutIn {
        effect: put_in.effect.to_owned(),
        law: put_in.law.to_owned(),
        how: How::Made,
        magnitude: put_in.magnitude,
        unit: put_in.unit.to_owned(),
        wanted: put_in.wanted,
        size: put_in.size,
        raw,
        noise_sd: Some(found.key.noise_sd),
    })
}

fn planted(fault: PlantedFault) -> PutIn {
    PutIn {
        effect: fault.effect.to_owned(),
        law: fault.law.to_owned(),
        how: if fault.planting.is_exact() { How::Exact } else { How::Carried },
        magnitude: fault.magnitude,
        unit: fault.unit.to_owned(),
        wanted: fault.wanted,
        size: fault.size,
        raw: fault.raw,
        noise_sd: None,
    }
}

fn told(error: impl std::fmt::Display) -> String {
    error.to_string()
}

fn moves_simulation(ticket: &Ticket) -> bool {
    let law = ticket.fault.and_then(|fault| laws_of(fault.effect).get(fault.law));
    law.is_some_and(|law| law.nature() == Nature::Systematic)
}

/// Simulation errors of a model on the held-out records, all where none is held out.
fn left<'r>(model: &'r Model, rig: &'r Rig) -> impl Iterator<Item = f64> + 'r {
    let any = rig.holdout_records().next().is_some();
    let judged =
        rig.records.iter().filter(move |r| !any || r.usage == switchback_estimator::rig::Usage::Holdout);
    judged.flat_map(move |record: &RigRecord| {
        let run = model.free_run(&record.record);
        let y = record.record.y();
        (0..y.len()).map(move |t| if t < run.start { 0.0 } else { y[t] - run.y[t] }).collect::<Vec<f64>>()
    })
}

fn mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), x| (sum + x * x, count + 1));
    sum / count.max(1) as f64
}

impl Examination for Field<'_> {
    type Ticket = Ticket;
    type Sealed = Sealed;
    type Case = Case;

    const FILES: &'static [&'static str] = &[
        KEY_FILE,
        "results.json",
        "summary.md",
        "answers.csv",
        "cases.jsonl",
        "by-*.csv",
        "confusion.*",
        "calibration.*",
    ];

    const BATCH: usize = 8;

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

    fn judge(&self, batch: &[Sealed], done: Done<'_>) -> miette::Result<Vec<Case>> {
        let judged = batch.par_iter().with_max_len(1).map(|one| {
            let case = self.judged(one);
            done();
            case
        });
        Ok(judged.collect())
    }

    fn report(&self, key_sha256: &str, cases: &[Case]) -> miette::Result<Report> {
        report::report(&self.study, key_sha256, cases, &score::score(cases, &self.study.expect))
    }
}
