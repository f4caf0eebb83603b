//! What the input does, sample by sample, as the operator sees it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Direction of the working point.
pub(crate) type Sign = f64;

/// One sample of the input's motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    /// +1 on the ascending border, −1 on the descending one, 0 before the first move.
    pub(crate) branch: Sign,
    /// Whether the operator's input moves at this sample (inside the play it does not).
    pub(crate) moves: bool,
    /// Input at the last reversal.
    pub(crate) turn: f64,
    /// Travel since the last reversal.
    pub(crate) travel: f64,
    /// Whether a new branch starts at this sample.
    pub(crate) reversal: bool,
    /// Travel between the last two reversals: the size of the loop.
    pub(crate) loop_size: f64,
    /// Samples since the last reversal.
    pub(crate) since: usize,
    /// Samples since the last move.
    pub(crate) rest: usize,
    /// `v(t) − v(t−1)`.
    pub(crate) step: f64,
    /// Travel since the record began.
    pub(crate) path: f64,
}

/// What counts as a reversal.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ReversalRule {
    /// A move smaller than this against the branch is no reversal (noise on `v`).
    pub(crate) threshold: f64,
    /// Where the new branch begins.
    pub(crate) begins: Begins,
}

/// Where a new branch begins, once a travel beyond the threshold has confirmed the reversal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Begins {
    /// At the sample that confirms it.
    #[default]
    Confirmed,
    /// At the extreme that it is measured from.
    AtExtreme,
}

/// A play whose width may change along the stroke.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Play {
    /// Full width in the middle of the stroke, in strokes.
    pub(crate) width: f64,
    /// Relative change of the width from the middle to the upper end, its negative to the lower end.
    pub(crate) taper: f64,
}

impl Play {
    pub(crate) fn is_none(&self) -> bool {
        self.width == 0.0
    }

    /// The input at which the play's output passes `p` on a branch: `v = p + branch·play(v)/2`.
    pub(crate) fn input_at(&self, p: f64, branch: f64) -> f64 {
        let width = branch * self.width;
        (p + 0.5 * width * (1.0 - self.taper)) / (1.0 - width * self.taper)
    }

    /// Half the width at `v`, which runs from 0 to 1.
    fn half(&self, v: f64) -> f64 {
        0.5 * self.width * (1.0 + self.taper * (2.0 * v - 1.0)).max(0.0)
    }
}

/// Follows an input through a play.
///
/// The play's output `p` stays within half the play of `v` and moves only when pushed; the branch is the direction in which it
/// last moved. On each branch `p = v ∓ play/2`, a shift that the border tables absorb: the border coordinate stays the
/// recorded `v`. What the play leaves is the rest after each reversal.
pub(crate) fn motions(v: &[f64], play: Play, rule: ReversalRule) -> Vec<Motion> {
    v.first().map_or_else(Vec::new, |&first| followed(v, first, play, rule))
}

/// The first sample from which the motion is the same wherever in its play the operator stood when the record began.
pub(crate) fn settled(v: &[f64], play: Play, rule: ReversalRule) -> usize {
    let Some(&first) = v.first() else { return 0 };
    let half = play.half(first);
    let ends = [first - half, first + half].map(|p| followed(v, p, play, rule));
    let [mut low, mut high] = [(0.0, first); 2];
    let mut settled = 0;
    for t in 0..v.len() {
        // While the operator rests, u stays where the last move put it.
        for (known, end) in [&mut low, &mut high].into_iter().zip(&ends) {
            if end[t].moves {
                *known = (end[t].branch, v[t]);
            }
        }
        if low != high {
            settled = t + 1;
        }
    }
    settled
}

/// The motion where the play's output begins at a given place within the play of the input.
fn followed(v: &[f64], first: f64, play: Play, rule: ReversalRule) -> Vec<Motion> {
    let mut out = Vec::with_capacity(v.len());
    let mut m = Motion {
        branch: 0.0,
        moves: false,
        turn: first,
        travel: 0.0,
        reversal: false,
        loop_size: 0.0,
        since: 0,
        rest: 0,
        step: 0.0,
        path: 0.0,
    };
    let mut p = first;
    // The furthest point reached on the present branch: the next reversal is measured from here.
    let mut extreme = first;
    // When that was, and where the play's output has been since.
    let mut turned = 0;
    let mut pushed_to = vec![first];
    out.push(m);
    for t in 1..v.len() {
        let step = v[t] - v[t - 1];
        m.step = step;
        m.path += step.abs();
        let half = play.half(v[t]);
        let pushed = p.max(v[t] - half).min(v[t] + half);
        let push = pushed - p;
        p = pushed;
        pushed_to.push(p);
        m.reversal = false;
        m.moves = push != 0.0;
        if m.moves {
            let back = (extreme - p) * m.branch;
            if m.branch == 0.0 || back > rule.threshold {
                m.branch = push.signum();
                m.reversal = true;
                m.loop_size = (extreme - m.turn).abs();
                m.turn = extreme;
                let earlier = (turned + 1..t).find(|&s| out[s].moves);
                if let Some(since) = earlier.filter(|_| rule.begins == Begins::AtExtreme) {
                    m.travel = 0.0;
                    backdate(&mut out[since..], &pushed_to[since..t], &m);
                    m.reversal = false;
                }
                extreme = p;
                turned = t;
            } else if back <= 0.0 {
                extreme = p;
                turned = t;
            }
            m.travel = (p - m.turn).abs();
        }
        m.since = if m.reversal { 0 } else { m.since + 1 };
        m.rest = if step == 0.0 { m.rest + 1 } else { 0 };
        out.push(m);
    }
    out
}

/// A reversal that only a travel beyond the threshold confirmed began at the extreme: the samples since then, with the play's
/// output `p`, are on the new branch.
fn backdate(samples: &mut [Motion], p: &[f64], confirmed: &Motion) {
    for (k, (m, p)) in samples.iter_mut().zip(p).enumerate() {
        m.branch = confirmed.branch;
        m.turn = confirmed.turn;
        m.travel = (p - confirmed.turn).abs();
        m.loop_size = confirmed.loop_size;
        m.reversal = k == 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_return_inside_the_play_changes_no_branch() {
        let v = [0.0, 0.5, 0.9, 0.85, 0.95, 0.6, 0.3];
        let play = Play { width: 0.2, taper: 0.0 };
        let branches: Vec<f64> =
            motions(&v, play, ReversalRule::default()).iter().map(|m| m.branch).collect();
        assert_eq!(branches, [0.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0]);
        let moves: Vec<bool> = motions(&v, play, ReversalRule::default()).iter().map(|m| m.moves).collect();
        assert_eq!(moves, [false, true, true, false, true, true, true]);
    }

    #[test]
    fn the_output_of_a_play_passes_a_place_where_the_input_is_half_the_play_further() {
        for play in [Play { width: 0.2, taper: 0.0 }, Play { width: 0.2, taper: 0.6 }] {
            for (p, branch) in [(0.3, 1.0), (0.3, -1.0), (0.9, 1.0)] {
                let v = play.input_at(p, branch);
                assert!((v - branch * play.half(v) - p).abs() < 1e-12, "{v}");
            }
        }
    }

    #[test]
    fn a_tapered_play_is_wider_where_it_is_worn() {
        // The same return by 0.15 low and high on the stroke.
        let v = [0.0, 0.25, 0.1, 0.25, 0.9, 0.75];
        let play = Play { width: 0.14, taper: 0.5 };
        let moves: Vec<bool> = motions(&v, play, ReversalRule::default()).iter().map(|m| m.moves).collect();
        assert_eq!(moves, [false, true, true, true, true, false]);
    }

    #[test]
    fn where_a_play_stood_is_known_once_all_of_it_was_crossed() {
        let play = Play { width: 0.2, taper: 0.0 };
        let known = |v: &[f64]| settled(v, play, ReversalRule::default());
        // Rising by less than the play, then by more: what stood below was taken along from the first move on.
        assert_eq!(known(&[0.5, 0.55, 0.65, 0.75, 0.8]), 3);
        // Turning within the play shows nothing new.
        assert_eq!(known(&[0.5, 0.55, 0.5, 0.45, 0.5]), 5);
        assert_eq!(settled(&[0.5, 0.55, 0.5], Play::default(), ReversalRule::default()), 0);
        assert_eq!(known(&[]), 0);
    }

    #[test]
    fn a_reversal_above_the_threshold_begins_at_the_extreme() {
        let v = [0.0, 0.5, 1.0, 0.95, 0.97, 0.8, 0.5];
        let moves = motions(&v, Play::default(), ReversalRule { threshold: 0.1, begins: Begins::AtExtreme });
        let branches: Vec<f64> = moves.iter().map(|m| m.branch).collect();
        assert_eq!(branches, [0.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]);
        let reversals: Vec<bool> = moves.iter().map(|m| m.reversal).collect();
        assert_eq!(reversals, [false, true, false, true, false, false, false]);
        assert!((moves[6].travel - 0.5).abs() < 1e-12 && (moves[5].turn - 1.0).abs() < 1e-12);
    }

    #[test]
    fn without_play_the_branch_is_the_sign_of_the_move() {
        let v = [0.0, 0.1, 0.1, 0.05, 0.2];
        let branches: Vec<f64> =
            motions(&v, Play::default(), ReversalRule::default()).iter().map(|m| m.branch).collect();
        assert_eq!(branches, [0.0, 1.0, 1.0, -1.0, 1.0]);
    }
}
