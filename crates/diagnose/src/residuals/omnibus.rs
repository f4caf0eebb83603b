//! Is anything left? Tests of the residual against causes in general, not against any candidate.

use crate::effect::Stage;
use crate::likelihood::design::Design;
use crate::likelihood::engine::Fit;
use crate::likelihood::gains::Tested;
use crate::likelihood::jacobian::normal_equations;
use crate::likelihood::weights::mixture;
use crate::model::augmented::convolve;
use crate::records::dataset::Dataset;
use crate::residuals::LAGS;
use crate::residuals::noise_size::{Homoscedasticity, unweighted};
use crate::residuals::quantisation_grid::{is_material, quantisation_step, worth};
use switchback_model::spectrum::portmanteau;

/// What the tests found.
#[derive(Debug, Clone)]
pub(crate) struct Omnibus {
    /// Score-test gain in deviance of each group of columns, with its degrees of freedom.
    pub(crate) groups: Vec<(Group, f64, usize)>,
    /// Gain of all columns together, and their number.
    pub(crate) regressors: (f64, usize),
    /// Ljung–Box statistic over [`LAGS`] lags.
    pub(crate) ljung_box: f64,
    /// Dependence of the scaled innovations' size on circumstances, and its degrees of freedom.
    pub(crate) scatter: (f64, usize),
    /// McLeod–Li statistic: autocorrelation of the innovations' size over [`LAGS`] lags.
    pub(crate) bursts: f64,
    /// Deviance that a mixture of a narrow and a wide normal distribution gains over one.
    pub(crate) tails: f64,
    /// What a quantisation grid of the outputs is worth where the model has none.
    pub(crate) rounding: f64,
    /// Lack of fit of the period means, as gain in deviance, and its degrees of freedom.
    pub(crate) period: (f64, usize),
    /// Share of the innovations' variance that no rounding of the sensor makes: rounding is no noise, it repeats with the
    /// input and shows wherever the tests look.
    pub(crate) unrounded: f64,
}

/// What a group of columns stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Group {
    Lags,
    Motion,
    Reversal,
    Time,
    Level,
    Scatter,
}

impl Group {
    /// The stage that a gain of this group points at.
    pub(crate) fn stage(self) -> Stage {
        match self {
            Self::Lags => Stage::Dynamics,
            Self::Motion | Self::Reversal => Stage::Operator,
            Self::Time => Stage::Sensor,
            Self::Level => Stage::Sensor,
            Self::Scatter => Stage::Disturbance,
        }
    }
}

/// Share of the innovations' variance from which rounding explains whatever the tests find.
const SUSPECT: f64 = 0.4;

/// Deviance a sample that heavy tails may gain without a cause.
const TAILS: f64 = 0.02;

/// The same where the sensor rounds coarsely.
const ROUNDED_TAILS: f64 = 0.3;

impl Omnibus {
    /// Deviance that causes in general would still gain, beyond what chance gives them.
    pub(crate) fn excess(&self) -> f64 {
        let over = |gain: f64, dof: usize| {
            let dof = dof as f64;
            if gain > dof + 4.0 * (2.0 * dof).sqrt() + 8.0 { gain - dof } else { 0.0 }
        };
        let regressors = over(self.regressors.0, self.regressors.1);
        let period = over(self.period.0, self.period.1);
        let colour = over(self.ljung_box, LAGS);
        let size = over(self.scatter.0, self.scatter.1).max(over(self.bursts, LAGS));
        self.unrounded * (regressors.max(period) + colour + size)
    }

    /// Deviance that counts against the model as the whole candidate: what is left in general, tails too heavy to be chance and
    /// a quantisation grid that nothing in it makes.
    pub(crate) fn against(&self, samples: usize) -> f64 {
        let tails = if self.tails > TAILS * samples as f64 { self.tails } else { 0.0 };
        self.excess() + tails + self.rounding
    }

    /// The stage that the residual points at.
    pub(crate) fn stage(&self) -> Option<Stage> {
        if self.rounding > 0.0 {
            return Some(Stage::Sensor);
        }
        let best = self
            .groups
            .iter()
            .map(|&(g, gain, dof)| (g, gain - dof as f64))
            .max_by(|x, y| x.1.total_cmp(&y.1))?;
        if self.ljung_box > best.1 && self.regressors.0 < 0.3 * self.ljung_box {
            return Some(Stage::Disturbance);
        }
        Some(best.0.stage())
    }
}

/// Runs the tests on the fit records.
pub(crate) fn omnibus(dataset: &Dataset, fit: &Fit) -> Option<Omnibus> {
    let design = Design::like(Some(fit.near()), dataset, &fit.grid, &fit.augmented);
    let whitener = design.whitener(&fit.augmented.noise, &fit.linear.a);
    let innovations = design.innovations(&fit.linear, &whitener);
    let weights = crate::likelihood::weights::weigh(&design, &fit.augmented.noise, &fit.linear, &innovations);
    let share = design.criterion.share();
    let b = convolve(&fit.linear.b, &design.taps);
    let n = fit.linear.a.len();
    let mut names: Vec<Group> = Vec::new();
    let mut extra: Vec<Vec<Vec<f64>>> = Vec::new();
    for (number, (scaled, effect_term)) in dataset.fit().zip(&design.scaled_records).enumerate() {
        let u = design.input(effect_term, &fit.linear.f);
        let raw = effect_term.rows.times(&fit.linear.f);
        let moves = &scaled.moves;
        // A simulator is asked about what it simulates, not about the measured past.
        let mut seen = effect_term.x.to_vec();
        if design.criterion.simulates() {
            seen[effect_term.from..].iter_mut().zip(&innovations[number]).for_each(|(x, w)| *x -= w);
        }
        let mut columns: Vec<(Group, Vec<f64>)> = Vec::new();
        // Columns beside u: they pass B.
        let through = |g: Vec<f64>| whitener.column(&g, &b, effect_term.from);
        // Columns of the equation.
        let direct = |g: Vec<f64>| whitener.column(&g, &[-1.0], effect_term.from);
        let at = |x: &[f64], t: usize, lag: usize| x[t.saturating_sub(lag)];
        let range = 0..u.len();
        for lag in [n + 1, n + 2] {
            columns.push((Group::Lags, direct(range.clone().map(|t| at(&seen, t, lag)).collect())));
            columns
                .push((Group::Lags, direct(range.clone().map(|t| at(&u, t, b.len() + lag - n)).collect())));
        }
        // B of each branch on its own.
        for lag in 1..=b.len().min(2) {
            columns.push((
                Group::Motion,
                direct(
                    range.clone().map(|t| at(&raw, t, lag) * moves[t.saturating_sub(lag)].branch).collect(),
                ),
            ));
        }
        let typical = 0.05;
        columns.push((Group::Motion, through(moves.iter().map(|m| m.step / typical).collect())));
        columns.push((
            Group::Motion,
            through(moves.iter().map(|m| m.branch * (m.step.abs() / typical).sqrt()).collect()),
        ));
        columns.push((Group::Motion, through(moves.iter().map(|m| m.step.abs() / typical).collect())));
        columns.push((
            Group::Motion,
            through(moves.iter().map(|m| m.branch * (m.rest as f64).ln_1p()).collect()),
        ));
        for length in [0.02_f64, 0.08, 0.25] {
            let fade = |m: &crate::records::motion::Motion| {
                if m.branch == 0.0 { 0.0 } else { m.branch * (-m.travel / length).exp() }
            };
            columns.push((Group::Reversal, through(moves.iter().map(fade).collect())));
        }
        let clock = |t: usize| (scaled.clock + t) as f64 / dataset.total as f64 - 0.5;
        let of_record = |t: usize| t as f64 / u.len() as f64 - 0.5;
        columns.push((Group::Time, direct(range.clone().map(clock).collect())));
        columns.push((Group::Time, direct(range.clone().map(of_record).collect())));
        columns.push((Group::Time, through(range.clone().map(|t| clock(t) * raw[t]).collect())));
        columns.push((Group::Time, through(range.clone().map(|t| clock(t) * moves[t].branch).collect())));
        columns.push((Group::Time, through(range.clone().map(|t| of_record(t) * raw[t]).collect())));
        for power in [2, 3] {
            columns
                .push((Group::Level, direct(range.clone().map(|t| at(&seen, t, 1).powi(power)).collect())));
        }
        if number == 0 {
            names = columns.iter().map(|c| c.0).collect();
            extra = vec![Vec::new(); columns.len()];
        }
        for (j, (_, column)) in columns.into_iter().enumerate() {
            extra[j].push(column);
        }
    }
    let weighted = weights.applied(&innovations);
    // Each column is given up for the weighted one.
    let extra: Vec<Vec<f64>> = extra.into_iter().map(|column| weights.applied(&column)).collect();
    let sums = normal_equations(&design, &fit.linear, &whitener, &weights, (&weighted, &extra));
    let tested = Tested::of(&sums, fit.linear.len(), fit.variance / share)?;
    let mut groups: Vec<(Group, f64, usize)> = Vec::new();
    for group in [Group::Lags, Group::Motion, Group::Reversal, Group::Time, Group::Level] {
        let members: Vec<usize> = (0..names.len()).filter(|&j| names[j] == group).collect();
        groups.push((group, tested.gain(&members), members.len()));
    }
    let scaled = weights.by_scaled(&innovations);
    // Samples without weight say nothing.
    let count = scaled.iter().flatten().filter(|w| **w != 0.0).count().max(1);
    // Errors of a simulation are coloured whatever the noise is.
    let white = f64::from(u8::from(!design.criterion.simulates()));
    let ljung_box = white * portmanteau(&scaled, LAGS, count as f64);
    let second = scaled.iter().flatten().map(|w| w * w).sum::<f64>() / count as f64 / share;
    let size = match fit.augmented.noise.mixture {
        None => Homoscedasticity::of_all(dataset, &scaled),
        Some(_) => Homoscedasticity::of_rare(dataset, &unweighted(&scaled, &innovations)),
    };
    // Errors of a simulation are large where the model is wrong, which says nothing about noise.
    let scatter = (white * size.scatter.0, size.scatter.1);
    groups.push((Group::Scatter, scatter.0, scatter.1));
    let a_energy = 1.0 + fit.linear.a.iter().map(|a| a * a).sum::<f64>();
    let rounding =
        fit.augmented.noise.quantisation.map_or(0.0, |step| step * step / 12.0 * a_energy / fit.power);
    let unrounded = (1.0 - rounding / SUSPECT).clamp(0.0, 1.0);
    Some(Omnibus {
        groups,
        regressors: (tested.gain(&(0..names.len()).collect::<Vec<_>>()), names.len()),
        ljung_box,
        scatter,
        bursts: white * size.bursts,
        tails: beyond_rounding(tails(fit, &scaled) * white, unrounded, count),
        rounding: unexplained_rounding(dataset, fit),
        period: period_lack(dataset, &scaled, second),
        unrounded,
    })
}

fn unexplained_rounding(dataset: &Dataset, fit: &Fit) -> f64 {
    let found = || quantisation_step(dataset).is_some_and(|step| is_material(step, fit));
    if fit.augmented.noise.quantisation.is_none() && found() { worth(dataset.fit_samples()) } else { 0.0 }
}

/// Heavy tails that rounding, which has no normal distribution, does not make.
fn beyond_rounding(tails: f64, unrounded: f64, count: usize) -> f64 {
    if tails > ROUNDED_TAILS * count as f64 { tails } else { tails * unrounded }
}

/// What heavy tails would gain: the heavier, the more a few large errors rule the variance.
fn tails(fit: &Fit, innovations: &[Vec<f64>]) -> f64 {
    if fit.augmented.noise.mixture.is_some() {
        return 0.0;
    }
    let counted: Vec<f64> = innovations.iter().flatten().copied().filter(|w| *w != 0.0).collect();
    let n = counted.len().max(1) as f64;
    let normal = n * (counted.iter().map(|w| w * w).sum::<f64>() / n).ln();
    let mixed =
        mixture((0.01, 8.0), fit.augmented.noise.least_variance(), &[counted]).deviance.unwrap_or(normal);
    (normal - mixed).max(0.0)
}

/// Chi-square of the period means of the innovations.
fn period_lack(dataset: &Dataset, innovations: &[Vec<f64>], variance: f64) -> (f64, usize) {
    let (mut sum, mut dof) = (0.0, 0);
    for (scaled, w) in dataset.fit().zip(innovations) {
        let Some(period) = scaled.period else { continue };
        let start = period.saturating_sub(scaled.from);
        if w.len() < start + 8 * period {
            continue;
        }
        for phase in 0..period {
            let repeats = w[start + phase..].iter().copied().step_by(period);
            let values: Vec<f64> = repeats.filter(|w| *w != 0.0).collect();
            if values.len() < 4 {
                continue;
            }
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            sum += mean * mean * n / variance;
            dof += 1;
        }
    }
    (sum, dof)
}
