//! What noise that the sensor adds to the input does to the estimate.

use super::cells::Cells;
use super::data::Data;
use super::equation_error::Moments;
use super::fit::{FitKind, Fitted, equation_error_fit};
use super::normalise::quantities;
use super::problem::{Parameters, Segment, Structure};
use super::runs::Runs;
use super::simulation_error::{Effort, free_run, whitened_cost};
use super::smoothing::smoothed;
use super::units::OutputUnits;
use super::warning::Warning;
use crate::{BorderPoint, Estimate};
use switchback_model::linear::is_stable;
use switchback_model::reversal::SensorNoise;
use switchback_model::reversal::{Branches, ReversalRule, Timing};
use switchback_noise::{StreamId, white_samples};

/// By how much noise of the size found on the input moves the estimate, worked out by simulation.
///
/// Least squares takes the input as known. Where its sensor is noisy, the measured `v = x + noise` puts samples on the wrong place of a border, and near a
/// reversal on the wrong border: coefficients and borders are biased, and no longer record mends it (errors in variables). The size of the bias follows
/// from the fitted model itself:
///
/// 1. The motion `x` is the measured input, smoothed by parabolas over windows of the length that the noise calls for.
/// 2. The model is fitted again to `x` and the measured output, with reversals where `x` turns, at samples or between them as fits better. Its free run
///    on `x` stands for the output.
/// 3. White noise of the standard deviation found is added to `x`, and the model is fitted once more, to this input and that output: the same
///    structure, knots, reversal rule and noise filter, with the branches read anew off the noisy input.
/// 4. The shift is the mean change from the second fit to the third. Each noise is taken with both signs, so that what is linear in it, and averages
///    out, cancels at once.
///
/// Reported is the largest shift alone, in standard errors of the coefficient or border point that it moves. On made records of steady sweeps with noise of 0.1 to 1 % of the
/// range it was 0.8 to 1.5 times the true one in the median where the machine turns between samples, and 0.4 to 1.0 times where it turns at samples, whose lag of half a sample on
/// average the noise hides (`crates/identify/tests/input_noise.rs` prints the table); single records scatter by a factor of two and more. Which parameter is moved, and in which direction, is not reported: where the
/// noise blurs turning points by more than a sample, the stand-in turns elsewhere than the machine did, and single shifts come out wrong.
///
/// The input does not say whether the machine follows its fast part, which is no noise then. The figure means nothing in that case.
///
/// The output is simulated without its own noise: that is independent of the input's and moves the mean by terms of higher order only. The
/// grid is not refined anew, and the choice of structure and rule not repeated. The noise drawn is the same for every record: the answer depends on the records
/// alone. The cost is that of two fits and sixteen from a start nearby, on one grid.
///
/// A bias of `β` standard errors leaves a 95 % interval a coverage of `Φ(z − β) − Φ(−z − β)` with `z = 1.96`, which is 90 % at `β = 0.652`. A
/// [`Warning::InputNoise`] is given where the shift exceeds this by three of its own errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputNoise {
    /// Standard deviation of the noise, input units; of the noisiest record where there are several.
    pub sd: f64,
    /// `sd` over the width of the working interval.
    pub share: f64,
    /// The largest shift, in standard errors of the coefficient or border point that it moves.
    pub largest_shift: f64,
    /// Standard error of that by the number of simulated records, in the same unit.
    pub largest_shift_se: f64,
}

/// Bias in standard errors that leaves a 95 % interval a coverage of 90 %.
const REPORTED: f64 = 0.652_358;

/// Errors of a shift by which it must exceed what is reported: seven degrees of freedom leave 1 % beyond on that side, of each parameter.
const BEYOND_CHANCE: f64 = 3.0;

/// Pairs of noises of either sign.
const PAIRS: u32 = 8;
/// Seed of the noise.
const SEED: u64 = 0x1a57;

/// A record with the motion that stands for its true one.
struct Denoised<'a> {
    x: Vec<f64>,
    y: &'a [f64],
    sd: f64,
}

/// The system that stands for the true one, and what it makes of the motions.
struct StandIn {
    theta: Parameters,
    /// One output a record, and the first sample that is simulated.
    outputs: Vec<(Vec<f64>, usize)>,
}

/// Inputs with their branches, as a fit meets them: first known sample and cells of each record; nothing where it never moves.
type Seen = Vec<Option<(usize, Cells)>>;

/// The fit whose repetition is simulated.
struct Again<'a> {
    fitted: &'a Fitted,
    kind: FitKind,
    rule: ReversalRule,
    records: Vec<Denoised<'a>>,
}

impl InputNoise {
    /// Of a fit that gave an estimate, reported in some units; `None` where no noise is found on the input, or a fit has no
    /// answer.
    pub(super) fn of(
        data: &Data,
        fitted: &Fitted,
        kind: FitKind,
        timing: Option<Timing>,
        estimate: &Estimate,
        units: OutputUnits,
    ) -> Option<Self> {
        let records: Vec<Denoised> =
            data.records.iter().map(|(r, b)| Denoised::of(r.v(), r.y(), b)).collect();
        let sd = records.iter().map(|r| r.sd).fold(0.0, f64::max);
        if sd == 0.0 || !is_stable(&fitted.theta.a) {
            return None;
        }
        let again = Again { fitted, kind, rule: data.rule, records };
        let stand_in = again.stand_in(timing)?;
        let values = |theta: &Parameters| -> Vec<f64> {
            quantities(theta, &fitted.basis, units).iter().map(|q| q.value).collect()
        };
        let truth = values(&stand_in.theta);
        let mut draws = vec![Vec::new(); truth.len()];
        for pair in 0..PAIRS {
            let noisy = |sign| Some(values(&again.with_noise(&stand_in, pair, sign)?));
            let (up, down) = (noisy(1.0)?, noisy(-1.0)?);
            for (draws, ((up, down), truth)) in draws.iter_mut().zip(up.iter().zip(&down).zip(&truth)) {
                draws.push(0.5 * (up + down) - truth);
            }
        }
        // The estimate is reported at some of the knots of the fit.
        let points = |reported: &[BorderPoint], knots: &[f64], first: usize| -> Vec<(usize, f64)> {
            let at = |p: &BorderPoint| Some((first + knots.iter().position(|&v| v == p.v)?, p.se));
            reported.iter().filter_map(at).collect()
        };
        let basis = &fitted.basis;
        let coefficients = estimate.a.len() + estimate.b.len();
        let switched = if basis.is_switched() { basis.descending().len() } else { 0 };
        let reported = (0..).zip(estimate.a_se.iter().chain(&estimate.b_se).copied());
        let reported = reported
            .chain(points(&estimate.descending, basis.descending(), coefficients))
            .chain(points(&estimate.ascending, basis.ascending(), coefficients + switched));
        let shifts = reported.map(|(i, se)| in_errors(&draws[i], se)).filter(|s| s.0.is_finite());
        // The one that is surest to be large, rather than the one that chance makes so.
        let sure = |shift: &(f64, f64)| shift.0 - BEYOND_CHANCE * shift.1;
        let (largest_shift, largest_shift_se) = shifts.max_by(|x, y| sure(x).total_cmp(&sure(y)))?;
        Some(Self { sd, share: sd / data.interval.width(), largest_shift, largest_shift_se })
    }

    /// What to show; `None` where intervals lose no more coverage than chance allows for.
    pub(super) fn warning(&self) -> Option<Warning> {
        let Self { sd, share, largest_shift, largest_shift_se } = *self;
        let is_reported = largest_shift - BEYOND_CHANCE * largest_shift_se > REPORTED;
        is_reported.then_some(Warning::InputNoise { sd, share, errors: largest_shift })
    }
}

/// Size of a mean and its error, both in standard errors of what it moves.
fn in_errors(draws: &[f64], se: f64) -> (f64, f64) {
    let count = draws.len() as f64;
    let mean = draws.iter().sum::<f64>() / count;
    let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean.abs() / se, (variance / count).sqrt() / se)
}

impl<'a> Denoised<'a> {
    fn of(v: &[f64], y: &'a [f64], branches: &Branches) -> Self {
        let sd = SensorNoise::of(v).sd;
        let x = if sd > 0.0 { smoothed(v, branches, sd) } else { v.to_vec() };
        Self { x, y, sd }
    }
}

impl Again<'_> {
    /// The system fitted to the motions and the measured outputs, by the timing that fits best.
    fn stand_in(&self, timing: Option<Timing>) -> Option<StandIn> {
        let structure = self.fitted.structure;
        let measured: Vec<&[f64]> = self.records.iter().map(|r| r.y).collect();
        let timings = timing.filter(|t| *t != Timing::AtConfirmation);
        let timings = timings.map_or(vec![Timing::AtSamples, Timing::BetweenSamples], |t| vec![t]);
        let on_motion = |timing| {
            let rule = ReversalRule { band: 0.0, timing, ..self.rule };
            let seen = self.seen(rule, |_, x| x.clone());
            let segments = segments(structure, &measured, &seen);
            let theta = self.fit(&segments)?;
            Some((self.cost(&theta, &segments), theta, seen))
        };
        let tried = timings.into_iter().filter_map(on_motion).filter(|(cost, ..)| cost.is_finite());
        let (_, theta, seen) = tried.min_by(|x, y| x.0.total_cmp(&y.0))?;
        let outputs = self.records.iter().zip(&seen).map(|(record, seen)| {
            let mut y = record.y.to_vec();
            let Some((first, cells)) = seen else { return (y, record.y.len()) };
            if let Some(segment) = Segment::usable(structure, record.y, cells, *first..y.len()) {
                y[segment.from..segment.to].copy_from_slice(&free_run(structure, &theta, &segment));
            }
            (y, *first)
        });
        let outputs = outputs.collect();
        Some(StandIn { theta, outputs })
    }

    /// The fit to the stand-in's outputs and motions with noise of one sign.
    fn with_noise(&self, stand_in: &StandIn, pair: u32, sign: f64) -> Option<Parameters> {
        let mut seen = self.seen(self.rule, |experiment, x| {
            let stream = StreamId { seed: SEED, experiment, replicate: pair };
            let sd = sign * self.records[experiment as usize].sd;
            x.iter().zip(white_samples(stream, x.len())).map(|(x, w)| x + sd * w).collect()
        });
        for (seen, (_, start)) in seen.iter_mut().zip(&stand_in.outputs) {
            if let Some((first, _)) = seen {
                *first = (*first).max(*start);
            }
        }
        let outputs: Vec<&[f64]> = stand_in.outputs.iter().map(|(y, _)| &y[..]).collect();
        self.fit(&segments(self.fitted.structure, &outputs, &seen))
    }

    /// Branches and cells of what `input` makes of the motion of each record.
    fn seen(&self, rule: ReversalRule, input: impl Fn(u32, &Vec<f64>) -> Vec<f64>) -> Seen {
        let one = |(experiment, record): (u32, &Denoised)| {
            let v = input(experiment, &record.x);
            let branches = Branches::of(&v, rule)?;
            Some((branches.first_known(), Cells::of(&self.fitted.basis, &v, &branches)))
        };
        (0..).zip(&self.records).map(one).collect()
    }

    /// Mean squared error of a free run, filtered as in the fit.
    fn cost(&self, theta: &Parameters, segments: &[Segment]) -> f64 {
        let Fitted { structure, whitening, .. } = self.fitted;
        let samples: usize = segments.iter().map(Segment::len).sum();
        whitened_cost(*structure, theta, segments, whitening) / samples as f64
    }

    fn fit(&self, segments: &[Segment]) -> Option<Parameters> {
        let Fitted { structure, basis, theta, whitening } = self.fitted;
        basis.check_visits(segments).ok()?;
        match self.kind {
            FitKind::Equation => equation_error_fit(&Moments::of(*structure, basis.features(), segments)),
            FitKind::Simulation | FitKind::Prewhitened => {
                let runs = Runs::new(segments.to_vec());
                Some(runs.refined(*structure, basis, theta.clone(), whitening, Effort::REPEATED))
            }
        }
    }
}

fn segments<'s>(structure: Structure, outputs: &[&'s [f64]], seen: &'s Seen) -> Vec<Segment<'s>> {
    let known = outputs.iter().zip(seen).filter_map(|(y, seen)| Some((*y, seen.as_ref()?)));
    known.filter_map(|(y, (first, cells))| Segment::usable(structure, y, cells, *first..y.len())).collect()
}

#[cfg(test)]
mod tests {
    use super::REPORTED;
    use statrs::distribution::{ContinuousCDF, Normal};

    #[test]
    fn an_interval_moved_by_what_is_reported_holds_the_truth_in_nine_of_ten_cases() {
        let (normal, half) = (Normal::standard(), 1.959_964);
        assert!((normal.cdf(half - REPORTED) - normal.cdf(-half - REPORTED) - 0.9).abs() < 1e-6);
    }
}
