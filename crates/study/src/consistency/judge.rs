//! What the curves over N amount to: slopes, plateaus and a verdict, with jackknifed errors.

use super::cell::{CellSpec, CellTheory};
use super::sections::SECTIONS;
use super::views::{CellViews, Figures, Jackknifed, View, mean, quantile};
use crate::results::{Group, Summary, Verdict};
use rayon::prelude::*;
use switchback_identify::statistics::weighted_line;

/// A bias counts as resolved at an N where it exceeds this many of its Monte-Carlo errors.
const RESOLVED: f64 = 3.0;
/// Chance that a bias of nothing is taken for one that stays, over all parameters of a group.
const FALSE_PLATEAU: f64 = 1e-3;
/// A consistent method's plateau is shown to be below this share of the standard deviation at the largest N: it could add
/// less than a tenth to the mean squared error there.
const IMMATERIAL: f64 = 0.3;
/// A standard deviation that falls more slowly than this power of N does not fall as theory says.
const SLOWEST_DECAY: f64 = -0.35;

/// One entry a series and group of parameters; slopes are fitted over the samples from `slope_from` on.
pub(super) fn summaries(
    specs: &[CellSpec],
    theories: &[CellTheory],
    views: &[CellViews],
    slope_from: usize,
) -> Vec<Summary> {
    let mut curves: Vec<Curve<'_>> = Vec::new();
    for ((spec, theory), views) in specs.iter().zip(theories).zip(views) {
        let point = Point { spec, theory, samples: spec.samples as f64, views };
        match curves.iter_mut().find(|c| c.spec.series == spec.series) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { spec, points: vec![point], slope_from }),
        }
    }
    curves.par_iter().flat_map_iter(Curve::summaries).collect()
}

/// All cells of a series, by increasing N.
struct Curve<'a> {
    /// The first of them, for what all have in common.
    spec: &'a CellSpec,
    points: Vec<Point<'a>>,
    /// Least N of a fitted slope: below, terms of higher order may still show.
    slope_from: usize,
}

/// One cell.
struct Point<'a> {
    spec: &'a CellSpec,
    theory: &'a CellTheory,
    samples: f64,
    views: &'a CellViews,
}

impl Curve<'_> {
    fn summaries(&self) -> Vec<Summary> {
        Group::ALL
            .into_iter()
            .map(|group| (group, self.parameters(group)))
            .filter(|(_, parameters)| !parameters.is_empty())
            .map(|(group, parameters)| self.summary(group, &parameters))
            .collect()
    }

    fn parameters(&self, group: Group) -> Vec<usize> {
        let names = self.spec.parameters.iter().enumerate();
        names.filter(|(_, p)| p.group == group).map(|(k, _)| k).collect()
    }

    fn summary(&self, group: Group, parameters: &[usize]) -> Summary {
        let usual = quantile(0.05);
        let sd_slope = Jackknifed::of(|view| self.sd_slope(view, parameters));
        let resolved = self.resolved(parameters);
        let bias_slope = bias_slope(&resolved, parameters);
        let plateau = self.plateau(parameters);
        let (verdict, reason) = self.verdict(sd_slope, plateau.as_ref());
        Summary {
            series: self.spec.series.clone(),
            group,
            sd_slope: sd_slope.and_then(|s| s.interval(usual)),
            sd_slope_theory: self.sd_slope_theory(parameters),
            bias_slope_theory: bias_slope_theory(&resolved, parameters),
            bias_slope: bias_slope.and_then(|s| s.interval(usual)),
            bias_slope_samples: resolved.iter().map(|p| p.spec.samples).collect(),
            plateau: plateau.and_then(|p| p.jackknifed.interval(usual)),
            coverage: Jackknifed::of(|view| self.last_mean(view, parameters, |p, _| Some(p.coverage)))
                .and_then(Jackknifed::measured),
            sd_over_theory: Jackknifed::of(|view| {
                let theory = self.last()?.theory.sd.as_ref()?;
                self.last_mean(view, parameters, |p, k| Some(p.variance / theory[k].powi(2))).map(f64::sqrt)
            })
            .and_then(Jackknifed::measured),
            variance_over_bound: Jackknifed::of(|view| {
                let bound = self.last()?.theory.bound.as_ref()?;
                self.last_mean(view, parameters, |p, k| Some(p.variance / bound[k].powi(2)))
            })
            .and_then(Jackknifed::measured),
            verdict,
            reason,
        }
    }

    fn last(&self) -> Option<&Point<'_>> {
        self.points.last()
    }

    /// Mean over the group of a measure at the largest N.
    fn last_mean(
        &self,
        view: View,
        parameters: &[usize],
        measure: impl Fn(&Figures, usize) -> Option<f64>,
    ) -> Option<f64> {
        let last = self.last()?;
        let values: Option<Vec<f64>> =
            parameters.iter().map(|&k| measure(&last.views.at(view, k)?, k)).collect();
        mean(&values?)
    }

    /// The points that slopes are fitted over.
    fn sloping(&self) -> impl Iterator<Item = &Point<'_>> {
        self.points.iter().filter(|point| point.spec.samples >= self.slope_from)
    }

    /// Slope of log root-mean-square sd against log N.
    fn sd_slope(&self, view: View, parameters: &[usize]) -> Option<f64> {
        let points: Option<Vec<_>> = self
            .sloping()
            .map(|point| {
                let variances: Option<Vec<f64>> =
                    parameters.iter().map(|&k| Some(point.views.at(view, k)?.variance)).collect();
                Some((point.samples.ln(), mean(&variances?)?.sqrt().ln(), 1.0))
            })
            .collect();
        weighted_line(&points?).map(|line| line.slope)
    }

    /// The same slope of the standard deviations that theory gives for the same N.
    fn sd_slope_theory(&self, parameters: &[usize]) -> Option<f64> {
        let points: Option<Vec<_>> = self
            .sloping()
            .map(|point| {
                let sd = root_mean_square(point.theory.sd.as_ref()?, parameters);
                Some((point.samples.ln(), sd.ln(), 1.0))
            })
            .collect();
        weighted_line(&points?).map(|line| line.slope)
    }

    /// Those of them whose bias is resolved.
    fn resolved(&self, parameters: &[usize]) -> Vec<&Point<'_>> {
        let size = |point: &Point<'_>| point.size_of_bias(None, parameters);
        self.sloping()
            .filter(|point| size(point).is_some_and(|(size, error)| size > RESOLVED * error))
            .collect()
    }

    /// What stays of the bias, fitted as `p + c/N` with each point weighted by its Monte-Carlo error: the parameter of the group whose `p` is
    /// the most errors away from zero.
    fn plateau(&self, parameters: &[usize]) -> Option<Plateau> {
        let of = |k: usize| {
            let jackknifed = Jackknifed::of(|view| {
                let points: Option<Vec<_>> = self
                    .points
                    .iter()
                    .map(|point| {
                        let (bias, error) = point.bias(view, k)?;
                        Some((1.0 / point.samples, bias, 1.0 / (error * error)))
                    })
                    .collect();
                weighted_line(&points?).map(|line| line.intercept)
            })?;
            let sd = self.last()?.views.at(None, k)?.variance.sqrt();
            Some(Plateau { parameter: k, jackknifed, sd, tested: 1 })
        };
        let found = parameters.iter().filter_map(|&k| of(k)).filter(|p| p.jackknifed.se > 0.0);
        let worst = found.max_by(|p, q| p.distance().total_cmp(&q.distance()))?;
        Some(Plateau { tested: parameters.len(), ..worst })
    }

    fn verdict(&self, sd_slope: Option<Jackknifed>, plateau: Option<&Plateau>) -> (Verdict, String) {
        let (Some(slope), Some(plateau)) = (sd_slope, plateau) else {
            let needs = format!("needs two numbers of samples and {SECTIONS} replicates or more");
            return (Verdict::Undecided, needs);
        };
        let name = &self.spec.parameters[plateau.parameter].name;
        let stays = plateau.jackknifed.value / plateau.sd;
        let at_most = (plateau.jackknifed.value.abs() + quantile(0.05) * plateau.jackknifed.se) / plateau.sd;
        let significant = plateau.distance() > quantile(FALSE_PLATEAU / plateau.tested as f64);
        let falls = slope.value + quantile(0.05) * slope.se < SLOWEST_DECAY;
        if at_most < IMMATERIAL && falls {
            let reason =
                format!("sd and bias fall; {at_most:.2} sd of bias at the most stay at the largest N");
            (Verdict::Consistent, reason)
        } else if significant && stays.abs() >= IMMATERIAL / 2.0 {
            let value = plateau.jackknifed.value;
            let reason =
                format!("the bias of {name} stays at {value:.3e}, {:.1} sd at the largest N", stays.abs());
            (Verdict::Inconsistent, reason)
        } else if !falls {
            (Verdict::Undecided, format!("the sd falls as N^{:.2} only", slope.value))
        } else {
            let reason =
                format!("up to {at_most:.2} sd of bias may stay in {name}; run more replicates or larger N");
            (Verdict::Undecided, reason)
        }
    }
}

/// The bias that stays in one parameter.
#[derive(Debug, Clone, Copy)]
struct Plateau {
    parameter: usize,
    jackknifed: Jackknifed,
    /// The parameter's standard deviation at the largest N.
    sd: f64,
    /// Parameters it was picked from.
    tested: usize,
}

impl Plateau {
    /// In standard errors.
    fn distance(&self) -> f64 {
        (self.jackknifed.value / self.jackknifed.se).abs()
    }
}

impl Point<'_> {
    /// Bias and its error: controlled where there is a control variate.
    fn bias(&self, view: View, k: usize) -> Option<(f64, f64)> {
        let bias = self.views.at(view, k)?.best_bias();
        (bias.mcse > 0.0).then_some((bias.value, bias.mcse))
    }

    /// Root-mean-square bias of a group and its error.
    fn size_of_bias(&self, view: View, parameters: &[usize]) -> Option<(f64, f64)> {
        let biases: Option<Vec<_>> = parameters.iter().map(|&k| self.bias(view, k)).collect();
        let biases = biases?;
        let squares = mean(&biases.iter().map(|b| b.0 * b.0).collect::<Vec<_>>())?;
        let errors = mean(&biases.iter().map(|b| b.1 * b.1).collect::<Vec<_>>())?;
        Some((squares.sqrt(), errors.sqrt()))
    }
}

/// Root mean square of known values over the parameters of a group.
fn root_mean_square(values: &[f64], parameters: &[usize]) -> f64 {
    let squares: Vec<f64> = parameters.iter().map(|&k| values[k] * values[k]).collect();
    mean(&squares).unwrap_or_default().sqrt()
}

/// The slope that [`bias_slope`] would find of the biases that theory gives for the same N, points weighted alike.
fn bias_slope_theory(resolved: &[&Point<'_>], parameters: &[usize]) -> Option<f64> {
    let points: Option<Vec<_>> = resolved
        .iter()
        .map(|point| {
            let (size, error) = point.size_of_bias(None, parameters)?;
            let bias = root_mean_square(point.theory.bias.as_ref()?, parameters);
            Some((point.samples.ln(), bias.ln(), (size / error).powi(2)))
        })
        .collect();
    weighted_line(&points?).map(|line| line.slope)
}

/// Slope of log root-mean-square bias against log N over points where it is resolved; needs two of them.
fn bias_slope(resolved: &[&Point<'_>], parameters: &[usize]) -> Option<Jackknifed> {
    Jackknifed::of(|view| {
        let points: Option<Vec<_>> = resolved
            .iter()
            .map(|point| {
                let (size, error) = point.size_of_bias(view, parameters)?;
                Some((point.samples.ln(), size.ln(), (size / error).powi(2)))
            })
            .collect();
        weighted_line(&points?).map(|line| line.slope)
    })
}
