//! Which rigs the study makes.

use super::confounded_effects::same_class;
use super::scenario::Study;
use crate::examination::scramble;
use crate::generate::{FOREIGN, Family, MakeError, MakeRig, RequestedFault, laws_of};
use serde::{Deserialize, Serialize};

/// What a rig is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// One effect of the library.
    Single,
    /// No effect.
    None,
    /// An effect that no library knows, or one that is taken out of the library for this rig.
    Outside,
    /// Two effects.
    Pair,
}

impl Kind {
    /// The name in tables.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::None => "none",
            Self::Outside => "outside",
            Self::Pair => "pair",
        }
    }
}

/// One rig to be made.
#[derive(Debug, Clone)]
pub struct Ticket {
    /// Position in the full design, whatever slice of it runs.
    pub id: usize,
    /// What it is for.
    pub kind: Kind,
    /// Which nominal system family.
    pub system: usize,
    /// The effect that the diagnosis must do without.
    pub withheld: Option<&'static str>,
    /// How to make it.
    pub recipe: MakeRig,
}

/// The tickets of a study, or of its slice, in random order: as many of the first as one likes are a sample of all, and what is
/// left takes as long a rig as what is done.
///
/// Single effects run over every effect of the study × size × system × seed; every other seed takes the plain law, the rest go
/// round the effect's other laws. Outsiders are foreign and withheld in turn, at sizes of at least 1. Pairs are drawn
/// among effects that are no confounded effects, at sizes of at least 1.
///
/// # Errors
/// [`MakeError`] if a size of the study is no size.
pub fn design(study: &Study) -> Result<Vec<Ticket>, MakeError> {
    let mut tickets = Vec::new();
    let mut add = |kind, system, withheld, requested_faults: Vec<RequestedFault>| {
        let id = tickets.len();
        let family = Family { order: Some(1 + system % 3), shape: None };
        let plain = MakeRig::new(scramble(study.seed, id as u64)).family(family).plan(study.plan);
        let recipe = requested_faults.into_iter().fold(plain, MakeRig::with);
        tickets.push(Ticket { id, kind, system, withheld, recipe });
    };
    for &effect in &study.effects {
        let others = laws_of(effect).len() - 1;
        for &size in &study.sizes {
            for system in 0..study.systems {
                for seed in 0..study.seeds {
                    let law = if seed % 2 == 0 || others == 0 { 0 } else { 1 + (seed / 2) % others };
                    add(Kind::Single, system, None, vec![RequestedFault::with_law(effect, law, size)?]);
                }
            }
        }
    }
    for i in 0..study.none {
        add(Kind::None, i % study.systems, None, vec![]);
    }
    let large: Vec<f64> = study.sizes.iter().copied().filter(|s| *s >= 1.0).collect();
    for i in 0..study.outside {
        let size = large[(i / 2) % large.len()];
        let withheld = (i % 2 == 1).then(|| study.effects.get((i / 2) % study.effects.len().max(1)).copied());
        let withheld = withheld.flatten();
        let effect = withheld.unwrap_or(FOREIGN[(i / 2) % FOREIGN.len()]);
        add(Kind::Outside, (i / 3) % study.systems, withheld, vec![RequestedFault::plain(effect, size)?]);
    }
    for i in 0..study.pairs {
        let (one, other) = pair(&study.effects, scramble(study.seed ^ 0x5041_4952, i as u64));
        let size = large[i % large.len()];
        let both = vec![RequestedFault::plain(one, size)?, RequestedFault::plain(other, size)?];
        add(Kind::Pair, (i / 3) % study.systems, None, both);
    }
    Ok(sliced(tickets, study))
}

/// The tickets shuffled, or the first of them, the same for every run of the study.
fn sliced(mut tickets: Vec<Ticket>, study: &Study) -> Vec<Ticket> {
    tickets.sort_by_key(|t| scramble(!study.seed, t.id as u64));
    tickets.truncate(study.slice.unwrap_or(usize::MAX));
    tickets
}

/// Two of these effects that are no confounded effects: there must be such.
fn pair(effects: &[&'static str], mut state: u64) -> (&'static str, &'static str) {
    loop {
        state = scramble(state, 1);
        let one = effects[(state % effects.len() as u64) as usize];
        let other = effects[(state / 64 % effects.len() as u64) as usize];
        if !same_class(one, other) {
            return (one, other);
        }
    }
}
