//! From a nominal system and records to columns.

use super::candidate::{Candidate, Candidates};
use super::candidates::{candidates, effects};
use super::context::{Context, Signal};
use super::grams::Grams;
use super::likelihood::{Likelihood, Likelihoods};
use super::refine::{Filtered, Refined};
use super::score::{Score, score, share};
use super::setting::{Setting, quantile, spread};
use super::shape::{Columns, lattice, shape};
use nalgebra::DVector;
use switchback_identify::record::{Criterion, Stretch};
use switchback_model::noise_model::whitened;
use switchback_model::system::{LAWS, System, Term};

/// Named numbers of a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Evidence {
    /// Names and values, in a fixed order.
    pub columns: Vec<(String, f64)>,
    /// The nominal system with each promising effect; best first.
    pub fits: Vec<EffectFit>,
}

/// The nominal system with an effect, both fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectFit {
    /// Name of the effect.
    pub effect: &'static str,
    /// Both together.
    pub system: System,
    /// Log-likelihood gained over the nominal system by itself, nats a sample.
    pub gain: f64,
}

/// The best candidate of an effect in a metric.
#[derive(Debug, Clone)]
struct Best {
    effect: &'static str,
    group: Vec<usize>,
    variant: usize,
    score: Score,
}

/// Widths of a robust standard deviation to which filtered errors are drawn in.
const DRAWN_IN: f64 = 6.0;

impl Evidence {
    /// Of a nominal system on records; none where its run leaves every range. Of each record `is_fitted` says whether the system was identified from them; `is_given` where it was identified from others.
    pub fn of(base: &System, stretches: &[Stretch], is_fitted: &[bool], is_given: bool) -> Option<Self> {
        let context = Context::new(base, stretches, is_fitted);
        let runs = context.runs(base);
        let errors = context.errors(&runs);
        if errors.iter().flatten().any(|e| !e.is_finite()) {
            return None;
        }
        let jacobian = context.jacobian(&runs);
        let setting = Setting::of(&context, &runs);
        let candidates = candidates(&context, (&runs, &errors), &setting);
        let mut out: Columns = Vec::new();

        let free = Criterion { filter: Vec::new(), sd: 1.0 };
        let (grams, filtered) = metric(&context, &free, (&jacobian, &errors, &candidates.columns), false);
        let of_f = best_of(&grams, &candidates.all);
        report("f", &grams, &of_f, &mut out);
        let error = remainder(&errors, &jacobian, &grams.absorbed);
        shape("free", &flat(&error), &setting, &mut out);
        let search = Filtered::new(&context, (&free, &runs), &filtered.jacobian, &filtered.signals[0]);
        let as_they_are = refined(&search, &candidates.all, &grams);
        report_refined("free", &context, &as_they_are, &mut out);

        let white = Criterion::of(&error);
        let (grams, filtered) = metric(&context, &white, (&jacobian, &errors, &candidates.columns), true);
        let of_w = best_of(&grams, &candidates.all);
        report("w", &grams, &of_w, &mut out);
        let search = Filtered::new(&context, (&white, &runs), &filtered.jacobian, &filtered.signals[0]);
        let whitened = refined(&search, &candidates.all, &grams);
        report_refined("refined", &context, &whitened, &mut out);

        // The remainder beside the best two candidates has the noise's own colour.
        let groups = with_refined(&candidates, &whitened);
        let rest = beside_the_best(&context, (&jacobian, &errors), &whitened, &white);
        let still = Criterion::of(&rest);
        let (grams, filtered) = metric(&context, &still, (&jacobian, &errors, &groups.columns), true);
        let of_v = best_of(&grams, &groups.all);
        report("v", &grams, &of_v, &mut out);
        // A model that was given has not taken the base's directions.
        let grams = Grams::new(&[], &filtered.signals, &context.blocks);
        report("u", &grams, &best_of(&grams, &groups.all), &mut out);
        let fixed = match is_given {
            true => {
                let search = Filtered::new(&context, (&still, &runs), &[], &filtered.signals[0]);
                refined(&search, &candidates.all, &grams)
            }
            false => Vec::new(),
        };
        report_refined("fixed", &context, &fixed, &mut out);
        out.push(("is_given".to_owned(), f64::from(u8::from(is_given))));
        let promising = promising(&[&of_f, &of_w, &of_v], &[&as_they_are, &whitened]);
        let likelihoods = Likelihoods::of(&context, is_fitted, (&promising, [&as_they_are, &whitened]));
        report_likelihoods(&likelihoods, &mut out);
        let white_rest = context.filtered(std::slice::from_ref(&rest), &still).remove(0);
        shape("rest", &flat(&white_rest), &setting, &mut out);
        shape("white", &flat(&filtered.signals[0]), &setting, &mut out);

        let rms = rms(&error);
        lattice(&stretches.iter().map(|s| &s.y[..]).collect::<Vec<_>>(), rms, &mut out);
        whole(&context, (&errors, &error, &rest), [&white, &still], &mut out);
        let fit = |l: Likelihood| EffectFit { effect: l.effect, system: l.system, gain: l.fitted };
        let fits = likelihoods.all.into_iter().map(fit).collect();
        let finite = |(name, value): (String, f64)| {
            (name, if value.is_finite() { value.clamp(-1e6, 1e6) } else { 0.0 })
        };
        Some(Self { columns: out.into_iter().map(finite).collect(), fits })
    }
}

/// Filtered signals: the error and the candidates' columns, and the Jacobian.
struct Whitened {
    jacobian: Vec<Signal>,
    signals: Vec<Signal>,
}

fn metric(
    context: &Context<'_>,
    criterion: &Criterion,
    (jacobian, errors, columns): (&[Signal], &Signal, &[Signal]),
    is_drawn_in: bool,
) -> (Grams, Whitened) {
    let signals: Vec<Signal> = std::iter::once(errors.clone())
        .chain(columns.iter().cloned())
        .chain(jacobian.iter().cloned())
        .collect();
    let mut filtered = context.filtered(&signals, criterion);
    let jacobian = filtered.split_off(1 + columns.len());
    if is_drawn_in {
        let most = DRAWN_IN * spread(filtered[0].iter().flatten().copied());
        if most > 0.0 {
            filtered[0].iter_mut().flatten().for_each(|x| *x = x.clamp(-most, most));
        }
    }
    let grams = Grams::new(&jacobian, &filtered, &context.blocks);
    (grams, Whitened { jacobian, signals: filtered })
}

/// Column `k` is signal `k + 1`.
fn group_of(candidate: &Candidate) -> Vec<usize> {
    candidate.columns.iter().map(|k| k + 1).collect()
}

/// Price of a column when candidates of one effect are compared.
const PRICE: f64 = 0.002;

fn best_of(grams: &Grams, all: &[Candidate]) -> Vec<Best> {
    let mut best: Vec<Best> = Vec::new();
    for effect in effects() {
        let own = all.iter().filter(|c| c.effect == effect).enumerate();
        let scored = own.map(|(variant, candidate)| {
            let group = group_of(candidate);
            let score = score(grams, &group);
            let worth = match is_reversed(candidate, grams) {
                true => -1.0 - score.validated.max(0.0),
                false => score.validated - PRICE * group.len() as f64,
            };
            (worth, Best { effect, group, variant, score })
        });
        let first = scored.max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.variant.cmp(&x.1.variant)));
        best.extend(first.map(|(_, best)| best));
    }
    best
}

/// Whether the error asks for the other sign of an effect that has one.
fn is_reversed(candidate: &Candidate, grams: &Grams) -> bool {
    candidate.term.as_ref().is_some_and(Term::is_one_sided) && grams.along(group_of(candidate)[0]) < 0.0
}

fn log_left(share: f64) -> f64 {
    -libm::log((1.0 - share).max(1e-4))
}

fn signed_log_left(share: f64) -> f64 {
    share.signum() * log_left(share.abs().min(1.0))
}

fn report(tag: &str, grams: &Grams, best: &[Best], out: &mut Columns) {
    let single: Vec<f64> = best.iter().map(|b| share(grams, &b.group)).collect();
    let order = {
        let mut order: Vec<usize> = (0..best.len()).collect();
        order.sort_by(|i, j| best[*j].score.validated.total_cmp(&best[*i].score.validated).then(i.cmp(j)));
        order
    };
    let joint = |i: usize, j: usize| share(grams, &[&best[i].group[..], &best[j].group].concat());
    for (k, b) in best.iter().enumerate() {
        let mut add = |name: &str, value: f64| out.push((format!("{}.{tag}_{name}", b.effect), value));
        let others: Vec<usize> = order.iter().copied().filter(|i| *i != k).take(4).collect();
        let s = b.score;
        add("share", log_left(s.share));
        add("validated", signed_log_left(s.validated));
        add("held_out", signed_log_left(s.held_out.max(-1.0)));
        add("t", s.t.clamp(-20.0, 20.0));
        add("coefficient", s.coefficient);
        add("variant", b.variant as f64);
        add("kept", grams.kept[b.group[0]]);
        let Some(first) = others.first() else { continue };
        add("ahead", s.validated - best[*first].score.validated);
        add("adds", joint(k, *first) - single[*first]);
        let left = others.iter().map(|i| joint(k, *i)).fold(0.0, f64::max) - single[k];
        add("left", left);
    }
    let mut add = |name: &str, value: f64| out.push((format!("{tag}_{name}"), value));
    add("best", best[order[0]].score.validated);
    add("second", best[order[1]].score.validated);
    add("first_two", joint(order[0], order[1]));
}

/// The best start of each law, refined.
fn refined(search: &Filtered<'_>, all: &[Candidate], grams: &Grams) -> Vec<Refined> {
    let of_law = |law: &&'static dyn switchback_model::system::Law| {
        let name = |t: &Term| (t.law.effect(), t.law.name());
        let own = all.iter().filter_map(|c| {
            let term = c.term.as_ref().filter(|t| name(t) == (law.effect(), law.name()))?;
            Some((if is_reversed(c, grams) { 0.0 } else { share(grams, &group_of(c)) }, term))
        });
        let (_, term) = own.max_by(|x, y| x.0.total_cmp(&y.0))?;
        Some(search.refined(term))
    };
    LAWS.iter().filter_map(of_law).collect()
}

/// Of each effect its best law at the optimum.
fn report_refined(tag: &str, context: &Context<'_>, refined: &[Refined], out: &mut Columns) {
    let most = refined.iter().map(|r| r.share).fold(0.0, f64::max);
    for effect in effects() {
        let own = refined.iter().enumerate().filter(|(_, r)| r.term.law.effect() == effect);
        let best = own.max_by(|x, y| x.1.share.total_cmp(&y.1.share));
        let (share, law, shape, strength) = best.map_or((0.0, 0.0, 0.0, 0.0), |(k, r)| {
            let starts = r.term.law.starts(&context.scale);
            let of = |at: usize| {
                let size = starts.iter().map(|s| s[at].abs()).sum::<f64>() / starts.len() as f64;
                let value = r.term.values.get(at).copied().unwrap_or(0.0);
                value.signum() * libm::log1p(value.abs() / size.max(f64::MIN_POSITIVE))
            };
            let shape = if r.term.values.len() > 1 { of(1) } else { 0.0 };
            (r.share, k as f64, shape, of(0))
        });
        let mut add = |name: &str, value: f64| out.push((format!("{effect}.{tag}_{name}"), value));
        add("share", log_left(share));
        add("ahead", log_left(share) - log_left(most));
        add("law", law);
        add("shape", shape);
        add("strength", strength);
    }
}

/// Effects that are fitted, at most.
const FITTED: usize = 8;

/// The effects that come first in a list: the first of each, then the second of each, and so on.
fn promising(scores: &[&[Best]], refined: &[&[Refined]]) -> Vec<&'static str> {
    let by_score = scores.iter().map(|best| {
        let mut order: Vec<&Best> = best.iter().collect();
        order.sort_by(|x, y| y.score.validated.total_cmp(&x.score.validated));
        order.iter().map(|b| b.effect).collect::<Vec<&'static str>>()
    });
    let by_share = refined.iter().map(|refined| {
        let mut order: Vec<&Refined> = refined.iter().collect();
        order.sort_by(|x, y| y.share.total_cmp(&x.share));
        order.iter().map(|r| r.term.law.effect()).collect::<Vec<&'static str>>()
    });
    let lists: Vec<Vec<&'static str>> = by_score.chain(by_share).collect();
    let longest = lists.iter().map(Vec::len).max().unwrap_or(0);
    let mut all: Vec<&'static str> = Vec::new();
    for (k, list) in (0..longest).flat_map(|k| lists.iter().map(move |list| (k, list))) {
        if let Some(effect) = list.get(k)
            && is_fitted_by_likelihood(effect)
            && !all.contains(effect)
        {
            all.push(effect);
        }
    }
    all.truncate(FITTED);
    all
}

/// Whether an effect is a change of the system that can be fitted.
fn is_fitted_by_likelihood(effect: &str) -> bool {
    ["input_delay", "border_resolution"].contains(&effect) || LAWS.iter().any(|law| law.effect() == effect)
}

/// Of each effect what its fit gains.
fn report_likelihoods(likelihoods: &Likelihoods, out: &mut Columns) {
    let all = &likelihoods.all;
    let most = all.first().map_or(0.0, |l| l.fitted);
    let signed = |x: f64| x.signum() * libm::log1p(x.abs());
    for effect in effects() {
        let own = all.iter().find(|l| l.effect == effect);
        let of = |value: &dyn Fn(&Likelihood) -> f64| own.map_or(0.0, value);
        let mut add = |name: &str, value: f64| out.push((format!("{effect}.fit_{name}"), value));
        add("gain", of(&|l| l.fitted));
        add("ahead", of(&|l| l.fitted) - most);
        add("same_noise", of(&|l| l.same_noise));
        add("held_out", of(&|l| l.held_out.clamp(-5.0, 5.0)));
        add("closed", of(&|l| l.closed[0].clamp(-5.0, 5.0)));
        add("closed_held_out", of(&|l| l.closed[1].clamp(-5.0, 5.0)));
        add("over_price", of(&|l| signed(l.over_price)));
        let rank = own.map_or(all.len(), |l| all.iter().filter(|o| o.fitted > l.fitted).count());
        add("rank", rank as f64);
    }
    let of = |k: usize| all.get(k).map_or(0.0, |l| l.fitted);
    out.push(("fit_first".to_owned(), of(0)));
    out.push(("fit_lead".to_owned(), of(0) - of(1)));
    out.push(("fit_over_price".to_owned(), all.first().map_or(0.0, |l| signed(l.over_price))));
    out.push(("fit_order".to_owned(), likelihoods.order));
    out.push(("fit_ahead_of_order".to_owned(), of(0) - likelihoods.order));
}

/// The candidates, and each law at its optimum among them.
fn with_refined(candidates: &Candidates, refined: &[Refined]) -> Candidates {
    let mut out = candidates.clone();
    for r in refined {
        out.columns.push(r.change.clone());
        let columns = vec![out.columns.len() - 1];
        out.all.push(Candidate { effect: r.term.law.effect(), columns, term: Some(r.term.clone()) });
    }
    out
}

/// Laws at their optimum that are taken out together.
const TOGETHER: usize = 2;

/// The error without the best candidates and the base's directions, by least squares on filtered signals.
fn beside_the_best(
    context: &Context<'_>,
    (jacobian, errors): (&[Signal], &Signal),
    refined: &[Refined],
    criterion: &Criterion,
) -> Signal {
    let mut order: Vec<&Refined> = refined.iter().collect();
    order.sort_by(|x, y| y.share.total_cmp(&x.share));
    order.dedup_by_key(|r| r.term.law.effect());
    let changes = order.iter().take(TOGETHER).map(|r| r.change.clone());
    let columns: Vec<Signal> = jacobian.iter().cloned().chain(changes).collect();
    let signals: Vec<Signal> = std::iter::once(errors.clone()).chain(columns.iter().cloned()).collect();
    let filtered = context.filtered(&signals, criterion);
    let grams = Grams::new(&filtered[1..], &filtered[..1], &context.blocks);
    remainder(errors, &columns, &grams.absorbed)
}

fn remainder(errors: &Signal, columns: &[Signal], coefficients: &DVector<f64>) -> Signal {
    let mut out = errors.clone();
    for (column, c) in columns.iter().zip(coefficients.iter()) {
        for (out, x) in out.iter_mut().zip(column) {
            out.iter_mut().zip(x).for_each(|(o, x)| *o -= c * x);
        }
    }
    out
}

fn flat(signal: &Signal) -> Vec<f64> {
    signal.iter().flatten().copied().collect()
}

fn rms(signal: &Signal) -> f64 {
    let count: usize = signal.iter().map(Vec::len).sum();
    (signal.iter().flatten().map(|x| x * x).sum::<f64>() / count.max(1) as f64).sqrt().max(f64::MIN_POSITIVE)
}

/// Statistics of the rig as a whole.
fn whole(
    context: &Context<'_>,
    (errors, error, rest): (&Signal, &Signal, &Signal),
    [white, still]: [&Criterion; 2],
    out: &mut Columns,
) {
    let mut add = |name: &str, value: f64| out.push((name.to_owned(), value));
    let ln = libm::log;
    let base = context.base;
    for (name, criterion) in [("w", white), ("v", still)] {
        let d = &criterion.filter;
        add(&format!("{name}_order"), d.len() as f64);
        (0..3).for_each(|k| add(&format!("{name}_d{}", k + 1), d.get(k).copied().unwrap_or(0.0)));
        add(&format!("{name}_sum"), ln((1.0 + d.iter().sum::<f64>()).abs() + 1e-4));
    }
    // Noise of the equation is white behind A, noise of the output without it.
    let behind = |d: &[f64], signal: &Signal| {
        let filtered: Signal = signal.iter().map(|e| whitened(e.clone(), d)).collect();
        rms(&filtered)
    };
    for (name, signal, criterion) in [("error", error, white), ("rest", rest, still)] {
        let least = behind(&criterion.filter, signal);
        add(&format!("{name}_as_output_noise"), ln(rms(signal) / least));
        add(&format!("{name}_as_equation_noise"), ln(behind(base.linear.a(), signal) / least));
    }
    add("rest_over_error", ln(rms(rest) / rms(error)));
    add("absorbed", ln(rms(errors) / rms(error)));
    let of_use = |is_fitted: bool| {
        let parts = context.blocks.iter().filter(|b| b.is_fitted == is_fitted);
        let (sum, count) = parts.fold((0.0, 0.0), |(sum, count), b| {
            let part = &errors[b.record][b.from..b.to];
            (sum + part.iter().map(|x| x * x).sum::<f64>(), count + part.len() as f64)
        });
        (sum / f64::max(count, 1.0)).sqrt()
    };
    add("held_out_over_fitted", ln((of_use(false) + 1e-12) / (of_use(true) + 1e-12)));
    add("order", base.linear.a().len() as f64);
    add("settling", ln(context.scale.settling));
    add("pairs", base.linear.modes().iter().filter(|m| m.time_constant().is_none()).count() as f64);
    let motions: Vec<_> =
        context.stretches.iter().map(|s| switchback_model::system::Motion::of(&s.v, base.rule)).collect();
    let count: f64 = context.stretches.iter().map(|s| s.v.len() as f64).sum();
    let share = |is: &dyn Fn(&switchback_model::system::Motion, usize) -> bool| {
        let all = motions.iter().map(|m| (0..m.since.len()).filter(|t| is(m, *t)).count() as f64);
        all.sum::<f64>() / count
    };
    add("reversals", ln(share(&|m, t| t > 0 && m.since[t] == 0.0) + 1e-4));
    add("at_rest", share(&|m, t| m.rest[t] > 0.0));
    let speeds: Vec<f64> = motions.iter().flat_map(|m| m.speed.iter().copied()).collect();
    add(
        "speeds",
        ln((quantile(&speeds, 0.9) + 1e-12) / (quantile(&speeds, 0.1) + 1e-3 * context.scale.speed)),
    );
    add("roughness", ln(context.scale.speed / context.scale.travel));
    add("bends", ln(context.scale.acceleration / context.scale.speed + 1e-6));
    let (low, high) = base.borders.range();
    let places: Vec<(f64, f64)> =
        (0..33).map(|k| base.borders.at(low + (high - low) * f64::from(k) / 32.0)).collect();
    let width = places.iter().map(|(_, half)| half.abs()).sum::<f64>() / 33.0;
    add("loop", ln(width / context.scale.output.max(f64::MIN_POSITIVE) + 1e-3));
    add("several_records", f64::from(u8::from(context.stretches.len() > 1)));
}
