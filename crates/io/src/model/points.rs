//! A model of the methods for pulse experiments: points of the borders and a linear part.

use super::Run;
use super::curves::check_rows;
use crate::identification::{EstimatedSystem, FreeRun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_identify::statistics::propagated;
use switchback_identify::{BorderPoint, Estimate};
use switchback_model::Record;
use switchback_model::hysteresis::Interval;
use switchback_model::linear::autocovariance;

/// `A(q⁻¹) y(t) = Σᵢ bᵢ u(t−delay−i)`, i from 1, `u` on points of the borders in the paper's normalisation `u_M − u_m = 1`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Wire", into = "Wire")]
pub struct Points(Wire);

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wire {
    /// `a₁…aₙ`.
    a: Vec<f64>,
    /// `b₁…`, output units per normalised `u`.
    b: Vec<f64>,
    /// Delay, samples; negative where it looks ahead.
    delay: isize,
    /// `B(1)/A(1)`, output units.
    gain: f64,
    /// Output at rest at `u_m`.
    y_low: f64,
    /// Output at rest at `u_M`.
    y_high: f64,
    /// Ends of the working interval, to which the borders are completed.
    interval: [f64; 2],
    /// Points `[v, F(v)]` of the falling border by increasing `v`; none where it was not seen.
    descending: Vec<(f64, f64)>,
    /// Points `[v, F(v)]` of the rising border.
    ascending: Vec<(f64, f64)>,
    /// Standard deviation of the equation error.
    #[schemars(range(min = 0))]
    noise_sd: f64,
    /// Covariance of `a`, `b`, the falling and the rising points: rows of the lower triangle; null where it is unknown.
    covariance: Option<Vec<Vec<f64>>>,
}

/// Longest delay that a file may ask for, samples: what is longer is a mistake in the file.
const LONGEST: usize = 100_000;

impl Points {
    /// An estimate that runs over a working interval; `covariance` is that of `a`, `b`, the descending and the ascending points, row by row.
    ///
    /// # Errors
    /// In words, where the estimate cannot run.
    pub(crate) fn of(
        estimate: &Estimate,
        interval: Interval,
        covariance: Option<Vec<Vec<f64>>>,
    ) -> Result<Self, String> {
        let points = |border: &[BorderPoint]| border.iter().map(|p| (p.v, p.f)).collect();
        let lower = |rows: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            rows.into_iter().enumerate().map(|(i, row)| row[..=i].to_vec()).collect()
        };
        let is_finite = |rows: &Vec<Vec<f64>>| rows.iter().flatten().all(|x| x.is_finite());
        Self::try_from(Wire {
            a: estimate.a.clone(),
            b: estimate.b.clone(),
            delay: estimate.delay,
            gain: estimate.gain,
            y_low: estimate.y_low,
            y_high: estimate.y_high,
            interval: [interval.low(), interval.high()],
            descending: points(&estimate.descending),
            ascending: points(&estimate.ascending),
            noise_sd: estimate.noise_sd,
            covariance: covariance.map(lower).filter(is_finite),
        })
    }

    pub(super) fn a(&self) -> &[f64] {
        &self.0.a
    }

    pub(super) fn b(&self) -> &[f64] {
        &self.0.b
    }

    pub(super) fn delay(&self) -> isize {
        self.0.delay
    }

    pub(super) fn borders(&self) -> [Vec<(f64, f64)>; 2] {
        [self.0.descending.clone(), self.0.ascending.clone()]
    }

    pub(super) fn covariance(&self) -> Option<&[Vec<f64>]> {
        self.0.covariance.as_deref()
    }

    /// The estimate that it was made from, without standard errors.
    pub(crate) fn estimate(&self) -> Estimate {
        self.0.estimate()
    }

    pub(super) fn interval(&self) -> Interval {
        let [low, high] = self.0.interval;
        Interval::new(low, high).expect("checked when the model was made")
    }

    /// A free run; see [`super::ModelFile::run`].
    pub(super) fn run(&self, v: &[f64], y: Option<&[f64]>) -> Option<Run> {
        let measured = y.map_or_else(|| vec![0.0; v.len()], <[f64]>::to_vec);
        let record = Record::new(v.to_vec(), measured).ok()?;
        let interval = self.interval();
        let simulate = |estimate: &Estimate| -> Option<FreeRun> {
            // Moved within its errors a pole may leave the unit circle; the run does not mind.
            let system = EstimatedSystem::of_any(estimate, interval);
            match y {
                Some(_) => system.run(&record),
                None => system.run_from_rest(v).map(|y| FreeRun::new(&y.clone(), y, 0)),
            }
        };
        let run = simulate(&self.0.estimate())?;
        let moved = |step: &[f64]| {
            let moved = simulate(&self.0.moved(step));
            moved.map_or_else(|| vec![0.0; v.len()], |run| run.simulated)
        };
        let errors = self.covariance().map(|rows| propagated(rows, moved)).unwrap_or_default();
        let noise = self.output_noise();
        let variances: Vec<f64> =
            (0..v.len()).map(|t| noise + errors.get(t).copied().unwrap_or(0.0)).collect();
        Some(Run::with_band(run, &variances, y.is_some()))
    }

    /// Variance that white equation errors make of the output.
    fn output_noise(&self) -> f64 {
        let gain = autocovariance(&self.0.a, &[], 0)[0];
        self.0.noise_sd * self.0.noise_sd * gain
    }
}

impl TryFrom<Wire> for Points {
    type Error = String;

    fn try_from(wire: Wire) -> Result<Self, String> {
        let order = wire.a.len();
        if order == 0 {
            return Err("`a` is empty: a model needs a pole at least".to_owned());
        }
        if wire.delay.unsigned_abs() > LONGEST {
            return Err(format!("`delay` is at most {LONGEST} samples"));
        }
        let expected = order + wire.delay.min(0).unsigned_abs();
        if wire.b.len() != expected {
            return Err(format!("`b` has {} numbers, but `a` and `delay` make {expected}", wire.b.len()));
        }
        for (name, border) in [("descending", &wire.descending), ("ascending", &wire.ascending)] {
            if border.windows(2).any(|pair| pair[1].0 < pair[0].0) {
                return Err(format!("list the points of `{name}` by increasing v"));
            }
        }
        if wire.descending.is_empty() && wire.ascending.is_empty() {
            return Err("there is no point of a border".to_owned());
        }
        if !(wire.noise_sd >= 0.0 && wire.noise_sd.is_finite()) {
            return Err("`noise_sd` must be zero or positive".to_owned());
        }
        let interval =
            Interval::new(wire.interval[0], wire.interval[1]).map_err(|error| error.to_string())?;
        EstimatedSystem::new(&wire.estimate(), interval).map_err(str::to_owned)?;
        check_rows(wire.covariance.as_deref(), wire.parameters())?;
        Ok(Self(wire))
    }
}

impl From<Points> for Wire {
    fn from(points: Points) -> Self {
        points.0
    }
}

impl Wire {
    fn parameters(&self) -> usize {
        self.a.len() + self.b.len() + self.descending.len() + self.ascending.len()
    }

    fn estimate(&self) -> Estimate {
        let points =
            |border: &[(f64, f64)]| border.iter().map(|&(v, f)| BorderPoint { v, f, se: f64::NAN }).collect();
        Estimate {
            a: self.a.clone(),
            a_se: vec![f64::NAN; self.a.len()],
            b: self.b.clone(),
            b_se: vec![f64::NAN; self.b.len()],
            delay: self.delay,
            noise_sd: self.noise_sd,
            gain: self.gain,
            y_high: self.y_high,
            y_low: self.y_low,
            descending: points(&self.descending),
            ascending: points(&self.ascending),
            excitation: f64::NAN,
            samples: 0,
        }
    }

    /// The estimate with its parameters moved by a step; the ends of the borders follow.
    fn moved(&self, step: &[f64]) -> Estimate {
        let mut estimate = self.estimate();
        let mut steps = step.iter();
        let coefficients = estimate.a.iter_mut().chain(&mut estimate.b);
        let points = estimate.descending.iter_mut().chain(&mut estimate.ascending).map(|p| &mut p.f);
        coefficients.chain(points).zip(steps.by_ref()).for_each(|(x, by)| *x += by);
        estimate.gain = estimate.b.iter().sum::<f64>() / (1.0 + estimate.a.iter().sum::<f64>());
        // The lower end of the descending border is u_m, the upper one of the ascending border u_M = u_m + 1.
        let low = estimate.descending.first().map(|p| p.f).or(estimate.ascending.last().map(|p| p.f - 1.0));
        if let Some(low) = low {
            (estimate.y_low, estimate.y_high) = (estimate.gain * low, estimate.gain * (low + 1.0));
        }
        estimate
    }
}
