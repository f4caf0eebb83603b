//! Maximum likelihood of a nominal model together with an augmented model of effects.
//!
//! Gauss–Newton on everything at once; the effects' nonlinear parameters get numerical derivatives. With concentrated noise
//! variance the deviance (minus twice the log-likelihood, constants dropped) is
//!
//! ```text
//! dev = N ln(Σ s²w²/N) − 2 Σ ln s − 2 Σ ln dx/dy
//! ```
//!
//! Samples without a say count as much as the others do in the mean; but those whose error is known, and only what predicts it is
//! not, have the variance of their own errors: a filter gains nothing where it cannot be applied. The steps take no account of these few; whether
//! one is taken does.

use std::cell::OnceCell;
use std::sync::Arc;

use crate::least_squares::normal::Normal;
use crate::likelihood::design::{Design, Linear, Whitener};
use crate::likelihood::jacobian::normal_equations;
use crate::likelihood::weights::{Weights, weigh};
use crate::model::augmented::{AugmentedModel, EquationColumn};
use crate::model::borders::Grid;
use crate::model::stability::settles;
use crate::records::dataset::Dataset;
use switchback_model::sums::energy;

/// One nonlinear parameter of an effect: its value and how it may move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NonlinearParameter {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Step of the numerical derivative.
    pub(crate) step: f64,
}

impl NonlinearParameter {
    /// The step of the numerical derivative, downwards where the upper bound forbids a step upwards.
    pub(crate) fn inward_step(&self) -> f64 {
        if self.value + self.step > self.high { -self.step } else { self.step }
    }
}

/// From nonlinear parameters to an augmented model.
pub(crate) type Build<'a> = dyn Fn(&[f64]) -> AugmentedModel + 'a;

/// A fitted model.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub(crate) augmented: AugmentedModel,
    pub(crate) grid: Grid,
    pub(crate) linear: Linear,
    pub(crate) nonlinear: Vec<NonlinearParameter>,
    /// Standard errors of the nonlinear parameters.
    pub(crate) nonlinear_se: Vec<f64>,
    pub(crate) deviance: f64,
    /// Variance of the innovations, where they are weighted that of the weighted ones.
    pub(crate) variance: f64,
    /// Mean square of the counted innovations without weights.
    pub(crate) power: f64,
    pub(crate) samples: usize,
    /// Effective number of parameters.
    pub(crate) parameters: f64,
    pub(crate) records: FitRecords,
}

/// The records that a model is fitted to.
#[derive(Debug, Clone)]
pub(crate) struct FitRecords {
    dataset: Dataset,
    /// Their design, or one that has much in common with it.
    near: Arc<Design>,
}

impl FitRecords {
    /// Those of a dataset, and their design.
    pub(crate) fn new(dataset: &Dataset, design: Design) -> Self {
        Self { dataset: dataset.clone(), near: Arc::new(design) }
    }
}

/// Half-width of a 90 % interval in standard errors of a normal estimate.
const Z90: f64 = 1.644_853_626_951_472_6;

impl Fit {
    /// The fit records under it; built anew where they were [set aside](Self::set_aside).
    pub(crate) fn design(&self) -> Arc<Design> {
        let FitRecords { dataset, near } = &self.records;
        match near.serves(&self.grid, &self.augmented) {
            true => Arc::clone(near),
            false => Design::like(Some(near), dataset, &self.grid, &self.augmented).into(),
        }
    }

    /// Samples of the longest record fitted.
    pub(crate) fn longest_record(&self) -> usize {
        self.records.dataset.fit().map(|scaled| scaled.v.len()).max().unwrap_or(0)
    }

    /// A design that has much in common with that of the fit, for what is built from it.
    pub(crate) fn near(&self) -> &Arc<Design> {
        &self.records.near
    }

    /// The same fit for keeping: its design, which holds hundreds of bytes a sample, is given up for one that is held anyway.
    #[must_use]
    pub(crate) fn set_aside(self, fixed: &Arc<Design>) -> Self {
        let records = FitRecords { near: Arc::clone(fixed), ..self.records };
        Self { records, ..self }
    }

    /// 90 % intervals of the nonlinear parameters; NaN where the likelihood gives no standard error.
    pub(crate) fn intervals(&self) -> Vec<[f64; 2]> {
        let interval = |(o, se): (&NonlinearParameter, &f64)| [o.value - Z90 * se, o.value + Z90 * se];
        self.nonlinear.iter().zip(&self.nonlinear_se).map(interval).collect()
    }
}

/// Where the fit is done.
#[derive(Clone, Copy)]
pub(crate) struct FitContext<'a> {
    pub(crate) dataset: &'a Dataset,
    pub(crate) grid: &'a Grid,
    /// A design of the same records: what the fit has in common with it is not built again.
    pub(crate) known: Option<&'a Design>,
}

/// Weight of the prior that ties border values nobody visits to their neighbours, in units of one sample's information.
const SMOOTHNESS: f64 = 1e-3;

/// Gain in deviance, of independent samples, below which a round is the last one; a step that predicts no more and fails is
/// not tried again.
const SETTLED: f64 = 0.2;
/// Shares of a step that are tried where the whole of it leads uphill.
const SHORTENED: [f64; 2] = [0.35, 0.12];
const SHORTEST: f64 = 0.04;
/// Relative damping after a failure: at least the first, by a factor more, never beyond the last. Weaker damping turns no step
/// of a determined problem that failed into one that succeeds.
const STRONG: f64 = 1e-3;
const STRONGER: f64 = 1e3;
const STRONGEST: f64 = 0.5;

/// The state of a fit at given parameters.
pub(super) struct State {
    augmented: AugmentedModel,
    pub(super) whitener: Whitener,
    pub(super) innovations: Vec<Vec<f64>>,
    pub(super) weights: Weights,
    deviance: f64,
    pub(super) variance: f64,
}

/// Evaluates the model; `None` where it is not finite.
pub(super) fn evaluate(design: &Design, augmented: AugmentedModel, p: &Linear) -> Option<State> {
    if design.criterion.simulates() && !settles(&p.a) {
        return None;
    }
    let whitener = design.whitener(&augmented.noise, &p.a);
    let errors = design.all_errors(p);
    let innovation_share = design.innovation_share(&errors);
    let innovations = design.whitened(errors, &whitener);
    let weights = weigh(design, &augmented.noise, p, &innovations);
    let n = design.samples() as f64;
    let sum: f64 = weights.by_scaled(&innovations).iter().map(|w| energy(w)).sum();
    let variance = sum / (n - weights.left_out as f64).max(1.0);
    let forecast = match weights.deviance {
        Some(direct) => direct,
        None => n * variance.ln() - 2.0 * weights.log_scale,
    };
    let deviance = innovation_share.among(n, forecast) - 2.0 * design.log_slope();
    let deviance = deviance * design.criterion.share();
    deviance.is_finite().then_some(State { augmented, whitener, innovations, weights, deviance, variance })
}

/// Fits everything from a start; at most `rounds` Gauss–Newton steps.
pub(crate) fn fit(
    context: FitContext<'_>,
    build: &Build<'_>,
    nonlinear: &[NonlinearParameter],
    start: &Linear,
    rounds: usize,
) -> Option<Fit> {
    let design_of = |augmented: &AugmentedModel, known: Option<&Design>| {
        Design::like(known, context.dataset, context.grid, augmented)
    };
    let mut nonlinear = nonlinear.to_vec();
    let mut p = start.clone().gauged();
    let values = |nonlinear: &[NonlinearParameter]| nonlinear.iter().map(|o| o.value).collect::<Vec<f64>>();
    let augmented = build(&values(&nonlinear));
    let mut design = design_of(&augmented, context.known);
    let mut state = evaluate(&design, augmented, &p)?;
    let mut nonlinear_se = vec![f64::NAN; nonlinear.len()];
    let mut damping = 1e-9;
    // Border columns, filters' taps and all else that an effect adds lie behind these.
    let order = p.a.len();
    let fixed = [0..2 * order, order + p.b.len()..order + p.b.len() + context.grid.len()];
    for _ in 0..rounds {
        let extra = derivatives(&context, build, &nonlinear, &design, &state, &p);
        let w = state.weights.applied(&state.innovations);
        let mut normal = normal_equations(&design, &p, &state.whitener, &state.weights, (&w, &extra));
        priors(&mut normal, context.grid, &p, &state.augmented);
        if context.dataset.holds_nominal() {
            normal = normal.restricted(|i| !fixed.iter().any(|fixed| fixed.contains(&i)));
        }
        let mut better = None;
        let mut step_norm = 0.0;
        for _ in 0..4 {
            let Some(factor) = normal.factor(damping) else {
                damping = (damping * 100.0).max(1e-8);
                continue;
            };
            let step = factor.solve(&normal.gradient);
            for (j, se) in nonlinear_se.iter_mut().enumerate() {
                *se = (factor.inverse_diagonal(p.len() + j).max(0.0) * state.variance
                    / design.criterion.share())
                .sqrt();
            }
            if step.iter().any(|x| !x.is_finite()) {
                damping = (damping * 100.0).max(1e-8);
                continue;
            }
            let tried = |step: &[f64], share: f64| {
                let moved = p.moved(step, -share);
                let mut next = nonlinear.clone();
                for (o, s) in next.iter_mut().zip(&step[p.len()..]) {
                    o.value = (o.value - share * s).clamp(o.low, o.high);
                }
                let mut augmented = build(&values(&next));
                // A mixture goes on from the one before: expectation–maximisation ends after fewer rounds.
                augmented.noise.mixture = state.weights.mixture.or(augmented.noise.mixture);
                let redesign =
                    (!augmented.same_design(&state.augmented)).then(|| design_of(&augmented, Some(&design)));
                let s = evaluate(redesign.as_ref().unwrap_or(&design), augmented, &moved)?;
                (s.deviance < state.deviance).then_some((moved, next, redesign, s))
            };
            better = tried(&step, 1.0);
            if better.is_none() {
                let forecast: f64 = step.iter().zip(&normal.gradient).map(|(x, g)| x * g).sum();
                if forecast < SETTLED * state.variance {
                    break;
                }
                // Where b and f trade against each other the joint step overshoots; each block alone is exactly linear.
                let borders = p.a.len() + p.b.len()..p.a.len() + p.b.len() + p.f.len();
                let blocks = [
                    normal.restricted(|i| !borders.contains(&i)),
                    normal.restricted(|i| borders.contains(&i)),
                ];
                let alone = blocks
                    .iter()
                    .filter_map(|block| tried(&block.factor(damping)?.solve(&block.gradient), 1.0));
                // Where the shortest step leads uphill, so do the longer ones.
                let shortest = tried(&step, SHORTEST);
                let shares: &[f64] = if shortest.is_some() { &SHORTENED } else { &[] };
                better = alone
                    .chain(shares.iter().filter_map(|share| tried(&step, *share)))
                    .chain(shortest)
                    .min_by(|x, y| x.3.deviance.total_cmp(&y.3.deviance));
            }
            if let Some(b) = &better {
                step_norm = state.deviance - b.3.deviance;
            }
            if better.is_some() {
                damping = (damping * 0.1).max(1e-9);
                break;
            }
            damping = (damping * STRONGER).max(STRONG);
            if damping > STRONGEST {
                break;
            }
        }
        let Some((moved, next, redesign, s)) = better else { break };
        p = moved.gauged();
        nonlinear = next;
        if let Some(d) = redesign {
            design = d;
        }
        state = s;
        if step_norm < SETTLED * design.criterion.share() {
            break;
        }
    }
    // Coloured errors count for less than one sample each.
    let samples = (design.samples() as f64 * design.criterion.share()).ceil() as usize;
    let (mut sum, mut count) = (0.0, 0.0);
    for (number, w) in state.innovations.iter().enumerate() {
        for (k, w) in w.iter().enumerate() {
            if state.weights.counts(number, k) {
                sum += w * w;
                count += 1.0;
            }
        }
    }
    let power = sum / f64::max(count, 1.0);
    // One direction of (b, f) is fixed by the gauge.
    let known = if context.dataset.holds_nominal() { fixed.iter().map(|fixed| fixed.len()).sum() } else { 1 };
    let parameters = (p.len() - known + nonlinear.len()) as f64;
    let mut augmented = state.augmented;
    if let Some(mixture) = state.weights.mixture {
        augmented.noise.mixture = Some(mixture);
    }
    Some(Fit {
        augmented,
        grid: design.grid.clone(),
        linear: p,
        nonlinear,
        nonlinear_se,
        deviance: state.deviance,
        variance: state.variance,
        power,
        samples,
        parameters,
        records: FitRecords::new(context.dataset, design),
    })
}

/// Numerical derivatives of the weighted innovations with respect to the nonlinear parameters, one column each.
///
/// The log slope of the sensor enters as the factor `exp(−log_slope/N)` on all innovations, which makes the sum of
/// squares monotone in the deviance.
pub(super) fn derivatives(
    context: &FitContext<'_>,
    build: &Build<'_>,
    nonlinear: &[NonlinearParameter],
    design: &Design,
    state: &State,
    p: &Linear,
) -> Vec<Vec<f64>> {
    let n = design.samples() as f64;
    // Where only the law of the noise moves, the errors stay.
    let errors = OnceCell::new();
    (0..nonlinear.len())
        .map(|j| {
            let mut values: Vec<f64> = nonlinear.iter().map(|o| o.value).collect();
            let h = nonlinear[j].inward_step();
            values[j] += h;
            let augmented = build(&values);
            let (moved, factor) = if augmented.same_design(&state.augmented) {
                let errors = errors.get_or_init(|| design.all_errors(p)).clone();
                (design.whitened(errors, &design.whitener(&augmented.noise, &p.a)), 1.0)
            } else {
                let there = Design::like(Some(design), context.dataset, context.grid, &augmented);
                let moved = there.innovations(p, &there.whitener(&augmented.noise, &p.a));
                (moved, (-(there.log_slope() - design.log_slope()) / n).exp())
            };
            let slopes: Vec<Vec<f64>> = moved
                .iter()
                .zip(&state.innovations)
                .map(|(m, w)| m.iter().zip(w).map(|(m, w)| (m * factor - w) / h).collect())
                .collect();
            state.weights.applied(&slopes)
        })
        .collect()
}

/// The prior on border values: neighbours on a straight line, jumps free.
pub(crate) fn priors(normal: &mut Normal, grid: &Grid, p: &Linear, augmented: &AugmentedModel) {
    let present = p.flat();
    // The gauge: no step may trade the scale of b for that of f, which the data cannot see.
    let gauge: Vec<(usize, f64)> = p.b.iter().enumerate().map(|(j, b)| (p.a.len() + j, *b)).collect();
    let weight = gauge.iter().map(|&(i, _)| normal.entry(i, i)).sum::<f64>().max(1.0);
    normal.hold(&gauge, weight);
    let base = p.a.len() + p.b.len();
    let mut offset = base;
    for knots in &grid.knots {
        for i in 1..knots.len().saturating_sub(1) {
            let (l, r) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            if l > 0.0 && r > 0.0 {
                let terms =
                    [(offset + i - 1, r / (l + r)), (offset + i, -1.0), (offset + i + 1, l / (l + r))];
                normal.add_prior(&terms, SMOOTHNESS, &present);
            }
        }
        for i in 0..knots.len() - 1 {
            normal.add_prior(&[(offset + i, 1.0), (offset + i + 1, -1.0)], 1e-2 * SMOOTHNESS, &present);
        }
        offset += knots.len();
    }
    let columns = augmented.equation_columns.iter().enumerate();
    // A gain that does not change yet shows nothing of the output's zero.
    let idle = columns.filter(|(_, c)| **c == EquationColumn::Gain).map(|(j, _)| base + p.f.len() + j);
    for i in (0..augmented.border_columns.len()).map(|j| offset + j).chain(idle) {
        normal.add_prior(&[(i, 1.0)], 1e-6, &present);
    }
}
