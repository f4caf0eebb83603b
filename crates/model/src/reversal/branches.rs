//! Which border the working point is on, read off the input alone.

use crate::derivative::derivative;
use crate::hysteresis::Branch;

/// Steps of a lead in a sample.
pub const LEADS_PER_SAMPLE: f64 = 64.0;

/// Where between two samples a reversal takes effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Timing {
    /// As in (2.3): the turning sample is on the old border, the next one on the new.
    AtSamples,
    /// At the vertex of the parabola through the turning sample and its neighbours or, where the rule has a band, in the middle of the
    /// time spent within the band (on a noisy input the extremum itself is a poor mark). The sample there is shared between the
    /// borders, by the part of its interval `[t−½, t+½]` that follows: what a rig that knows no samples does.
    BetweenSamples,
    /// At the same instant, no sample shared: each sample is on the border of the direction of `dv/dt + τ·d²v/dt²` there. With `τ = 0` what a simulation does whose
    /// friction follows the sign of the velocity, read by a sensor that averages nothing; with `τ > 0` that of a soft constraint as in MuJoCo, which resists the velocity to
    /// come.
    ByVelocity {
        /// `τ`, sixty-fourths of a sample.
        lead: u16,
    },
    /// At the sample that confirms it, the first one that has moved back by more than the threshold: all that a simulation in real
    /// time can know. Until then the old border stays in force. Without a threshold this is [`Self::AtSamples`].
    AtConfirmation,
}

impl Timing {
    /// `τ`, samples.
    pub fn lead(self) -> f64 {
        match self {
            Self::ByVelocity { lead } => f64::from(lead) / LEADS_PER_SAMPLE,
            _ => 0.0,
        }
    }
}

/// What counts as a reversal, and when it takes effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReversalRule {
    /// A reversal counts once `v` has moved back by more than this, input units.
    pub threshold: f64,
    /// The turning sample is the last one this close to the extremum, input units; at most half the threshold.
    pub band: f64,
    /// When it takes effect.
    pub timing: Timing,
}

impl ReversalRule {
    /// Exactly (2.3): every move counts, at its sample.
    pub const EXACT: Self = Self { threshold: 0.0, band: 0.0, timing: Timing::AtSamples };

    /// The rule with every timing that needs no confirmation, its own first.
    pub fn with_every_timing(self) -> impl Iterator<Item = Self> {
        let all = [Timing::AtSamples, Timing::BetweenSamples, Timing::ByVelocity { lead: 0 }];
        let others = all.into_iter().filter(move |timing| *timing != self.timing);
        std::iter::once(self.timing).chain(others).map(move |timing| Self { timing, ..self })
    }

    /// Samples of `v` after `t` that decide the branch of `t`: none, one, or as many as a move beyond the threshold takes.
    pub fn looks_ahead(&self) -> LookAhead {
        match self.timing {
            Timing::AtConfirmation => LookAhead::Never,
            _ if self.threshold > 0.0 => LookAhead::UntilConfirmed,
            Timing::AtSamples => LookAhead::Never,
            Timing::BetweenSamples | Timing::ByVelocity { lead: 0 } => LookAhead::OneSample,
            Timing::ByVelocity { .. } => LookAhead::UntilConfirmed,
        }
    }
}

/// How much of the future a reversal rule needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LookAhead {
    /// The branch is known as soon as its sample is.
    Never,
    /// The sample after a reversal shows how the turning sample is shared.
    OneSample,
    /// A reversal is dated back once `v` has moved by the threshold, which takes as long as it takes.
    UntilConfirmed,
}

/// The branch of every sample of an input.
///
/// A reversal counts only once `v` has moved back from its extremum by more than the threshold (a turning-point, or
/// zigzag, rule), and then takes effect *retroactively*: every sample after the turning sample is on the new
/// branch. The turning sample is the last one within the band of the extremum, so that the whole of a noisy rest at an
/// extremum stays on the border it was reached on, as (2.3) has it. The rule looks ahead, which is no
/// obstacle: the input of a record, or of a simulation, is known as a whole. In real time it is not, and
/// [`Timing::AtConfirmation`] is the rule that remains: it leaves the samples between the turn and its confirmation on the old border.
///
/// With [`ReversalRule::EXACT`] this is (2.3): rising, falling, and holding at a rest.
///
/// ```
/// use switchback_model::reversal::{Branches, ReversalRule};
/// use switchback_model::hysteresis::Branch::{Ascending, Descending};
/// // The dip of 0.1 is sensor noise for a threshold of 0.3; the fall from 2 to 1 is a reversal.
/// let rule = ReversalRule { threshold: 0.3, ..ReversalRule::EXACT };
/// let branches = Branches::of(&[0.0, 1.0, 0.9, 2.0, 1.0], rule).unwrap();
/// assert_eq!(branches.labels(), [Ascending, Ascending, Ascending, Ascending, Descending]);
/// assert_eq!(branches.first_known(), 1);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Branches {
    labels: Vec<Branch>,
    /// Share of each sample that follows its reversal; zero except at turning samples.
    turned: Vec<f64>,
    first_known: usize,
    reversals: usize,
}

/// An extremum in the making: its value, and the last sample still counted as part of it.
#[derive(Debug, Clone, Copy)]
struct Extremum {
    value: f64,
    turn: usize,
}

impl Extremum {
    /// Takes in a sample; `sign` is +1 for a maximum and −1 for a minimum.
    fn push(&mut self, sign: f64, v: f64, t: usize, band: f64) {
        if sign * (v - self.value) >= -band {
            self.turn = t;
        }
        if sign * (v - self.value) > 0.0 {
            self.value = v;
        }
    }
}

impl Branches {
    /// Reads the branches off an input; `None` if `v` never moves by more than the threshold.
    ///
    pub fn of(v: &[f64], rule: ReversalRule) -> Option<Self> {
        let ReversalRule { threshold, band, timing } = rule;
        if let Timing::ByVelocity { lead: 1.. } = timing {
            let ahead = |(v, slope): (&f64, f64)| v + timing.lead() * slope;
            let ahead: Vec<f64> = v.iter().zip(derivative(v)).map(ahead).collect();
            return Self::of(&ahead, ReversalRule { timing: Timing::ByVelocity { lead: 0 }, ..rule });
        }
        let (mut high, mut low) =
            (Extremum { value: *v.first()?, turn: 0 }, Extremum { value: v[0], turn: 0 });
        let mut direction = None;
        let mut labels = Vec::with_capacity(v.len());
        let (mut first_known, mut reversals, mut shares) = (0, 0, Vec::new());
        for (t, &now) in v.iter().enumerate() {
            high.push(1.0, now, t, band);
            low.push(-1.0, now, t, band);
            let turned = match direction {
                None | Some(Branch::Ascending) if high.value - now > threshold => {
                    Some((Branch::Descending, high.turn))
                }
                None | Some(Branch::Descending) if now - low.value > threshold => {
                    Some((Branch::Ascending, low.turn))
                }
                _ => None,
            };
            labels.push(direction.unwrap_or(Branch::Ascending));
            if let Some((branch, last)) = turned {
                let instant = || if band > 0.0 { middle_of_rest(v, last, rule) } else { vertex(v, last) };
                let turn = match timing {
                    Timing::BetweenSamples if direction.is_some() => {
                        let (instant, turn) = (instant(), instant().round());
                        shares.push((turn as usize, 0.5 - (instant - turn)));
                        turn as usize
                    }
                    Timing::ByVelocity { .. } if direction.is_some() => instant().floor() as usize,
                    Timing::AtConfirmation => t - 1,
                    Timing::AtSamples | Timing::BetweenSamples | Timing::ByVelocity { .. } => last,
                };
                let from = if direction.is_some() { turn + 1 } else { 0 };
                labels[from..].fill(branch);
                match direction {
                    Some(_) => reversals += 1,
                    None => first_known = turn + 1,
                }
                direction = Some(branch);
                high = Extremum { value: now, turn: t };
                low = high;
            }
        }
        direction?;
        let mut turned = vec![0.0; v.len()];
        // A share only makes sense where the label really changes; on a noisy rest two turns may fall together.
        for (t, share) in shares {
            if t + 1 < v.len() && labels[t] != labels[t + 1] {
                turned[t] = share;
            }
        }
        Some(Self { labels, turned, first_known, reversals })
    }

    /// One branch a sample. Samples before the first move get the branch of that move.
    pub fn labels(&self) -> &[Branch] {
        &self.labels
    }

    /// First sample whose branch the input shows; before it `u` depends on what the rig did earlier.
    pub fn first_known(&self) -> usize {
        self.first_known
    }

    /// Share of a sample that belongs to the other branch already, if any.
    pub fn turned(&self, t: usize) -> Option<f64> {
        Some(self.turned[t]).filter(|&share| share > 0.0)
    }

    /// Number of reversals after the first move.
    pub fn reversals(&self) -> usize {
        self.reversals
    }
}

/// Instant at which the parabola through the turning sample and its neighbours turns.
fn vertex(v: &[f64], turn: usize) -> f64 {
    let [before, at, after] = [v[turn - 1], v[turn], v[turn + 1]];
    let offset = 0.5 * (before - after) / (before - 2.0 * at + after);
    // Three samples in line have no vertex: the reversal then takes effect as at samples.
    turn as f64 + if offset.is_finite() { offset.clamp(-0.5, 0.5) } else { 0.5 }
}

/// Middle of the time spent within the band of the extremum that ends at sample `last`.
fn middle_of_rest(v: &[f64], last: usize, rule: ReversalRule) -> f64 {
    let near = |t: &usize, distance: f64| (v[*t] - v[last]).abs() <= distance;
    let stay = (0..=last).rev().take_while(|t| near(t, rule.threshold));
    let first = stay.filter(|t| near(t, rule.band)).last().unwrap_or(last);
    0.5 * (first + last) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_velocity_each_sample_is_on_the_border_of_its_velocity() {
        let rule = ReversalRule { timing: Timing::ByVelocity { lead: 0 }, ..ReversalRule::EXACT };
        // Extrema fall anywhere between samples, and never on one.
        let angle = |t: usize| 0.283 * t as f64 + 0.1;
        let v: Vec<f64> = (0..500).map(|t| angle(t).sin()).collect();
        let branches = Branches::of(&v, rule).expect("it moves");
        for (t, label) in branches.labels().iter().enumerate().take(499).skip(branches.first_known()) {
            let rises = angle(t).cos() > 0.0;
            assert_eq!(*label == Branch::Ascending, rises, "sample {t}");
            assert_eq!(branches.turned(t), None);
        }
        // With the speed and one and a half times the acceleration.
        let ahead = Branches::of(&v, ReversalRule { timing: Timing::ByVelocity { lead: 96 }, ..rule });
        for (t, label) in ahead.expect("it moves").labels().iter().enumerate().take(495).skip(20) {
            let rises = angle(t).cos() - 1.5 * 0.283 * angle(t).sin() > 0.0;
            assert_eq!(*label == Branch::Ascending, rises, "sample {t}");
        }
        let others = [Timing::AtSamples, Timing::BetweenSamples];
        for branches in others.map(|timing| Branches::of(&v, ReversalRule { timing, ..rule }).expect("moves"))
        {
            let differs = |t: &usize| (branches.labels()[*t] == Branch::Ascending) != (angle(*t).cos() > 0.0);
            assert!((2..499).filter(differs).count() > 10);
        }
    }
}
