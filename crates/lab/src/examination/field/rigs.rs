//! Rigs of the field: faults are put into bases, rigs opened and diagnosed.

use super::bases::{Base, Bases};
use super::fault::{by_maker, injected, left, mean_square, nominal, reported};
use super::key::{Key, PutIn};
use super::made;
use super::resample::{resampled, runs_of};
use crate::examination::case::{Answered, Case};
use crate::examination::design::Kind;
use crate::examination::examiner::Examiner;
use crate::examination::fault::Fault;
use crate::examination::reply::ClosureCheck;
use crate::examination::ticket::Ticket;
use crate::examination::wanted::Wanted;
use crate::generate::{InjectionContext, Nature, laws_of};
use rayon::prelude::*;
use std::sync::OnceLock;
use switchback_diagnose::{Diagnosis, Gap, Model, Settings};
use switchback_identify::free::Identified;
use switchback_io::diagnosis::met_by;
use switchback_model::rig::Rig;

/// Bases, and what is identified of each when it is first needed.
#[derive(Debug)]
pub(crate) struct Rigs<'a> {
    pub(crate) bases: &'a Bases,
    known: Vec<OnceLock<Known<'a>>>,
}

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

impl<'a> Rigs<'a> {
    /// Nothing is identified yet.
    pub(crate) fn new(bases: &'a Bases) -> Self {
        Self { bases, known: bases.all.iter().map(|_| OnceLock::new()).collect() }
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

    /// Identifies the bases of some tickets beforehand, so that no thread waits for another's.
    pub(crate) fn identify(&self, tickets: &[Ticket]) {
        let mut needed: Vec<usize> = tickets.iter().map(|ticket| ticket.base).collect();
        needed.sort_unstable();
        needed.dedup();
        needed.into_par_iter().with_max_len(1).for_each(|base| {
            self.known(base);
        });
    }

    /// Puts in what a ticket asks for, if no line of a key file says what that was.
    pub(crate) fn sealed(&self, ticket: &Ticket, written: Option<&str>) -> Key {
        let base = &self.base(ticket).name;
        if let Some(key) = written.and_then(|line| Key::written(line, ticket, base)) {
            return key;
        }
        let found = ticket.faults.first().map(|fault| self.put_in(ticket, fault)).transpose();
        let (fault, refused) = match found {
            Ok(fault) => (fault, None),
            Err(reason) => (None, Some(reason)),
        };
        Key { id: ticket.id, kind: ticket.kind, base: base.clone(), seed: ticket.seed, fault, refused }
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
    fn open(&self, ticket: &Ticket, key: &Key) -> Result<Opened, String> {
        if let Some(reason) = &key.refused {
            return Err(reason.clone());
        }
        let base = self.base(ticket);
        let fault = ticket.faults.first();
        if let (Some(seed), Some(fault), Some(put_in)) = (base.made, fault, &key.fault)
            && let Some(noise_sd) = put_in.noise_sd
        {
            let found = (noise_sd, put_in.magnitude, put_in.size);
            let found =
                made::again(seed, fault, found).map_err(reported)?.ok_or("a fault without magnitude")?;
            return Ok(Opened { nominal: nominal(&found.before), rig: found.rig, before: found.before });
        }
        let known = self.known(ticket.base);
        let rig = match (fault, &key.fault, ticket.kind) {
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
    pub(crate) fn judged(&self, (ticket, key): (&Ticket, &Key), examiner: Examiner) -> Case {
        let base = self.base(ticket);
        let (answers, refused) = match self.open(ticket, key) {
            Ok(opened) => (opened.answers(examiner, moves_simulation(ticket)), None),
            Err(reason) => (Vec::new(), Some(reason)),
        };
        let wanted = ticket.faults.first();
        // The maker puts a fault in the place of what the machine has of it by itself.
        let is_replaced = |own: &str| wanted.is_some_and(|fault| fault.by_maker && fault.effect == own);
        Case {
            id: ticket.id,
            kind: ticket.kind,
            base: base.name.clone(),
            is_measured: base.made.is_none(),
            own: base.own.iter().copied().filter(|own| !is_replaced(own)).collect(),
            fault: wanted.zip(key.fault.as_ref()).map(|(wanted, found)| fault(wanted, found)),
            second: None,
            refused,
            answers,
        }
    }
}

fn fault(wanted: &Wanted, found: &PutIn) -> Fault {
    Fault {
        effect: wanted.effect,
        law: found.law.clone(),
        plain: wanted.law == 0,
        how: found.how,
        wanted: found.wanted,
        size: found.size,
        raw: Some(found.raw),
    }
}

impl Opened {
    /// What is said without the model and with it, whose closure is checked if the fault moves the simulation.
    fn answers(&self, examiner: Examiner, moves_simulation: bool) -> Vec<Answered> {
        let settings = Settings::default();
        let without = examiner(&self.rig, Model::Identify, &settings).ok();
        let with: Option<Diagnosis> = self.nominal.as_ref().ok().and_then(|nominal| {
            let (rig, model) = met_by(self.rig.clone(), &nominal.model);
            examiner(&rig, model, &settings).ok()
        });
        let errors = self.errors().filter(|_| moves_simulation);
        let closure = with.as_ref().and_then(|d| closure(&d.gap, errors?));
        let with = Answered { closure, ..Answered::of(true, with.as_ref()) };
        vec![Answered::of(false, without.as_ref()), with]
    }

    /// Mean squares of the simulation error of the base's model, without and with the fault.
    fn errors(&self) -> Option<[f64; 2]> {
        let model = &self.nominal.as_ref().ok()?.model;
        let errors = [&self.before, &self.rig].map(|rig| mean_square(left(model, rig)));
        errors.iter().all(|error| error.is_finite()).then_some(errors)
    }
}

/// The closure stated against what really closes; see [`Answered::closure`].
fn closure(gap: &Gap, errors: [f64; 2]) -> Option<ClosureCheck> {
    let stated = gap.closure?;
    let [before, after] = errors.map(|error| error - gap.noise_floor * gap.noise_floor);
    let actual = 1.0 - before / after;
    (after > 0.0).then_some(ClosureCheck { estimate: stated.estimate, ci90: stated.ci90, actual })
}

fn moves_simulation(ticket: &Ticket) -> bool {
    let law = ticket.faults.first().and_then(|fault| laws_of(fault.effect).get(fault.law));
    law.is_some_and(|law| law.nature() == Nature::Systematic)
}
