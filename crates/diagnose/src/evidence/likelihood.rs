//! Each promising effect fitted by maximum likelihood together with the whole base, each fit under the noise model of its own errors.

use super::context::Context;
use super::refine::Refined;
use crate::price::price;
use switchback_identify::record::{Criterion, Effort, Sensitivities, Stretch, fit};
use switchback_model::system::{Quantity, System, Term};

/// What a fit with an effect gains beside the fit without.
#[derive(Debug, Clone)]
pub(super) struct Likelihood {
    pub(super) effect: &'static str,
    /// The base with the effect.
    pub(super) system: System,
    /// Log-likelihood gained on the records that were fitted, nats a sample.
    pub(super) fitted: f64,
    /// The same on all others; zero where there are none.
    pub(super) held_out: f64,
    /// Energy of the free run's error without the effect over that with it, as a logarithm: on the records that were fitted, and on all others.
    pub(super) closed: [f64; 2],
    /// What the effect gains over the extended BIC's price of its parameters.
    pub(super) over_price: f64,
}

/// Iterations of each fit.
const EFFORT: Effort = Effort { iterations: 10, tolerance: 2e-3 };

/// A fit to some records, and what it says of these and of others.
struct Fitted {
    system: System,
    /// `ln σ̂²` of the filtered errors.
    log_variance: f64,
    /// `ln σ̂² + σ_h²/σ̂²`, with `σ_h²` the mean square of filtered errors of the other records.
    held_out: f64,
    /// Mean squares of the free run's errors.
    energy: [f64; 2],
}

/// Records that are fitted, and others.
struct Data {
    fitted: Vec<Stretch>,
    others: Vec<Stretch>,
    samples: f64,
}

fn errors(system: &System, stretches: &[Stretch]) -> Vec<Vec<f64>> {
    let of = |s: &Stretch| s.simulate(system).iter().zip(&s.y).map(|(run, y)| y - run).collect();
    stretches.iter().map(of).collect()
}

fn mean_square(errors: &[Vec<f64>]) -> f64 {
    let count: usize = errors.iter().map(Vec::len).sum();
    errors.iter().flatten().map(|e| e * e).sum::<f64>() / count.max(1) as f64
}

impl Data {
    fn of(context: &Context<'_>, is_fitted: &[bool]) -> Self {
        let of_use = |fitted: bool| -> Vec<Stretch> {
            let all = context.stretches.iter().zip(is_fitted).filter(|(_, is)| **is == fitted);
            all.map(|(stretch, _)| stretch.clone()).collect()
        };
        let fitted = of_use(true);
        let samples = fitted.iter().map(|s| s.v.len()).sum::<usize>() as f64;
        Self { fitted, others: of_use(false), samples }
    }

    /// First by the free run's error, then by that filtered with the noise model that it has there.
    fn fit(&self, context: &Context<'_>, start: &System, free: &[Quantity]) -> Fitted {
        let plain = Criterion { filter: Vec::new(), ..Criterion::of(&errors(start, &self.fitted)) };
        let (first, _) = fit(start, free, &self.fitted, (&plain, &context.scale), EFFORT);
        let white = Criterion::of(&errors(&first, &self.fitted));
        let (system, _) = fit(&first, free, &self.fitted, (&white, &context.scale), EFFORT);
        let [of_fitted, of_others] = [&self.fitted, &self.others].map(|s| errors(&system, s));
        let last = Criterion::of(&of_fitted);
        let variance = |stretches: &[Stretch]| {
            let count: usize = stretches.iter().map(|s| s.v.len()).sum();
            last.sd.powi(2) * Sensitivities::deviance(&system, stretches, &last) / count.max(1) as f64
        };
        let own = variance(&self.fitted).max(f64::MIN_POSITIVE);
        Fitted {
            log_variance: libm::log(own),
            held_out: libm::log(own) + variance(&self.others) / own,
            energy: [mean_square(&of_fitted), mean_square(&of_others)],
            system,
        }
    }
}

/// Fits, best first: each of the given effects from the optima of its laws to first order, and what a larger base gains.
pub(super) struct Likelihoods {
    pub(super) all: Vec<Likelihood>,
    /// Log-likelihood that a larger order gains, nats a sample.
    pub(super) order: f64,
}

impl Likelihoods {
    /// Of some effects, all coordinates of the base free.
    pub(super) fn of(
        context: &Context<'_>,
        is_fitted: &[bool],
        (effects, refined): (&[&'static str], &[&Refined]),
    ) -> Self {
        let data = Data::of(context, is_fitted);
        let base = data.fit(context, context.base, &context.coordinates);
        let compared = |effect: &'static str, (fitted, parameters): (Fitted, usize)| {
            let price = price(data.samples as usize, parameters);
            let gain = 0.5 * (base.log_variance - fitted.log_variance);
            let ratio = |k: usize| {
                libm::log((base.energy[k] + f64::MIN_POSITIVE) / (fitted.energy[k] + f64::MIN_POSITIVE))
            };
            let has_others = !data.others.is_empty();
            Likelihood {
                effect,
                fitted: gain,
                held_out: if has_others { 0.5 * (base.held_out - fitted.held_out) } else { 0.0 },
                closed: [ratio(0), if has_others { ratio(1) } else { 0.0 }],
                over_price: 2.0 * data.samples * gain / price,
                system: fitted.system,
            }
        };
        let best = |starts: Vec<(System, Vec<Quantity>)>| {
            let own = context.coordinates.len();
            let fits = starts
                .iter()
                .map(|(start, free)| (data.fit(context, start, free), free.len().saturating_sub(own).max(1)));
            fits.min_by(|x, y| x.0.log_variance.total_cmp(&y.0.log_variance))
        };
        let of_effect = |effect: &&'static str| {
            let terms = refined.iter().filter(|r| r.term.law.effect() == *effect).map(|r| &r.term);
            Some(compared(effect, best(starts(context, &base.system, effect, terms))?))
        };
        let mut all: Vec<Likelihood> = effects.iter().filter_map(of_effect).collect();
        all.sort_by(|x, y| y.fitted.total_cmp(&x.fitted));
        let larger = base.system.linear.larger().into_iter().map(|linear| {
            let system = System { linear, ..base.system.clone() };
            let free = Quantity::coordinates(&system);
            (system, free)
        });
        let order = best(larger.collect()).map_or(0.0, |fitted| compared("order", fitted).fitted);
        Self { all, order }
    }
}

/// Systems from which an effect is fitted, and their free quantities.
fn starts<'a>(
    context: &Context<'_>,
    base: &System,
    effect: &str,
    terms: impl Iterator<Item = &'a Term>,
) -> Vec<(System, Vec<Quantity>)> {
    let own = &context.coordinates;
    let with = |term: &Term| {
        let mut with = base.clone();
        with.terms.push(term.clone());
        let free = [&own[..], &Quantity::of_term(&with, with.terms.len() - 1)].concat();
        (with, free)
    };
    match effect {
        "input_delay" => {
            let delay = Quantity::Delay.value(base);
            let free = [&own[..], &[Quantity::Delay]].concat();
            [-1.0, 1.0, 2.0].map(|more| (Quantity::Delay.set(base, delay + more), free.clone())).into()
        }
        "border_resolution" => {
            let (low, high) = base.borders.range();
            let knots = base.borders.count() as f64 / 2.0;
            let fine = base.borders.refined(0.5 * (high - low) / (knots - 1.0).max(1.0));
            let system = System { borders: fine, ..base.clone() };
            let free = Quantity::coordinates(&system);
            vec![(system, free)]
        }
        _ => terms.map(with).collect(),
    }
}
