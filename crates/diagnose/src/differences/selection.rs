//! Which differences the machine's records call for.

use super::reversals::{fit_across_reversals, moves_reversals};
use super::surrogate::{gains, scores, starts};
use crate::workers::Workers;
use switchback_identify::record::{Criterion, Effort, Sensitivities, Stretch, fit};
use switchback_model::system::{LAWS, Quantity, Scale, System, Term, price};

/// One difference between two systems.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Difference {
    /// A quantity has another value.
    Quantity(Quantity, f64),
    /// An effect is there that the base lacks.
    Effect(Term),
}

impl Difference {
    /// Numbers that it takes to describe it.
    pub(super) fn parameters(&self) -> usize {
        match self {
            Self::Quantity(..) => 1,
            // A constant of its law was chosen from several starts: it counts as well.
            Self::Effect(term) => term.values.len(),
        }
    }
}

/// The base with some differences, and the quantities by which these are described.
pub(super) fn with(base: &System, differences: &[Difference]) -> (System, Vec<Quantity>) {
    let mut system = base.clone();
    let (mut own, mut free) = (Vec::new(), Vec::new());
    for difference in differences {
        match difference {
            Difference::Quantity(quantity, value) => own.push((*quantity, *value)),
            Difference::Effect(term) => {
                system.terms.push(term.clone());
                free.extend(Quantity::of_term(&system, system.terms.len() - 1));
            }
        }
    }
    // Widths before slopes, slopes before curvatures: each leaves what is set after it to be set.
    own.sort_by_key(|(quantity, _)| *quantity);
    for (quantity, value) in &own {
        system = quantity.set(&system, *value);
    }
    (system, own.iter().map(|(q, _)| *q).chain(free).collect())
}

/// The differences as a system has them.
fn read(system: &System, base: &System, differences: &[Difference]) -> Vec<Difference> {
    let mut terms = system.terms[base.terms.len()..].iter();
    let read = |difference: &Difference| match difference {
        Difference::Quantity(quantity, _) => Difference::Quantity(*quantity, quantity.value(system)),
        Difference::Effect(_) => Difference::Effect(terms.next().expect("a term an effect").clone()),
    };
    differences.iter().map(read).collect()
}

/// How far a selection has come.
#[derive(Debug, Clone)]
pub(super) struct Selected {
    pub(super) differences: Vec<Difference>,
    /// `Σρ` at these.
    pub(super) deviance: f64,
}

impl Selected {
    /// Whether the same quantities and effects differ.
    pub(super) fn is_of_the_kinds_of(&self, other: &Self) -> bool {
        let is_like = |(own, other): (&Difference, &Difference)| match (own, other) {
            (Difference::Quantity(own, _), Difference::Quantity(other, _)) => own == other,
            (Difference::Effect(own), Difference::Effect(other)) => {
                (own.law.effect(), own.law.name()) == (other.law.effect(), other.law.name())
            }
            _ => false,
        };
        self.differences.len() == other.differences.len()
            && self.differences.iter().zip(&other.differences).all(is_like)
    }
}

/// Candidates that are fitted at each step, of those that are scored.
const FITTED: usize = 5;
/// A further difference must explain this share of the gap, or more than the system that stands for the source may miss of it: less can come from that.
const LEAST_SHARE: f64 = 0.01;
/// Most differences.
const MOST: usize = 10;
/// Delays from which a fit starts, samples.
const DELAYS: [f64; 6] = [-6.0, -3.0, -1.0, 1.0, 3.0, 6.0];
/// Factors of a quantity that moves reversals from which a fit starts.
const FACTORS: [f64; 4] = [0.0, 0.5, 1.5, 2.5];

/// What a selection compares systems by.
#[derive(Debug)]
pub(super) struct Context<'a, W> {
    pub(super) workers: &'a W,
    pub(super) base: &'a System,
    pub(super) stretches: Vec<Stretch>,
    /// The criterion of the errors that remain.
    pub(super) criterion: Criterion,
    pub(super) scale: &'a Scale,
    pub(super) samples: usize,
    /// Deviance by which the base misses the source.
    pub(super) misfit: f64,
}

impl<W: Workers> Context<'_, W> {
    fn fit(&self, differences: &[Difference], effort: Effort) -> Selected {
        let (start, free) = with(self.base, differences);
        let context = (&self.criterion, self.scale);
        let of = if effort == Effort::FINAL { fit_across_reversals } else { fit };
        let (system, deviance) = of(&start, &free, &self.stretches, context, effort);
        Selected { differences: read(&system, self.base, differences), deviance }
    }

    fn worth(&self, selected: &Selected) -> f64 {
        let prices = selected.differences.iter().map(|d| price(self.samples, d.parameters()));
        selected.deviance + prices.sum::<f64>()
    }

    /// The cheaper of two searches: one over all candidates, and one that looks at quantities of both sides alone until none gains any more, since a flexible
    /// law can pass for several values that are off.
    pub(super) fn select(&self, start: Vec<Difference>) -> Selected {
        let start = self.fit(&start, Effort::SEARCH);
        let at_once = self.stepwise(start.clone(), true);
        let apart = self.stepwise(self.stepwise(start, false), true);
        let best = if self.worth(&apart) <= self.worth(&at_once) { apart } else { at_once };
        self.without_the_needless(self.fit(&best.differences, Effort::FINAL))
    }

    /// The search over all candidates from the selection under another criterion.
    pub(super) fn reselect(&self, start: &[Difference]) -> Selected {
        let best = self.stepwise(self.fit(start, Effort::SEARCH), true);
        self.without_the_needless(self.fit(&best.differences, Effort::FINAL))
    }

    /// Stepwise: the candidate that gains most is taken while it gains more than its price, and after each step those are dropped that no longer do.
    fn stepwise(&self, mut now: Selected, with_effects: bool) -> Selected {
        loop {
            now = self.without_the_needless(now);
            if now.differences.len() >= MOST {
                return now;
            }
            match self.best_addition(&now, with_effects) {
                Some(next) => now = next,
                None => return now,
            }
        }
    }

    /// The best addition, if it gains more than its price.
    fn best_addition(&self, now: &Selected, with_effects: bool) -> Option<Selected> {
        let (system, taken) = with(self.base, &now.differences);
        let context = (&self.criterion, self.scale);
        let mut tries: Vec<(f64, Difference)> = Vec::new();
        let open: Vec<Quantity> = quantities(self.base).filter(|q| !taken.contains(q)).collect();
        let all = [&taken[..], &open].concat();
        let local = Sensitivities::of(&system, &all, &self.stretches, context);
        for (gain, quantity) in gains(&local, taken.len()).into_iter().zip(&open) {
            tries.push((gain, Difference::Quantity(*quantity, quantity.value(&system))));
        }
        let terms = if with_effects { starts(LAWS, self.scale, &system.terms) } else { Vec::new() };
        let scores = scores(&system, &taken, &terms, &self.stretches, context);
        tries.extend(scores.into_iter().zip(terms.into_iter().map(Difference::Effect)));
        tries.sort_by(|x, y| y.0.total_cmp(&x.0));
        let mut tries: Vec<Difference> = tries.into_iter().take(FITTED).map(|t| t.1).collect();
        if open.contains(&Quantity::Delay) {
            let delay = Quantity::Delay.value(&system);
            tries.extend(DELAYS.map(|more| Difference::Quantity(Quantity::Delay, delay + more)));
        }
        for quantity in open.into_iter().filter(|q| moves_reversals(&system, *q)) {
            let value = quantity.value(&system);
            tries.extend(FACTORS.map(|factor| Difference::Quantity(quantity, factor * value)));
        }
        let fits = self.workers.map(&tries, |difference| {
            self.fit(&[&now.differences[..], std::slice::from_ref(difference)].concat(), Effort::SEARCH)
        });
        let best = fits.into_iter().min_by(|x, y| self.worth(x).total_cmp(&self.worth(y)))?;
        let explained = Sensitivities::deviance(self.base, &self.stretches, &self.criterion) - now.deviance;
        let gained = now.deviance - best.deviance;
        let least = self.misfit.min(LEAST_SHARE * explained);
        (self.worth(&best) < self.worth(now) && gained > least).then_some(best)
    }

    /// The selection without each of its differences, the others fitted again.
    fn without_each(&self, now: &Selected) -> Vec<Selected> {
        let numbers: Vec<usize> = (0..now.differences.len()).collect();
        self.workers.map(&numbers, |&number| {
            let mut differences = now.differences.clone();
            differences.remove(number);
            self.fit(&differences, Effort::SEARCH)
        })
    }

    /// For every difference the growth of the deviance without it, the others fitted again.
    pub(super) fn losses(&self, selected: &Selected) -> Vec<f64> {
        let without = self.without_each(selected).into_iter();
        without.map(|fewer| (fewer.deviance - selected.deviance).max(0.0)).collect()
    }

    fn without_the_needless(&self, mut now: Selected) -> Selected {
        loop {
            let fewer = self.without_each(&now).into_iter();
            match fewer.min_by(|x, y| self.worth(x).total_cmp(&self.worth(y))) {
                Some(best) if self.worth(&best) <= self.worth(&now) => now = best,
                _ => return now,
            }
        }
    }
}

/// What may have another value in the machine: the base's own quantities, and the parameters of its effects.
pub(super) fn quantities(base: &System) -> impl Iterator<Item = Quantity> + '_ {
    Quantity::all(base).into_iter().chain((0..base.terms.len()).flat_map(|k| Quantity::of_term(base, k)))
}
