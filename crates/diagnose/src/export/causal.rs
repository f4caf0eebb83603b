//! A model as it runs sample by sample, on an input that is known no further than to the present.

use switchback_model::step;
use thiserror::Error;

use super::lasting::{notes, without_waves};
use super::portable::{PortableModel, Wire};
use crate::likelihood::rows::at_the_end;
use crate::model::augmented::{
    BorderColumn, Clock, EquationColumn, Resting, Slow, Speeds, TransitionLaw, convolve,
};
use crate::model::effect_terms::{EffectTerms, Operator};
use crate::model::sensor::{STEEPEST, SensorCurve};
use crate::model::sensor_polynomial::FLATTEST;
use crate::records::dataset::RESOLUTION;
use crate::records::motion::Begins;
use crate::simulation::initial_conditions::{Level, with_level};
use crate::simulation::simulate::LIMIT;

/// Why a model cannot run in real time.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum LooksAhead {
    /// An output depends on later inputs.
    #[error("it weighs the input {0} sample(s) ahead")]
    Input(usize),
    /// A branch begins before the move that shows it.
    #[error("it dates a reversal back once the input has moved by {0}")]
    Reversals(f64),
}

impl PortableModel {
    /// The model as it runs sample by sample from rest, [`Self::simulate`] without measured outputs.
    ///
    /// # Errors
    /// [`LooksAhead`] where an output would depend on inputs that are yet to come.
    pub fn causal(&self) -> Result<step::Model, LooksAhead> {
        self.0.causal()
    }

    /// What is assumed on records that the model was not made from, one sentence each.
    pub fn elsewhere(&self) -> Vec<String> {
        notes(&self.0.augmented)
    }
}

impl Wire {
    fn causal(&self) -> Result<step::Model, LooksAhead> {
        let effect_terms = self.augmented.effect_terms();
        let s = self.scales;
        let on_scale = |origin, size| step::Scale { origin, size, grid: None };
        let rule = self.rule;
        if rule.threshold > 0.0 && rule.begins == Begins::AtExtreme {
            return Err(LooksAhead::Reversals(rule.threshold * s.v_width));
        }
        let play = effect_terms.positions.play;
        Ok(step::Model {
            input: step::Scale { grid: Some(RESOLUTION), ..on_scale(s.v_low, s.v_width) },
            output: on_scale(s.y_mean, s.y_scale),
            late: effect_terms.positions.late,
            direction: step::Direction::Place {
                threshold: rule.threshold,
                play: step::Play { width: play.width, taper: play.taper },
                between_borders: self.criterion.simulates(),
            },
            borders: self.borders(),
            effects: self.effects(&effect_terms.operator),
            linear: self.linear(&effect_terms)?,
            sensor: sensor(effect_terms.curve, effect_terms.saturation.map(|range| [range.low, range.high])),
        })
    }

    fn borders(&self) -> step::Borders {
        let mut values = self.linear.f.iter().copied();
        let [descending, ascending] = [0, 1].map(|side: usize| {
            let knots = self.grid.knots[side].clone();
            let values = values.by_ref().take(knots.len()).collect();
            step::Curve { knots, values, beyond: step::Beyond::Holds }
        });
        step::Borders::Two { descending, ascending }
    }

    /// Slow changes stand where the dataset ended.
    fn at_the_end(&self, clock: Clock) -> f64 {
        at_the_end(clock, self.clock.total, self.clock.records.len())
    }

    fn effects(&self, operator: &Operator<'_>) -> step::Effects {
        let Operator { jitter, transition, wear, widening, relaxation, columns, gain } = *operator;
        let slow = |slow: Option<&Slow>| slow.map_or(0.0, |slow| slow.at(self.at_the_end(slow.clock)));
        let coefficients = &self.linear.f[self.grid.len()..];
        let added =
            columns.iter().zip(coefficients).filter_map(|(column, c)| Some((self.column(column)?, *c)));
        step::Effects {
            jitter,
            transition: transition.map(|passing| step::Transition {
                length: passing.length,
                shape: passing.shape,
                reach: passing.reach(step::NEGLIGIBLE),
                law: match passing.law {
                    TransitionLaw::Offset => step::TransitionLaw::Offset,
                    TransitionLaw::Held => step::TransitionLaw::Held,
                    TransitionLaw::Crossing => step::TransitionLaw::Crossing,
                },
            }),
            narrowing: slow(wear),
            widening: widening.map(|wide| step::Widening {
                share: wide.share,
                power: wide.power,
                scale: wide.scale,
                at_high_speeds: wide.speeds == Speeds::High,
            }),
            relaxation: relaxation.map(|r| step::Relaxation { share: r.share, tau: r.tau }),
            columns: added.collect(),
            had_starts: columns.iter().any(|column| matches!(column, BorderColumn::Start { .. })),
            gain: slow(gain),
        }
    }

    /// A border column away from the dataset; what only the start of one record had is none.
    fn column(&self, column: &BorderColumn) -> Option<step::Column> {
        let held = |while_resting| while_resting == Resting::Held;
        Some(match *column {
            BorderColumn::Speed { power, scale, while_resting } => {
                step::Column::Speed { power, scale, held: held(while_resting) }
            }
            BorderColumn::LowSpeed { power, scale, while_resting } => {
                step::Column::LowSpeed { power, scale, held: held(while_resting) }
            }
            BorderColumn::Bristle { power, scale, length } => step::Column::Bristle { power, scale, length },
            BorderColumn::RestingLog { scale } => step::Column::RestingLog { scale },
            BorderColumn::RestingRise { scale } => step::Column::RestingRise { scale },
            BorderColumn::ReversalLog { scale } => step::Column::ReversalLog { scale },
            BorderColumn::BranchSlow { clock } => step::Column::Branch { at: self.at_the_end(clock) },
            BorderColumn::SideSlow { clock, branch } => {
                step::Column::Side { at: self.at_the_end(clock), branch }
            }
            BorderColumn::Start { .. } => return None,
        })
    }

    fn linear(&self, effect_terms: &EffectTerms<'_>) -> Result<step::Linear, LooksAhead> {
        let b = convolve(&self.linear.b, &effect_terms.filter.taps());
        // A delay is zeros before the first coefficient.
        let zeros = b.iter().take_while(|b| **b == 0.0).count().min(b.len() - 1);
        let lag = 1 + zeros as isize - self.lead;
        let lag = usize::try_from(lag).map_err(|_| LooksAhead::Input(lag.unsigned_abs()))?;
        Ok(step::Linear {
            poles: effect_terms.filter.poles().to_vec(),
            a: self.linear.a.clone(),
            b: b[zeros..].to_vec(),
            lag,
            constant: self.disturbance(effect_terms.columns),
            limit: Some(LIMIT),
        })
    }

    /// The sum of the equation columns on a record of which nothing is known.
    fn disturbance(&self, columns: &[EquationColumn]) -> f64 {
        let linear = without_waves(&self.linear, &self.augmented);
        let value = |column: &EquationColumn| match *column {
            EquationColumn::Trend { clock, degree } => {
                (2.0 * self.at_the_end(clock) - 1.0).powi(degree as i32)
            }
            EquationColumn::Gain => {
                let gain = self.augmented.gain.as_ref();
                gain.map_or(0.0, |gain| gain.at(self.at_the_end(gain.clock)))
            }
            // These belong to other records, and the phase of a wave is unknown.
            EquationColumn::Line { .. }
            | EquationColumn::Decay { .. }
            | EquationColumn::Local { .. }
            | EquationColumn::Offset { .. } => 0.0,
        };
        let lasting: f64 = columns.iter().zip(&linear.d).map(|(column, d)| d * value(column)).sum();
        let has_level = !with_level(&self.augmented, self.clock.records.len()).1.is_empty();
        let level = Level::of(&self.augmented, &linear.d).filter(|_| has_level);
        lasting + level.map_or(0.0, Level::expected)
    }
}

fn sensor(curve: &SensorCurve, range: Option<[f64; 2]>) -> step::Sensor {
    let SensorCurve { powers, sensor_polynomial, bumps, knees } = curve;
    step::Sensor {
        powers: powers.clone(),
        bumps: bumps.as_ref().map(|bumps| step::Bumps {
            first: bumps.first,
            spacing: bumps.spacing,
            heights: bumps.heights.clone(),
        }),
        knees: knees
            .iter()
            .map(|knee| step::Knee {
                level: knee.level,
                width: knee.width,
                sign: knee.sign,
                steepest: STEEPEST,
            })
            .collect(),
        cubic: sensor_polynomial.map(|curve| {
            let ([square, cube], range) = curve.reported();
            step::Cubic { square, cube, range, flattest: FLATTEST }
        }),
        range,
    }
}
