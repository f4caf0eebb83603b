//! Which rigs an examination makes.

use super::design::{Design, Kind};
use super::field::Bases;
use super::laboratory::same_class;
use super::random::scramble;
use super::scenario::Study;
use super::wanted::Wanted;
use crate::generate::{FOREIGN, laws_of};

/// One rig of the design.
#[derive(Debug, Clone)]
pub struct Ticket {
    /// Position in the full design, whatever slice of it runs.
    pub id: usize,
    /// What it is for.
    pub kind: Kind,
    /// Position of its base; in the laboratory its family of systems.
    pub base: usize,
    /// What is put in.
    pub faults: Vec<Wanted>,
    /// The effect that the diagnosis must do without.
    pub withheld: Option<&'static str>,
    /// What else is random about it.
    pub seed: u64,
}

/// The rigs of an examination, or of its slice, in random order: as many of the first as one likes are a sample of all, and what is
/// left takes as long a rig as what is done. A slice holds the measured bases of its rigs as they are, too: by these its answers are judged.
///
/// In the laboratory single effects run over every effect of the study × size × system × seed; every other seed takes the plain law, the rest
/// go round the effect's other laws. Outsiders are foreign and withheld in turn, pairs are drawn among effects that are no confounded effects; both are
/// large. In the field faults run over base × effect × size × seed; half follow the plain law, the others one of the effect's other laws. Into
/// every other made base, seed by seed, the maker itself puts the fault. Large foreign faults go round the bases.
pub(crate) fn tickets(study: &Study, bases: &Bases) -> Vec<Ticket> {
    let mut list = Tickets { study, all: Vec::new() };
    match study.design {
        Design::Laboratory => list.laboratory(),
        Design::Field => list.field(bases),
    }
    sliced(list.all, study, bases)
}

/// Half of the seeds take the plain law, the rest the effect's others.
pub(crate) fn law(effect: &str, seed: u64) -> usize {
    let others = laws_of(effect).len() as u64 - 1;
    let drawn = scramble(seed, 1);
    if drawn.is_multiple_of(2) || others == 0 { 0 } else { 1 + (drawn / 2 % others) as usize }
}

/// The tickets so far.
struct Tickets<'s> {
    study: &'s Study,
    all: Vec<Ticket>,
}

impl Tickets<'_> {
    fn add(&mut self, kind: Kind, base: usize, faults: Vec<Wanted>) {
        let id = self.all.len();
        let seed = scramble(self.study.seed, id as u64);
        self.all.push(Ticket { id, kind, base, faults, withheld: None, seed });
    }

    /// Every effect of the study at every size, `seeds` times.
    fn cells(&self) -> impl Iterator<Item = (&'static str, f64)> + use<'_> {
        self.study.effects.iter().flat_map(|effect| self.study.sizes.iter().map(move |size| (*effect, *size)))
    }

    /// Sizes at which causes must be named, round and round.
    fn large(&self, k: usize) -> f64 {
        let large: Vec<f64> =
            self.study.sizes.iter().copied().filter(|s| *s >= self.study.design.large()).collect();
        large[k % large.len()]
    }

    fn laboratory(&mut self) {
        let Study { systems, seeds, none, outside, pairs, ref effects, seed: root, .. } = *self.study;
        for (effect, size) in self.cells().collect::<Vec<_>>() {
            let others = laws_of(effect).len() - 1;
            for (system, seed) in (0..systems).flat_map(|system| (0..seeds).map(move |seed| (system, seed))) {
                let law = if seed % 2 == 0 || others == 0 { 0 } else { 1 + (seed / 2) % others };
                self.add(Kind::Injected, system, vec![Wanted { law, ..Wanted::plain(effect, size) }]);
            }
        }
        for i in 0..none {
            self.add(Kind::Bare, i % systems, Vec::new());
        }
        for i in 0..outside {
            let withheld =
                (i % 2 == 1).then(|| effects.get((i / 2) % effects.len().max(1)).copied()).flatten();
            let effect = withheld.unwrap_or(FOREIGN[(i / 2) % FOREIGN.len()]);
            self.add(Kind::Outside, (i / 3) % systems, vec![Wanted::plain(effect, self.large(i / 2))]);
            self.all.last_mut().expect("just added").withheld = withheld;
        }
        for i in 0..pairs {
            let both = pair(effects, scramble(root ^ 0x5041_4952, i as u64));
            let both = both.map(|effect| Wanted::plain(effect, self.large(i)));
            self.add(Kind::Pair, (i / 3) % systems, both.into());
        }
    }

    fn field(&mut self, bases: &Bases) {
        let measured = bases.measured();
        for base in bases.contexts() {
            for (effect, size) in self.cells().collect::<Vec<_>>() {
                for seed in 0..self.study.seeds {
                    let by_maker = !measured.contains(&base) && (base + seed) % 2 == 1;
                    self.add_by_drawn_law(
                        Kind::Injected,
                        base,
                        Wanted { by_maker, ..Wanted::plain(effect, size) },
                    );
                }
            }
        }
        for k in 0..self.study.outside {
            let wanted = Wanted::plain(FOREIGN[k % FOREIGN.len()], self.large(k));
            self.add_by_drawn_law(Kind::Outside, k % bases.contexts().len(), wanted);
        }
        for base in measured.clone().chain(bases.spares()) {
            self.add(Kind::Bare, base, Vec::new());
        }
        for base in measured {
            for _ in 0..self.study.resampled {
                self.add(Kind::Resampled, base, Vec::new());
            }
        }
    }

    fn add_by_drawn_law(&mut self, kind: Kind, base: usize, wanted: Wanted) {
        let law = law(wanted.effect, scramble(self.study.seed, self.all.len() as u64));
        self.add(kind, base, vec![Wanted { law, ..wanted }]);
    }
}

/// The tickets shuffled, or the first of them with the measured bases they need, the same for every run of the study.
fn sliced(mut tickets: Vec<Ticket>, study: &Study, bases: &Bases) -> Vec<Ticket> {
    tickets.sort_by_key(|t| scramble(!study.seed, t.id as u64));
    let Some(slice) = study.slice else { return tickets };
    let rigs = if study.design == Design::Field { slice.div_ceil(2) } else { slice };
    let rest = tickets.split_off(rigs.min(tickets.len()));
    let is_needed = |t: &Ticket| {
        let is_measured = bases.measured().contains(&t.base);
        t.kind == Kind::Bare && is_measured && tickets.iter().any(|other| other.base == t.base)
    };
    let needed: Vec<Ticket> = rest.into_iter().filter(is_needed).collect();
    tickets.extend(needed);
    tickets
}

/// Two of these effects that are no confounded effects: there must be such.
fn pair(effects: &[&'static str], mut state: u64) -> [&'static str; 2] {
    loop {
        state = scramble(state, 1);
        let one = effects[(state % effects.len() as u64) as usize];
        let other = effects[(state / 64 % effects.len() as u64) as usize];
        if !same_class(one, other) {
            return [one, other];
        }
    }
}
