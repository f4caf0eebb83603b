//! Each promising effect fitted by maximum likelihood together with the whole base, each fit under the noise model of its own errors.

use super::context::Context;
use super::refine::Refined;
use switchback_identify::record::{Chord, Criterion, Effort, Sensitivities, Stretch};
use switchback_model::system::{Quantity, System, Term, price};

/// What a fit with an effect gains beside the fit without.
#[derive(Debug, Clone)]
pub(super) struct Likelihood {
    pub(super) effect: &'static str,
    /// The base with the effect.
    pub(super) system: System,
    /// Log-likelihood gained on the records that were fitted, nats a sample.
    pub(super) fitted: f64,
    /// The same with the noise model of the fit with the effect for both.
    pub(super) same_noise: f64,
    /// Log-likelihood gained on all others; zero where there are none.
    pub(super) held_out: f64,
    /// Energy of the free run's error without the effect over that with it, as a logarithm: on the records that were fitted, and on all others.
    pub(super) closed: [f64; 2],
    /// What the effect gains over the extended BIC's price of its parameters.
    pub(super) over_price: f64,
}

/// Iterations along one chord.
const EFFORT: Effort = Effort { iterations: 6, tolerance: 2e-3 };
/// Further chords of a fit, at most.
const CHORDS: usize = 3;
/// Iterations of a fit that ranks sizes.
const RANKING: Effort = Effort { iterations: 2, tolerance: 1e-2 };

/// A fit to some records, and what it says of these and of others.
struct Fitted {
    system: System,
    /// The noise model of its errors.
    noise: Criterion,
    /// `ln σ̂²` of the filtered errors.
    log_variance: f64,
    /// `ln σ̂² + σ_h²/σ̂²`, with `σ_h²` the mean square of filtered errors of the other records.
    held_out: f64,
    /// Mean squares of the free run's errors.
    energy: [f64; 2],
}

/// Where a fit begins, and what is free in it beside the values at knots.
struct Start {
    system: System,
    free: Vec<Quantity>,
}

impl Start {
    /// With the linear part and some quantities free.
    fn new(system: System, further: &[Quantity]) -> Self {
        let linear = (0..system.linear.coefficients()).map(Quantity::Coefficient);
        let free = linear.chain(further.iter().copied()).collect();
        Self { system, free }
    }

    /// A base with a term, the parameters of which are free.
    fn with(base: &System, term: &Term) -> Self {
        let mut system = base.clone();
        system.terms.push(term.clone());
        let own = Quantity::of_term(&system, system.terms.len() - 1);
        Self::new(system, &own)
    }
}

fn knots(system: &System) -> Vec<Quantity> {
    (0..system.borders.count()).map(Quantity::Knot).collect()
}

/// Records that are fitted, and others.
struct Data<'a> {
    context: &'a Context<'a>,
    fitted: Vec<Stretch>,
    others: Vec<Stretch>,
    samples: f64,
    /// By the free run's error.
    plain: Criterion,
}

fn errors(system: &System, stretches: &[Stretch]) -> Vec<Vec<f64>> {
    let of = |s: &Stretch| s.simulate(system).iter().zip(&s.y).map(|(run, y)| y - run).collect();
    stretches.iter().map(of).collect()
}

fn mean_square(errors: &[Vec<f64>]) -> f64 {
    let count: usize = errors.iter().map(Vec::len).sum();
    errors.iter().flatten().map(|e| e * e).sum::<f64>() / count.max(1) as f64
}

impl<'a> Data<'a> {
    fn of(context: &'a Context<'a>, is_fitted: &[bool]) -> Self {
        let of_use = |fitted: bool| -> Vec<Stretch> {
            let all = context.stretches.iter().zip(is_fitted).filter(|(_, is)| **is == fitted);
            all.map(|(stretch, _)| stretch.clone()).collect()
        };
        let fitted = of_use(true);
        let samples = fitted.iter().map(|s| s.v.len()).sum::<usize>() as f64;
        let plain = Criterion { filter: Vec::new(), ..Criterion::of(&errors(context.base, &fitted)) };
        Self { context, fitted, others: of_use(false), samples, plain }
    }

    /// The chord of the values at knots.
    fn chord<'b>(&'b self, system: &System, criterion: &'b Criterion) -> Chord<'b> {
        Chord::of(system, &knots(system), &self.fitted, (criterion, &self.context.scale))
    }

    /// The system of least deviance near a start, the chord renewed as long as that pays.
    fn descent(&self, start: &System, free: &[Quantity], criterion: &Criterion) -> (System, f64) {
        let (mut system, mut now) = self.chord(start, criterion).fit(start, free, EFFORT);
        for _ in 0..CHORDS {
            let before = now;
            (system, now) = self.chord(&system, criterion).fit(&system, free, EFFORT);
            if before - now <= EFFORT.tolerance * before {
                break;
            }
        }
        (system, now)
    }

    /// A start fitted under one criterion, and then under the noise model of its own errors.
    fn fit(&self, start: &Start, criterion: &Criterion) -> Fitted {
        let (first, _) = self.descent(&start.system, &start.free, criterion);
        let white = Criterion::of(&errors(&first, &self.fitted));
        let (system, _) = self.descent(&first, &start.free, &white);
        let [of_fitted, of_others] = [&self.fitted, &self.others].map(|s| errors(&system, s));
        let noise = Criterion::of(&of_fitted);
        let own = self.variance(&system, true, &noise);
        Fitted {
            log_variance: libm::log(own),
            held_out: libm::log(own) + self.variance(&system, false, &noise) / own,
            energy: [mean_square(&of_fitted), mean_square(&of_others)],
            noise,
            system,
        }
    }

    /// The best fit of several starts, each with its criterion.
    fn best<'b>(&self, starts: impl Iterator<Item = (&'b Start, &'b Criterion)>) -> Option<Fitted> {
        let fits = starts.map(|(start, criterion)| self.fit(start, criterion));
        fits.min_by(|x, y| x.log_variance.total_cmp(&y.log_variance))
    }

    /// Mean square of filtered errors, far ones drawn in.
    fn variance(&self, system: &System, is_fitted: bool, noise: &Criterion) -> f64 {
        let stretches = if is_fitted { &self.fitted } else { &self.others };
        let count: usize = stretches.iter().map(|s| s.v.len()).sum();
        let deviance = Sensitivities::deviance(system, stretches, noise);
        (noise.sd.powi(2) * deviance / count.max(1) as f64).max(f64::MIN_POSITIVE)
    }

    /// What a fit says of an effect.
    fn compared(
        &self,
        effect: &'static str,
        base: &Fitted,
        (fitted, parameters): (Fitted, usize),
    ) -> Likelihood {
        let price = price(self.samples as usize, parameters);
        let gain = 0.5 * (base.log_variance - fitted.log_variance);
        let without = libm::log(self.variance(&base.system, true, &fitted.noise));
        let ratio = |k: usize| {
            libm::log((base.energy[k] + f64::MIN_POSITIVE) / (fitted.energy[k] + f64::MIN_POSITIVE))
        };
        let has_others = !self.others.is_empty();
        Likelihood {
            effect,
            fitted: gain,
            same_noise: 0.5 * (without - fitted.log_variance),
            held_out: if has_others { 0.5 * (base.held_out - fitted.held_out) } else { 0.0 },
            closed: [ratio(0), if has_others { ratio(1) } else { 0.0 }],
            over_price: 2.0 * self.samples * gain / price,
            system: fitted.system,
        }
    }

    /// Of a law whose strength moves reversals the best of strengths in equal ratios, the values at knots fitted to each.
    fn best_size(&self, base: &System, term: &Term) -> Term {
        const SIZES: i32 = 12;
        const LARGEST: f64 = 0.4;
        const RATIO: f64 = 0.67;
        let travel = self.context.scale.travel;
        let of_size = |k: i32| {
            let sized = term.set(0, LARGEST * travel * RATIO.powi(k));
            let start = Start::with(base, &sized);
            let chord = self.chord(&start.system, &self.plain);
            let (system, deviance) = chord.fit(&start.system, &start.free, RANKING);
            (deviance, system.terms[system.terms.len() - 1].clone())
        };
        let best = (0..SIZES).map(of_size).min_by(|x, y| x.0.total_cmp(&y.0));
        best.map_or_else(|| term.clone(), |(_, term)| term)
    }
}

/// Fits, best first: each of the given effects from the optima of its laws to first order, and what a larger base gains.
pub(super) struct Likelihoods {
    pub(super) all: Vec<Likelihood>,
    /// Log-likelihood that a larger order gains, nats a sample.
    pub(super) order: f64,
}

impl Likelihoods {
    /// Of some effects, all coordinates of the base free; none where the base has no fit.
    pub(super) fn of(
        context: &Context<'_>,
        is_fitted: &[bool],
        (effects, refined): (&[&'static str], [&[Refined]; 2]),
    ) -> Self {
        let data = Data::of(context, is_fitted);
        let base = data.fit(&Start::new(context.base.clone(), &[]), &data.plain);
        let of_effect = |effect: &&'static str| {
            let starts = starts(&data, &base.system, effect, refined);
            let first = starts.first()?;
            let own = first.free.len() + first.system.borders.count();
            let before = base.system.linear.coefficients() + base.system.borders.count();
            let criteria = [&data.plain, &base.noise].into_iter().cycle();
            let fitted = data.best(starts.iter().zip(criteria))?;
            Some(data.compared(effect, &base, (fitted, own.saturating_sub(before).max(1))))
        };
        let mut all: Vec<Likelihood> = effects.iter().filter_map(of_effect).collect();
        all.sort_by(|x, y| y.fitted.total_cmp(&x.fitted));
        let larger = base.system.linear.larger().into_iter();
        let larger: Vec<Start> =
            larger.map(|linear| Start::new(System { linear, ..base.system.clone() }, &[])).collect();
        let more = larger.first().map_or(1, |s| s.free.len() - base.system.linear.coefficients());
        let order = data.best(larger.iter().map(|start| (start, &data.plain)));
        let order = order.map_or(0.0, |fitted| data.compared("order", &base, (fitted, more)).fitted);
        Self { all, order }
    }
}

/// Where the fits of an effect begin: by turns for the error as it is and for that filtered by the base's noise model, of the effect's laws the
/// best to first order.
fn starts(data: &Data<'_>, base: &System, effect: &str, refined: [&[Refined]; 2]) -> Vec<Start> {
    match effect {
        "input_delay" => {
            let delay = Quantity::Delay.value(base);
            [-1.0, 1.0, 2.0]
                .map(|more| Start::new(Quantity::Delay.set(base, delay + more), &[Quantity::Delay]))
                .into()
        }
        "border_resolution" => {
            let (low, high) = base.borders.range();
            let knots = base.borders.count() as f64 / 2.0;
            let fine = base.borders.refined(0.5 * (high - low) / (knots - 1.0).max(1.0));
            vec![Start::new(System { borders: fine, ..base.clone() }, &[])]
        }
        _ => {
            let best = refined.into_iter().filter_map(|all| {
                let own = all.iter().filter(|r| r.term.law.effect() == effect);
                own.max_by(|x, y| x.share.total_cmp(&y.share)).map(|r| r.term.clone())
            });
            let mut terms: Vec<Term> = best.collect();
            if let Some(term) = terms.iter().find(|term| term.law.moves_reversals()) {
                let sized = data.best_size(base, term);
                terms = vec![sized, terms.swap_remove(terms.len() - 1)];
            }
            terms.iter().map(|term| Start::with(base, term)).collect()
        }
    }
}
