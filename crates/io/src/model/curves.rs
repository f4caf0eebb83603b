//! A model of the methods for any record: piecewise-linear curves and a linear part.

use super::Run;
use crate::identification::FreeRun;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_diagnose::NominalModel;
use switchback_identify::free::{Basis, Coefficients, Identified, Model, Structure};
use switchback_identify::statistics::propagated;
use switchback_model::hysteresis::Interval;
use switchback_model::reversal::{ReversalRule, Timing};

/// `A(q⁻¹) y(t) = Σᵢ bᵢ u(t−delay−i) + c`, i from 1, `u` linear between knots, in output units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Wire", into = "Wire")]
pub struct Curves {
    model: Model,
    noise_sd: f64,
    covariance: Option<Vec<Vec<f64>>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Map {
    Borders,
    Curve,
    Line,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Rule {
    /// A move back by less is no reversal, input units.
    #[schemars(range(min = 0))]
    threshold: f64,
    /// How far from the extremum the turning sample may lie, input units.
    #[schemars(range(min = 0))]
    band: f64,
    /// Whether it takes effect between samples.
    between_samples: bool,
    /// Whether it takes effect where it is confirmed, in real time; absent for no.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    at_confirmation: bool,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wire {
    /// `borders`, one `curve` for both directions, or a `line` that goes on beyond its ends.
    map: Map,
    /// Order of the linear part.
    order: usize,
    /// Delay of the linear part; negative where it looks ahead.
    delay: isize,
    /// Knots of the falling border; the only ones of a `curve` or a `line`.
    descending: Vec<f64>,
    /// Knots of the rising border.
    ascending: Option<Vec<f64>>,
    /// `a₁…aₙ`.
    a: Vec<f64>,
    /// `b₁…`.
    b: Vec<f64>,
    /// Values at the knots without the first, which is 0.
    f: Vec<f64>,
    /// The constant.
    c: f64,
    /// What counts as a reversal.
    rule: Rule,
    /// Standard deviation of the error of the free run on the fit records.
    #[schemars(range(min = 0))]
    noise_sd: f64,
    /// Covariance of `a`, `b`, `f`, `c`: rows of the lower triangle; null where it is unknown.
    covariance: Option<Vec<Vec<f64>>>,
}

/// Longest delay that a file may ask for, samples: what is longer is a mistake in the file.
const LONGEST: usize = 100_000;

impl Curves {
    /// The model of an identification with its errors.
    pub fn of(identified: &Identified) -> Self {
        let lower =
            |rows: &Vec<Vec<f64>>| rows.iter().enumerate().map(|(i, row)| row[..=i].to_vec()).collect();
        let covariance = identified.covariance.as_ref().map(lower);
        let is_finite = |rows: &Vec<Vec<f64>>| rows.iter().flatten().all(|x| x.is_finite());
        Self {
            model: identified.model.clone(),
            noise_sd: identified.estimate.noise_sd,
            covariance: covariance.filter(is_finite),
        }
    }

    /// The model that runs.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// A move back by less is no reversal, input units.
    pub fn reversal_threshold(&self) -> f64 {
        self.model.rule().threshold
    }

    pub(super) fn moved(&self, step: &[f64]) -> Self {
        Self { model: self.model.moved(step), ..self.clone() }
    }

    pub(super) fn delay(&self) -> isize {
        self.model.structure().delay
    }

    /// `a` and `b`.
    pub(super) fn linear(&self) -> (Vec<f64>, Vec<f64>) {
        let Coefficients { a, b, .. } = self.model.coefficients();
        (a, b)
    }

    /// The same system as borders between which nothing is left out; see [`plain`].
    pub(crate) fn plain(&self) -> Option<NominalModel> {
        plain(&self.model)
    }

    /// Covariance of the coefficients, rows of the lower triangle.
    pub(super) fn covariance(&self) -> Option<&[Vec<f64>]> {
        self.covariance.as_deref()
    }

    /// The curves `(v, u)`, descending and ascending, with the constant as a level of `u` where `B(1)` is not zero.
    pub(super) fn borders(&self) -> [Vec<(f64, f64)>; 2] {
        borders(&self.model)
    }

    /// A free run; see [`super::ModelFile::run`].
    pub(super) fn run(&self, v: &[f64], y: Option<&[f64]>) -> Run {
        let start = if y.is_some() { self.model.start(v) } else { 0 };
        let before = y.map_or(&[][..], |y| &y[..start]);
        let run = |by: &[f64]| self.model.moved(by).simulate(v, before);
        let simulated = self.model.simulate(v, before);
        let errors = self.covariance.as_ref().map(|rows| propagated(rows, run)).unwrap_or_default();
        let noise = self.noise_sd * self.noise_sd;
        let variances: Vec<f64> =
            (0..v.len()).map(|t| noise + errors.get(t).copied().unwrap_or(0.0)).collect();
        let measured = y.unwrap_or(&simulated).to_vec();
        Run::with_band(FreeRun::new(&measured, simulated, start), &variances, y.is_some())
    }
}

/// An identified system as borders between which nothing is left out; none with a delay, a look ahead or a gain of zero, or where it is a
/// line that goes on beyond its ends.
pub(crate) fn plain(model: &Model) -> Option<NominalModel> {
    let Coefficients { a, b, .. } = model.coefficients();
    let is_plain = model.structure().delay == 0 && !model.basis().is_line() && b.iter().sum::<f64>() != 0.0;
    let [descending, ascending] = borders(model);
    is_plain.then_some(NominalModel { a, b, descending, ascending })
}

fn borders(model: &Model) -> [Vec<(f64, f64)>; 2] {
    let Coefficients { b, f, c, .. } = model.coefficients();
    let level = c / b.iter().sum::<f64>();
    let level = if level.is_finite() { level } else { 0.0 };
    let value = |k: usize| level + if k == 0 { 0.0 } else { f[k - 1] };
    let basis = model.basis();
    let curve = |knots: &[f64], first: usize| -> Vec<(f64, f64)> {
        knots.iter().enumerate().map(|(k, &v)| (v, value(first + k))).collect()
    };
    let first = if basis.is_switched() { basis.descending().len() } else { 0 };
    [curve(basis.descending(), 0), curve(basis.ascending(), first)]
}

impl TryFrom<Wire> for Curves {
    type Error = String;

    fn try_from(wire: Wire) -> Result<Self, String> {
        if wire.delay.unsigned_abs() > LONGEST || wire.order > LONGEST {
            return Err(format!("`order` and `delay` are at most {LONGEST} samples"));
        }
        if !(wire.rule.threshold >= 0.0 && wire.rule.band >= 0.0) {
            return Err("`threshold` and `band` must be zero or positive".to_owned());
        }
        if !(wire.noise_sd >= 0.0 && wire.noise_sd.is_finite()) {
            return Err("`noise_sd` must be zero or positive".to_owned());
        }
        let basis = match (wire.map, wire.ascending, &wire.descending[..]) {
            (Map::Borders, Some(ascending), _) => Basis::borders(wire.descending, ascending),
            (Map::Borders, None, _) => return Err("`borders` need the knots `ascending`".to_owned()),
            (_, Some(_), _) => return Err("only `borders` have the knots `ascending`".to_owned()),
            (Map::Curve, None, _) => Basis::curve(wire.descending),
            (Map::Line, None, &[low, high]) => {
                Basis::linear(Interval::new(low, high).map_err(|error| error.to_string())?)
            }
            (Map::Line, None, _) => return Err("a `line` has two knots".to_owned()),
        };
        let timing = match (wire.rule.between_samples, wire.rule.at_confirmation) {
            (false, false) => Timing::AtSamples,
            (true, false) => Timing::BetweenSamples,
            (false, true) => Timing::AtConfirmation,
            (true, true) => return Err("a `rule` is `between_samples` or `at_confirmation`".to_owned()),
        };
        let rule = ReversalRule { threshold: wire.rule.threshold, band: wire.rule.band, timing };
        let structure = Structure { order: wire.order, delay: wire.delay };
        let coefficients = Coefficients { a: wire.a, b: wire.b, f: wire.f, c: wire.c };
        let count = coefficients.a.len() + coefficients.b.len() + coefficients.f.len() + 1;
        let model = Model::new(basis, structure, coefficients, rule).map_err(|error| error.to_string())?;
        check_rows(wire.covariance.as_deref(), count)?;
        Ok(Self { model, noise_sd: wire.noise_sd, covariance: wire.covariance })
    }
}

/// Whether a lower triangle has a row a parameter.
pub(super) fn check_rows(rows: Option<&[Vec<f64>]>, parameters: usize) -> Result<(), String> {
    let Some(rows) = rows else { return Ok(()) };
    if rows.len() != parameters || rows.iter().enumerate().any(|(i, row)| row.len() != i + 1) {
        return Err(format!("`covariance` must be a lower triangle of {parameters} rows"));
    }
    Ok(())
}

impl From<Curves> for Wire {
    fn from(curves: Curves) -> Self {
        let Curves { model, noise_sd, covariance } = curves;
        let (basis, structure, rule) = (model.basis(), model.structure(), model.rule());
        let Coefficients { a, b, f, c } = model.coefficients();
        Self {
            map: match (basis.is_switched(), basis.is_line()) {
                (true, _) => Map::Borders,
                (_, true) => Map::Line,
                _ => Map::Curve,
            },
            order: structure.order,
            delay: structure.delay,
            descending: basis.descending().to_vec(),
            ascending: basis.is_switched().then(|| basis.ascending().to_vec()),
            a,
            b,
            f,
            c,
            rule: Rule {
                threshold: rule.threshold,
                band: rule.band,
                between_samples: rule.timing == Timing::BetweenSamples,
                at_confirmation: rule.timing == Timing::AtConfirmation,
            },
            noise_sd,
            covariance,
        }
    }
}
