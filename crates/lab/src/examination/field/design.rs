//! Which rigs the examination makes.

use super::bases::Bases;
use super::scenario::{LARGE, Study};
use super::wanted::Wanted;
use crate::examination::scramble;
use crate::generate::{FOREIGN, laws_of};
use serde::{Deserialize, Serialize};

/// What a rig is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// A base with a fault of the library.
    Injected,
    /// A base with a fault that no library knows.
    Outside,
    /// A base as it is.
    Bare,
    /// A measured base's model with its residuals resampled.
    Resampled,
}

impl Kind {
    /// The name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Injected => "planted",
            Self::Outside => "outside",
            Self::Bare => "bare",
            Self::Resampled => "resampled",
        }
    }
}

/// One rig of the design.
#[derive(Debug, Clone)]
pub struct Ticket {
    /// Position in the full design, whatever slice of it runs.
    pub id: usize,
    /// What it is for.
    pub kind: Kind,
    /// Position of its base.
    pub base: usize,
    /// The fault, where there is one.
    pub fault: Option<Wanted>,
    /// What else is random about it.
    pub seed: u64,
}

/// The rigs of an examination, or of its slice, in random order: as many of the first as one likes are a sample of all. A slice holds
/// the measured bases of its rigs as they are, too: by these its answers are judged.
///
/// Faults run over base × effect × size × seed; half follow the plain law, the others one of the effect's other laws. Into every other made
/// base, seed by seed, the maker itself puts the fault. Foreign faults go round the bases, at sizes of at least 2.
pub fn design(study: &Study, bases: &Bases) -> Vec<Ticket> {
    let mut tickets: Vec<Ticket> = Vec::new();
    let mut add = |kind, base, fault: Option<(&'static str, f64, bool)>| {
        let id = tickets.len();
        let seed = scramble(study.seed, id as u64);
        let fault =
            fault.map(|(effect, size, by_maker)| Wanted { effect, law: law(effect, seed), size, by_maker });
        tickets.push(Ticket { id, kind, base, fault, seed });
    };
    let measured = bases.measured();
    for base in bases.contexts() {
        for &effect in &study.effects {
            for &size in &study.sizes {
                for seed in 0..study.seeds {
                    let by_maker = !measured.contains(&base) && (base + seed) % 2 == 1;
                    add(Kind::Injected, base, Some((effect, size, by_maker)));
                }
            }
        }
    }
    let large: Vec<f64> = study.sizes.iter().copied().filter(|s| *s >= LARGE).collect();
    let contexts = bases.contexts().len();
    for k in 0..study.outside {
        let (effect, size) = (FOREIGN[k % FOREIGN.len()], large[k % large.len()]);
        add(Kind::Outside, k % contexts, Some((effect, size, false)));
    }
    for base in measured.clone().chain(bases.spares()) {
        add(Kind::Bare, base, None);
    }
    for base in measured {
        for _ in 0..study.resampled {
            add(Kind::Resampled, base, None);
        }
    }
    sliced(tickets, study, bases)
}

/// Half of the seeds take the plain law, the rest the effect's others.
pub(crate) fn law(effect: &str, seed: u64) -> usize {
    let others = laws_of(effect).len() as u64 - 1;
    let drawn = scramble(seed, 1);
    if drawn.is_multiple_of(2) || others == 0 { 0 } else { 1 + (drawn / 2 % others) as usize }
}

/// The tickets shuffled, or the first of them with the measured bases they need, the same for every run of the study.
fn sliced(mut tickets: Vec<Ticket>, study: &Study, bases: &Bases) -> Vec<Ticket> {
    tickets.sort_by_key(|t| scramble(!study.seed, t.id as u64));
    let Some(diagnoses) = study.slice else { return tickets };
    let rest = tickets.split_off(diagnoses.div_ceil(2).min(tickets.len()));
    let is_needed = |t: &Ticket| {
        let is_measured = bases.measured().contains(&t.base);
        t.kind == Kind::Bare && is_measured && tickets.iter().any(|other| other.base == t.base)
    };
    let needed: Vec<Ticket> = rest.into_iter().filter(is_needed).collect();
    tickets.extend(needed);
    tickets
}
