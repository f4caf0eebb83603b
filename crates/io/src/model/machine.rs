//! A model with terms for effects, in the user's units and samples: a source with the values of a machine.

use super::Run;
use crate::identification::FreeRun;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_model::hysteresis::Branch;
use switchback_model::reversal::{LEADS_PER_SAMPLE, ReversalRule, Timing};
use switchback_model::system::{Borders, LinearPart, Sensor, Span, System, Term, every_law};

/// A machine as it is simulated: borders in output units, a linear part of unit gain, a reading, effects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Wire", into = "Wire")]
pub struct Machine {
    system: System,
    noise_sd: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wire {
    /// Points `[v, y]` of the falling border, by increasing `v`.
    descending: Vec<(f64, f64)>,
    /// Points `[v, y]` of the rising border.
    ascending: Vec<(f64, f64)>,
    /// `a₁…aₙ`.
    a: Vec<f64>,
    /// Numerator coefficients; their sum is `1 + Σa`.
    b: Vec<f64>,
    /// Samples between the newest input and the output.
    lag: isize,
    /// Further delay, samples.
    delay: f64,
    /// Factor of the output.
    gain: f64,
    /// Zero of the output, output units.
    zero: f64,
    /// What counts as a reversal.
    reversal: Reversal,
    /// Effects, in the order in which they act.
    terms: Vec<WireTerm>,
    /// Standard deviation of the noise, output units.
    #[schemars(range(min = 0))]
    noise_sd: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Reversal {
    /// A move back by less is no reversal, input units.
    #[schemars(range(min = 0))]
    threshold: f64,
    /// How far from the extremum the turning sample may lie, input units.
    #[schemars(range(min = 0))]
    band: f64,
    /// When it takes effect.
    timing: When,
    /// Samples of `τ` where it is by the direction of `dv/dt + τ·d²v/dt²`; absent for none.
    #[serde(default, skip_serializing_if = "is_none")]
    #[schemars(range(min = 0, max = 1000))]
    lead: f64,
}

fn is_none(lead: &f64) -> bool {
    *lead == 0.0
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum When {
    AtSamples,
    BetweenSamples,
    ByVelocity,
    AtConfirmation,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct WireTerm {
    /// The effect.
    effect: String,
    /// Its law among those of the effect.
    law: String,
    /// One value a parameter of the law, the strength first; input and output units, samples.
    values: Vec<f64>,
}

impl Machine {
    /// Of a system whose records have such noise.
    pub fn new(system: System, noise_sd: f64) -> Self {
        Self { system, noise_sd }
    }

    /// The system.
    pub(super) fn system(&self) -> &System {
        &self.system
    }

    /// The free run from rest at the first input, with the band of the noise.
    pub(super) fn run(&self, v: &[f64], y: Option<&[f64]>) -> Run {
        let simulated = self.system.simulate(v, Span::alone(v.len()));
        let run = match y {
            Some(y) => FreeRun::new(y, simulated, 0),
            None => FreeRun { simulated, start: 0, fit_percent: f64::NAN },
        };
        let variances = vec![self.noise_sd * self.noise_sd; v.len()];
        Run::with_band(run, &variances, y.is_some())
    }

    /// Whether slow changes of it follow the clock of the records that it was identified on.
    pub(super) fn follows_clock(&self) -> bool {
        const SLOW: [&str; 5] = ["border_wear", "gain_drift", "sensor_drift", "step_change", "record_offset"];
        self.system.terms.iter().any(|term| SLOW.contains(&term.law.effect()))
    }
}

impl From<Machine> for Wire {
    fn from(machine: Machine) -> Self {
        let Machine { system, noise_sd } = machine;
        let rule = system.rule;
        Self {
            descending: system.borders.points(Branch::Descending).collect(),
            ascending: system.borders.points(Branch::Ascending).collect(),
            a: system.linear.a().to_vec(),
            b: system.linear.b(),
            lag: system.linear.lag(),
            delay: system.linear.delay,
            gain: system.sensor.gain,
            zero: system.sensor.zero,
            reversal: Reversal {
                threshold: rule.threshold,
                band: rule.band,
                timing: match rule.timing {
                    Timing::AtSamples => When::AtSamples,
                    Timing::BetweenSamples => When::BetweenSamples,
                    Timing::ByVelocity { .. } => When::ByVelocity,
                    Timing::AtConfirmation => When::AtConfirmation,
                },
                lead: rule.timing.lead(),
            },
            terms: system
                .terms
                .iter()
                .map(|term| WireTerm {
                    effect: term.law.effect().to_owned(),
                    law: term.law.name().to_owned(),
                    values: term.values.clone(),
                })
                .collect(),
            noise_sd,
        }
    }
}

/// Longest delay that a file may ask for, samples: a longer one is a mistake in the file.
const LONGEST: f64 = 1e5;

impl TryFrom<Wire> for Machine {
    type Error = String;

    fn try_from(wire: Wire) -> Result<Self, String> {
        let Wire { descending, ascending, a, b, lag, delay, gain, zero, reversal, terms, noise_sd } = wire;
        let is_finite = |x: &f64| x.is_finite();
        let points = || descending.iter().chain(&ascending).flat_map(|(v, y)| [*v, *y]);
        if !points().all(|x| x.is_finite()) || !a.iter().chain(&b).all(is_finite) {
            return Err("a number of the borders or of the linear part is not finite".to_owned());
        }
        let borders = Borders::new(&descending, &ascending)
            .ok_or("the knots of a border must rise, and each border needs two")?;
        let (mut linear, _) =
            LinearPart::new(&a, &b, lag).ok_or("`a` is unstable, or the sum of `b` is zero")?;
        if !(delay.abs() <= LONGEST && lag.unsigned_abs() as f64 <= LONGEST) {
            return Err(format!("`lag` and `delay` must be within ±{LONGEST:e} samples"));
        }
        linear.delay = delay;
        let numbers = [gain, zero, reversal.threshold, reversal.band, reversal.lead, noise_sd];
        if !numbers.iter().all(is_finite) || numbers[2..].iter().any(|x| *x < 0.0) {
            return Err("`gain`, `zero`, `reversal` and `noise_sd` must be finite, `reversal` and `noise_sd` not negative".to_owned());
        }
        let term = |wire: WireTerm| -> Result<Term, String> {
            let known = every_law().find(|law| law.effect() == wire.effect && law.name() == wire.law);
            let law = known.ok_or_else(|| format!("`{}` has no law `{}`", wire.effect, wire.law))?;
            let fits = wire.values.len() == law.parameters().len() && wire.values.iter().all(is_finite);
            let expected = law.parameters().len();
            fits.then_some(Term { law, values: wire.values })
                .ok_or_else(|| format!("`{}` needs {expected} finite values", wire.law))
        };
        let terms = terms.into_iter().map(term).collect::<Result<_, _>>()?;
        let timing = match reversal.timing {
            When::AtSamples => Timing::AtSamples,
            When::BetweenSamples => Timing::BetweenSamples,
            When::ByVelocity => {
                Timing::ByVelocity { lead: (LEADS_PER_SAMPLE * reversal.lead).round() as u16 }
            }
            When::AtConfirmation => Timing::AtConfirmation,
        };
        let rule = ReversalRule { threshold: reversal.threshold, band: reversal.band, timing };
        let system = System { borders, linear, sensor: Sensor { gain, zero }, terms, rule };
        Ok(Self { system, noise_sd })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn machine() -> Machine {
        let borders = Borders::new(&[(-1.0, -1.0), (1.0, 0.5)], &[(-1.0, 0.0), (1.0, 1.5)]).unwrap();
        let (linear, _) = LinearPart::new(&[-0.6], &[0.3, 0.1], 1).unwrap();
        let terms = every_law().take(4).map(|law| Term { law, values: vec![0.1; law.parameters().len()] });
        let sensor = Sensor { gain: 1.1, zero: -0.2 };
        let system = System { borders, linear, sensor, terms: terms.collect(), rule: ReversalRule::EXACT };
        Machine::new(system, 0.01)
    }

    #[test]
    fn what_is_written_is_read_back_and_runs_the_same() {
        let machine = machine();
        let text = serde_json::to_string(&machine).unwrap();
        let read: Machine = serde_json::from_str(&text).unwrap();
        let v: Vec<f64> = (0..200).map(|t| (0.1 * f64::from(t)).sin()).collect();
        let runs = [&machine, &read].map(|m| m.run(&v, None).y);
        assert!(runs[0].iter().zip(&runs[1]).all(|(x, y)| (x - y).abs() < 1e-12));
        assert_eq!(read.system.terms, machine.system.terms);
    }

    #[test]
    fn parts_that_make_no_machine_are_refused_with_a_reason() {
        let text = serde_json::to_string(&machine()).unwrap();
        for (old, new, reason) in [
            ("\"a\":[-0.6]", "\"a\":[-1.6]", "unstable"),
            ("\"lag\":1", "\"lag\":100000000", "within"),
            ("\"effect\":\"backlash\"", "\"effect\":\"baklash\"", "no law"),
            ("\"noise_sd\":0.01", "\"noise_sd\":-1.0", "not negative"),
            ("[[-1.0,-1.0],[1.0,0.5]]", "[[1.0,-1.0],[1.0,0.5]]", "must rise"),
        ] {
            assert!(text.contains(old), "{old} {text}");
            let error = serde_json::from_str::<Machine>(&text.replacen(old, new, 1)).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }
}
