//! A system in place of a source of which only predictions are known.

use super::errors::errors;
use super::reversals::{fit_across_reversals, fit_on_knots, moves_reversals, profiled};
use crate::evidence::{behind, nominal};
use crate::workers::Workers;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use switchback_identify::free::FreeError;
use switchback_identify::record::{Criterion, Effort, Sensitivities, Stretch};
use switchback_model::record::Record;
use switchback_model::reversal::{ReversalRule, Timing};
use switchback_model::system::{LAWS, Law, LinearPart, Quantity, Scale, System, Term, every_law, price};

/// Square of a misfit over that of the machine's noise that matters to no difference: the carrier has it on both sides.
pub(super) const SMALL_MISFIT: f64 = 0.02;
/// Most effects that a surrogate may have, and most steps by which it grows.
const MOST_EFFECTS: usize = 4;
const MOST_STEPS: usize = 6;
/// Share of the misfit that must go for more detail to be worth having.
const LEAST_GAIN: f64 = 0.8;
/// Candidates that are fitted, of those looked at.
const FITTED: usize = 4;
/// Rounds of identification behind a law, each at the strength fitted by the last, at most.
const ROUNDS: usize = 4;
/// Order of a system whose effects are not known yet.
const MIDDLING: usize = 2;
/// Distance between knots, of that of the identified borders, below which no structure is searched.
const FINEST: f64 = 0.25;
/// Candidates that are fitted in their variants, too.
const VARIED: usize = 2;
/// Halvings of the distance between knots once the structure is found, at most.
const MOST_HALVINGS: usize = 2;

/// Leads of reversals that are tried first.
const LEADS: [u16; 7] = [64, 128, 224, 352, 512, 768, 1152];

/// Fits that only the structure depends on, or many knots.
const STEP: Effort = Effort { iterations: 12, tolerance: 1e-5 };

/// Everything that fits of a surrogate are compared by.
struct Search<'a, W> {
    workers: &'a W,
    stretches: &'a [Stretch],
    criterion: Criterion,
    scale: Scale,
    samples: usize,
    /// Distance between knots below which no structure is searched.
    finest: f64,
}

/// A system that runs as these records do, effects among it where the borders and a linear part are not enough.
///
/// `noise` is the standard deviation below which a misfit does not count: that of the machine's noise. The structure is identified from the records with such
/// noise added, so that it has no more detail than the machine's records could show; all numbers are then fitted to the records themselves. An effect is taken where
/// its gain exceeds the extended BIC's price of its parameters, and what an effect makes needless, a pole or another effect, is dropped.
pub(super) fn surrogate(
    workers: &impl Workers,
    records: &[&Record],
    noise: f64,
) -> Result<Option<System>, FreeError> {
    let noisy: Vec<Record> = records.iter().enumerate().map(|(k, r)| with_noise(r, noise, k)).collect();
    let Some(mut system) = nominal(&noisy.iter().collect::<Vec<_>>(), (None, None))? else { return Ok(None) };
    // An effect may have passed for a delay.
    system.linear = system.linear.widened();
    let pairs: Vec<(&[f64], &[f64])> = records.iter().map(|r| (r.v(), r.y())).collect();
    let stretches = stretches(records, &system);
    let samples = stretches.iter().map(|s| s.v.len()).sum();
    let criterion = Criterion { filter: Vec::new(), sd: noise };
    let search = Search {
        workers,
        stretches: &stretches,
        criterion,
        scale: Scale::of(&system.linear, system.rule, &pairs),
        samples,
        finest: FINEST * system.borders.apart(),
    };
    // Effects may pass for dynamics, as a mass does for a pair of poles: the search begins once without any.
    let (immediate, _) = LinearPart::new(&[], &[1.0], 0).expect("a gain of one");
    let without_dynamics = System { linear: immediate, ..system.clone() };
    // A law that moves reversals passes for much else: where it gains, the structure is identified behind it.
    let (_, plain) = search.fit(&search.refined(&system, 0.5), STEP);
    let behind = search.behind(&noisy.iter().collect::<Vec<_>>(), plain);
    // Where one is as good as the source, the next is not let grow larger.
    let mut best: Option<(System, f64)> = None;
    for start in behind.into_iter().chain([system, without_dynamics]) {
        let most = best.as_ref().filter(|best| best.1 < search.small()).map(|best| best.0.priced());
        let grown = search.grown(&start, most);
        best = best.into_iter().chain([grown]).min_by(|x, y| search.worth(x).total_cmp(&search.worth(y)));
    }
    Ok(best.map(|(best, _)| search.finished(&best)))
}

/// Records of a source by which systems as long as this one are compared.
pub(super) fn stretches(records: &[&Record], system: &System) -> Vec<Stretch> {
    let all = Stretch::all(&records.iter().map(|r| (r.v(), r.y())).collect::<Vec<_>>());
    all.into_iter().map(|s| s.behind_earlier_inputs(system, 0)).collect()
}

/// The record with white noise on its output, of a seed of its own.
fn with_noise(record: &Record, sd: f64, number: usize) -> Record {
    let mut rng = ChaCha8Rng::seed_from_u64(number as u64);
    let y = record.y().iter().map(|y| y + sd * rng.sample::<f64, _>(StandardNormal)).collect();
    Record::new(record.v().to_vec(), y).expect("finite values of equal number")
}

impl<W: Workers> Search<'_, W> {
    fn fit(&self, system: &System, effort: Effort) -> (System, f64) {
        let context = (&self.criterion, &self.scale);
        fit_across_reversals(system, &Quantity::coordinates(system), self.stretches, context, effort)
    }

    /// Deviance below which a system is as good as the source.
    fn small(&self) -> f64 {
        SMALL_MISFIT * self.samples as f64
    }

    /// The system fitted to the end, on borders with two, then four times as many knots while that explains more: what is left of curved borders would be
    /// taken for a difference.
    fn finished(&self, system: &System) -> System {
        let (mut system, mut deviance) = self.fit(system, Effort::FINAL);
        let context = (&self.criterion, &self.scale);
        for _ in 0..MOST_HALVINGS {
            let start = self.refined(&system, 0.5);
            let (finer, _) =
                fit_on_knots(&start, &Quantity::coordinates(&start), self.stretches, context, STEP);
            // Knots are many, and hardly move with the effects.
            let terms: Vec<Quantity> =
                (0..finer.terms.len()).flat_map(|k| Quantity::of_term(&finer, k)).collect();
            let (finer, least) = fit_across_reversals(&finer, &terms, self.stretches, context, Effort::FINAL);
            if least > LEAST_GAIN * deviance {
                break;
            }
            (system, deviance) = (finer, least);
        }
        system
    }

    /// The same on borders with knots at a share of their mean distance, where one sample at least determines each.
    fn refined(&self, system: &System, share: f64) -> System {
        let borders = system.borders.refined(share * system.borders.apart());
        let mut refined = System { borders, ..system.clone() };
        loop {
            let mut weights = vec![0.0; refined.borders.count()];
            for stretch in self.stretches {
                let own = refined.knot_weights(&stretch.v, stretch.span);
                weights.iter_mut().zip(own).for_each(|(sum, weight)| *sum += weight);
            }
            match refined.borders.without_light_knots(&weights, 1.0) {
                Some(borders) => refined.borders = borders,
                None => return refined,
            }
        }
    }

    /// Deviance and price of all its numbers.
    fn worth(&self, (system, deviance): &(System, f64)) -> f64 {
        // A misfit below the one that matters is none.
        deviance.max(self.small()) + price(self.samples, system.priced())
    }

    /// The system identified behind a law that moves reversals, and that law fitted with it; none where no start of one gains on the deviance without any.
    fn behind(&self, noisy: &[&Record], without: f64) -> Option<System> {
        if without < self.small() {
            return None;
        }
        let mut moves = starts(LAWS, &self.scale, &[]);
        moves.retain(|term| term.law.moves_reversals());
        // Of a middling order, until its strength is known.
        let fitted = self.workers.map(&moves, |term| {
            let start = behind(noisy, term, Some(MIDDLING)).ok()??;
            Some(self.fit(&start, Effort::SEARCH))
        });
        let (mut best, least) = fitted.into_iter().flatten().min_by(|x, y| x.1.total_cmp(&y.1))?;
        if least > LEAST_GAIN * without {
            return None;
        }
        for _ in 0..ROUNDS {
            let before = best.terms[0].values[0];
            (best, _) = self.fit(&behind(noisy, &best.terms[0], None).ok()??, STEP);
            if (best.terms[0].values[0] - before).abs() < 0.01 * before {
                break;
            }
        }
        Some(best)
    }

    /// The system with effects, poles and knots added while these explain enough, and without those that are needless then; not beyond the number of parameters
    /// with which another system is as good as the source.
    fn grown(&self, start: &System, most: Option<usize>) -> (System, f64) {
        let fitted = start.with_every_timing().map(|start| self.fit(&start, Effort::FINAL));
        let best = fitted.min_by(|x, y| x.1.total_cmp(&y.1)).expect("its own timing");
        let (mut system, mut deviance) = self.with_lead(best);
        let small = self.small();
        for _ in 0..MOST_STEPS {
            if deviance < small || most.is_some_and(|most| system.priced() >= most) {
                break;
            }
            let (now, terms) = (system.priced(), system.terms.len());
            let judged = |start: &System| {
                let (with, deviance) = self.fit(start, Effort::SEARCH);
                let more = with.priced().saturating_sub(now);
                // Where borders and poles are enough, no effect stands for their shape: it costs nothing.
                let is_enough = deviance < small && with.terms.len() == terms;
                (if is_enough { 0.0 } else { deviance + price(self.samples, more) }, with, deviance)
            };
            let mut tried = self.workers.map(&self.larger(&system), judged);
            tried.sort_by(|x, y| x.0.total_cmp(&y.0));
            let variants = |(_, system, _): &(f64, System, f64)| system.variants(&self.scale);
            let varied: Vec<System> = tried.iter().take(VARIED).flat_map(variants).collect();
            tried.extend(self.workers.map(&varied, judged));
            let Some((worth, best, least)) = tried.into_iter().min_by(|x, y| x.0.total_cmp(&y.0)) else {
                break;
            };
            if worth > deviance || least > LEAST_GAIN * deviance {
                break;
            }
            (system, deviance) = self.fit(&best, Effort::FINAL);
            (system, deviance) = self.without_the_needless(system, deviance);
        }
        self.without_the_needless(system, deviance)
    }

    /// The system with reversals that lead the velocity, by the lead that fits best, where that explains enough.
    fn with_lead(&self, plain: (System, f64)) -> (System, f64) {
        if plain.1 < self.small() {
            return plain;
        }
        let leading = |lead| System {
            rule: ReversalRule { timing: Timing::ByVelocity { lead }, ..plain.0.rule },
            ..plain.0.clone()
        };
        let best_of = |leads: &[u16]| {
            let tried = self.workers.map(leads, |lead| (self.fit(&leading(*lead), STEP).1, *lead));
            tried.into_iter().min_by(|x, y| x.0.total_cmp(&y.0)).expect("a lead")
        };
        let mut best = best_of(&LEADS);
        let mut step = best.1 / 4;
        while step > 0 {
            let around = best_of(&[best.1.saturating_sub(step), best.1.saturating_add(step)]);
            if around.0 < best.0 { best = around } else { step /= 2 }
        }
        if best.0 > LEAST_GAIN * plain.1 { plain } else { self.fit(&leading(best.1), Effort::FINAL) }
    }

    /// Without the terms and poles that cost more than they explain.
    fn without_the_needless(&self, mut system: System, mut deviance: f64) -> (System, f64) {
        loop {
            let fewer = self.workers.map(&system.smaller(), |(start, saved)| {
                let (system, deviance) = self.fit(start, Effort::SEARCH);
                (deviance - price(self.samples, *saved), system, deviance)
            });
            match fewer.into_iter().min_by(|x, y| x.0.total_cmp(&y.0)) {
                Some((worth, ..)) if worth >= deviance => return (system, deviance),
                Some((_, best, least)) => (system, deviance) = (best, least),
                None => return (system, deviance),
            }
        }
    }

    /// The system with one effect more, with one pole more, or with borders on two or four times as many knots, but for those finer than a search needs.
    fn larger(&self, system: &System) -> Vec<System> {
        let may_grow = system.terms.len() < MOST_EFFECTS;
        let candidates = if may_grow { self.candidates(system) } else { Vec::new() };
        let effects = candidates.into_iter().map(|term| system.and(term));
        let linear = system.linear.larger().into_iter().map(|linear| System { linear, ..system.clone() });
        let coarse = [0.5, 0.25].into_iter().filter(|share| share * system.borders.apart() >= self.finest);
        let refined = coarse.map(|share| self.refined(system, share));
        effects.chain(linear).chain(refined).chain([system.clone()]).collect()
    }

    /// The effects whose change of the run explains most of the error, beside the coordinates of the system: the best start and law of each effect, the best effects first.
    fn candidates(&self, system: &System) -> Vec<Term> {
        // A further pole belongs to the linear part.
        let mut starts = starts(every_law(), &self.scale, &system.terms);
        starts.retain(|term| term.law.effect() != "extra_pole");
        let context = (&self.criterion, &self.scale);
        let scores = scores(system, &Quantity::coordinates(system), &starts, self.stretches, context);
        let mut scored: Vec<(f64, Term)> = Vec::new();
        for (term, score) in starts.into_iter().zip(scores) {
            match scored.iter_mut().find(|(_, t)| t.law.effect() == term.law.effect()) {
                Some(best) if best.0 < score => *best = (score, term),
                Some(_) => {}
                None => scored.push((score, term)),
            }
        }
        scored.sort_by(|x, y| y.0.total_cmp(&x.0));
        scored.into_iter().take(FITTED).map(|(_, term)| term).collect()
    }
}

/// Every start of every law of an effect that is not there yet.
pub(super) fn starts(
    laws: impl IntoIterator<Item = &'static dyn Law>,
    scale: &Scale,
    present: &[Term],
) -> Vec<Term> {
    let absent = |law: &&'static dyn Law| present.iter().all(|t| t.law.effect() != law.effect());
    laws.into_iter()
        .filter(absent)
        .flat_map(|law| law.starts(scale).into_iter().map(move |values| Term { law, values }))
        .collect()
}

/// Eigenvalue of the scaled information below which a direction is none that the records show.
const LEAST_EIGENVALUE: f64 = 1e-7;

/// Quantities of a surrogate, and their standard errors as if its misfit were noise of the same colour: by how much another structure of the same merit might move
/// them.
pub(super) fn own_values(
    system: &System,
    records: &[Stretch],
    scale: &Scale,
    quantities: &[Quantity],
) -> Vec<(f64, f64)> {
    if records.is_empty() {
        // The system is the source itself.
        return quantities.iter().map(|q| (q.value(system), 0.0)).collect();
    }
    let errors = errors(system, records);
    let criterion = Criterion::of(&errors);
    let coordinates = Quantity::coordinates(system);
    let local = Sensitivities::of(system, &coordinates, records, (&criterion, scale));
    let count = coordinates.len();
    let sizes = DVector::from_fn(count, |i, _| local.information[(i, i)].sqrt().max(f64::MIN_POSITIVE));
    let scaled = DMatrix::from_fn(count, count, |i, j| local.information[(i, j)] / (sizes[i] * sizes[j]));
    let eigen = scaled.symmetric_eigen();
    // A direction that changes no run has no error: whatever lies along it is the same system.
    let solve = |x: &DVector<f64>| {
        let parts = (0..count).filter(|&k| eigen.eigenvalues[k] > LEAST_EIGENVALUE).map(|k| {
            let direction = eigen.eigenvectors.column(k);
            direction * (direction.dot(x) / eigen.eigenvalues[k])
        });
        parts.fold(DVector::zeros(count), |sum, part| sum + part)
    };
    let blocks: Vec<DVector<f64>> =
        local.blocks.iter().map(|b| DVector::from_fn(count, |i, _| b[i] / sizes[i])).collect();
    let of = |quantity: &Quantity| {
        if moves_reversals(system, *quantity) {
            return profiled(system, *quantity, &coordinates, records, (&criterion, scale));
        }
        let value = quantity.value(system);
        let slope = |c: &Quantity| {
            let step = c.step(system, scale);
            // A move of a coefficient may make a pair of two equal poles, which have other quantities; the other way it makes none.
            let tried = [step, -step].into_iter().find_map(|step| {
                let moved = c.set(system, c.value(system) + step);
                quantity.is_of(&moved).then(|| (quantity.value(&moved) - value) / step)
            });
            tried.unwrap_or(0.0)
        };
        let gradient = DVector::from_fn(count, |i, _| slope(&coordinates[i]) / sizes[i]);
        let direction = solve(&gradient);
        let scatter: f64 = blocks.iter().map(|b| b.dot(&direction).powi(2)).sum();
        (value, gradient.dot(&direction).max(scatter).sqrt())
    };
    quantities.iter().map(of).collect()
}

/// What each term would gain in `Σρ` once its change of the run, by finite difference, is scaled freely, beside the given quantities.
pub(super) fn scores(
    system: &System,
    base: &[Quantity],
    terms: &[Term],
    stretches: &[Stretch],
    (criterion, scale): (&Criterion, &Scale),
) -> Vec<f64> {
    let added: Vec<System> = terms.iter().map(|term| system.and(term.clone())).collect();
    let moved: Vec<(System, f64)> = base
        .iter()
        .map(|q| {
            let step = q.step(system, scale);
            (q.set(system, q.value(system) + step), step)
        })
        .collect();
    let columns = stretches.iter().map(|stretch| {
        let run = stretch.simulate(system);
        let difference = |(other, step): (&System, f64)| -> Vec<f64> {
            stretch.simulate(other).iter().zip(&run).map(|(o, r)| (o - r) / step).collect()
        };
        let base = moved.iter().map(|(other, step)| difference((other, *step)));
        base.chain(added.iter().map(|other| difference((other, 1.0)))).collect()
    });
    let all = Sensitivities::with_columns(system, columns.collect(), stretches, criterion);
    gains(&all, base.len())
}

/// What each column after the first `base` would gain beside those.
pub(super) fn gains(all: &Sensitivities, base: usize) -> Vec<f64> {
    let count = all.gradient.len();
    let scale = DVector::from_fn(count, |i, _| all.information[(i, i)].sqrt().max(f64::MIN_POSITIVE));
    let scaled = |i: usize, j: usize| all.information[(i, j)] / (scale[i] * scale[j]);
    let mut h = DMatrix::from_fn(base, base, scaled);
    for i in 0..base {
        h[(i, i)] += 1e-10;
    }
    let gradient = |i: usize| all.gradient[i] / scale[i];
    let Some(factor) = h.cholesky() else { return vec![0.0; count - base] };
    let explained = factor.solve(&DVector::from_fn(base, |i, _| gradient(i)));
    (base..count)
        .map(|k| {
            let cross = DVector::from_fn(base, |i, _| scaled(i, k));
            let left = 1.0 - cross.dot(&factor.solve(&cross));
            let pull = gradient(k) - cross.dot(&explained);
            // A change that the base makes as well has nothing of its own.
            if left > 1e-6 { pull * pull / left } else { 0.0 }
        })
        .collect()
}
