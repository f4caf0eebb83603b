//! What a causal model is made of, in the order in which a sample passes through it.

/// A causal model.
///
/// ```text
/// v → scale → (late) → direction, play → borders and effects → gain → 1/poles → B/A → sensor → scale → y
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// From the input's units.
    pub input: Scale,
    /// Back to the output's units.
    pub output: Scale,
    /// What acts lies between the last two positions, this share of a sample back.
    pub late: f64,
    /// How the direction of the input is determined.
    pub direction: Direction,
    /// What the working point runs on.
    pub borders: Borders,
    /// What happens between the borders.
    pub effects: Effects,
    /// The linear part.
    pub linear: Linear,
    /// What reads the output.
    pub sensor: Sensor,
}

/// `x ↦ (x − origin)/size`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// What becomes zero.
    pub origin: f64,
    /// What becomes one.
    pub size: f64,
    /// Rounded to multiples of this afterwards, where there is one.
    pub grid: Option<f64>,
}

impl Scale {
    /// Nothing changes.
    pub const NONE: Self = Self { origin: 0.0, size: 1.0, grid: None };

    pub(crate) fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

/// How the direction of the input is determined, and where a run begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Direction {
    /// A run begins on the border of its first move: known once the input has moved by more than the threshold.
    FirstMove {
        /// A move back by no more is no reversal.
        threshold: f64,
        /// A reversal falls between samples: the turning sample is shared between the borders, as the sample after it shows.
        between_samples: bool,
    },
    /// A run begins where the place of its first input shows.
    Place {
        /// A move back by no more is no reversal.
        threshold: f64,
        /// Play before the operator: its width in the middle of the stroke and how that changes towards the ends.
        play: Play,
        /// Whether it begins midway between the borders, instead of on that whose end is nearer.
        between_borders: bool,
    },
}

/// A play whose full width is `width·(1 + taper·(2v − 1))`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Play {
    /// Full width in the middle of the stroke.
    pub width: f64,
    /// Relative change of it from there to the upper end.
    pub taper: f64,
}

/// A curve of `v`.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// `v`, not falling; one that stands twice is a jump.
    pub knots: Vec<f64>,
    /// `u` there.
    pub values: Vec<f64>,
    /// What holds beyond the ends.
    pub beyond: Beyond,
}

/// What holds beyond the ends of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beyond {
    /// The values at the ends.
    Holds,
    /// The straight line between the only two knots.
    GoesOn,
    /// Nothing is known of it further away than this from the only knot.
    Unknown(f64),
}

/// What the working point runs on.
#[derive(Debug, Clone, PartialEq)]
pub enum Borders {
    /// One curve for both directions.
    One(Curve),
    /// Two borders.
    Two {
        /// Where the input falls.
        descending: Curve,
        /// Where it rises.
        ascending: Curve,
    },
}

impl Borders {
    /// The values of all knots, descending before ascending.
    pub(crate) fn values(&self) -> Vec<f64> {
        match self {
            Self::One(curve) => curve.values.clone(),
            Self::Two { descending, ascending } => [&descending.values[..], &ascending.values].concat(),
        }
    }
}

/// What happens between the borders. All lengths are in the scaled input, all times in samples.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Effects {
    /// Standard deviation of noise on the position that acts: a mean over both borders.
    pub jitter: f64,
    /// How the working point passes from one border to the other.
    pub transition: Option<Transition>,
    /// Share by which the loop is narrower.
    pub narrowing: f64,
    /// How the loop widens with the speed.
    pub widening: Option<Widening>,
    /// How the working point goes towards the middle while the input rests.
    pub relaxation: Option<Relaxation>,
    /// What is added to `u`, with its coefficient.
    pub columns: Vec<(Column, f64)>,
    /// Whether records that the model was fitted to had a start of their own.
    pub had_starts: bool,
    /// Relative change of the gain.
    pub gain: f64,
}

/// A transition with the envelope `φ(x) = exp(−(x/length)^shape)` of the travel `x` since the reversal; nothing is left of it beyond `reach`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    /// Its length.
    pub length: f64,
    /// Its shape.
    pub shape: f64,
    /// Travel beyond which it is over.
    pub reach: f64,
    /// What fades.
    pub law: TransitionLaw,
}

/// What fades.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TransitionLaw {
    /// The distance to the border at the reversal.
    Offset,
    /// The value at the reversal.
    Held,
    /// The other border.
    Crossing,
}

/// A loop wider by the share `share·g(r)` at the speed `r` a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Widening {
    /// Its share.
    pub share: f64,
    /// Its power.
    pub power: f64,
    /// The speed that is one.
    pub scale: f64,
    /// `g = (r/scale)^power` if so, else `exp(−(r/scale)^power)`.
    pub at_high_speeds: bool,
}

/// Towards the middle by the share `share·(1 − e^(−rest/tau))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// Its share.
    pub share: f64,
    /// Its time constant.
    pub tau: f64,
}

/// What is added to `u`, times its coefficient; `branch` is +1 or −1, `r` the speed a sample over `scale`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Column {
    /// `branch·r^power`; at rest its last value, or nothing.
    Speed {
        /// Its power.
        power: f64,
        /// The speed that is one.
        scale: f64,
        /// Whether it keeps its value at rest.
        held: bool,
    },
    /// `branch·exp(−r^power)`; at rest its last value, or `branch`.
    LowSpeed {
        /// Its power.
        power: f64,
        /// The speed that is one.
        scale: f64,
        /// Whether it keeps its value at rest.
        held: bool,
    },
    /// A bristle that bends towards `branch·exp(−r^power)` along a travel.
    Bristle {
        /// Its power.
        power: f64,
        /// The speed that is one.
        scale: f64,
        /// The travel.
        length: f64,
    },
    /// `branch·ln(1 + rest/scale)`.
    RestingLog {
        /// The time that is one.
        scale: f64,
    },
    /// `branch·(1 − e^(−rest/scale))`.
    RestingRise {
        /// The time that is one.
        scale: f64,
    },
    /// `branch·ln(1 + t/scale)`, `t` since the last reversal.
    ReversalLog {
        /// The time that is one.
        scale: f64,
    },
    /// `branch·at`.
    Branch {
        /// A constant.
        at: f64,
    },
    /// `at` on one branch, nothing on the other.
    Side {
        /// A constant.
        at: f64,
        /// The branch.
        branch: f64,
    },
}

/// `A(q⁻¹) y(t) = Σᵢ bᵢ ũ(t−lag−i) + c`, i from 0, `ũ(t) = u(t) − Σ pₖ ũ(t−k)`, k from 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Linear {
    /// `p`.
    pub poles: Vec<f64>,
    /// `a`.
    pub a: Vec<f64>,
    /// `b`.
    pub b: Vec<f64>,
    /// Samples from an input to the output that it first moves.
    pub lag: usize,
    /// `c`.
    pub constant: f64,
    /// `y` stays within ± this.
    pub limit: Option<f64>,
}

/// A sensor's characteristic by its inverse, powers, bumps and knees; then cubic; then its range.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sensor {
    /// Coefficients of `y²`, `y³`, … of the inverse.
    pub powers: Vec<f64>,
    /// Evenly spaced bumps of the inverse.
    pub bumps: Option<Bumps>,
    /// Soft ends of the inverse.
    pub knees: Vec<Knee>,
    /// A cubic of the true value.
    pub cubic: Option<Cubic>,
    /// The range.
    pub range: Option<[f64; 2]>,
}

/// `Σ hⱼ exp(−zⱼ²/2)`, `zⱼ = (y − first)/spacing − j`.
#[derive(Debug, Clone, PartialEq)]
pub struct Bumps {
    /// Where the first one is.
    pub first: f64,
    /// From one to the next.
    pub spacing: f64,
    /// Their heights.
    pub heights: Vec<f64>,
}

/// `sign·width·(e^z − 1 − z)` beyond a level, `z` the excess over the width; straight on beyond `z = steepest`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knee {
    /// Where it begins.
    pub level: f64,
    /// Its width.
    pub width: f64,
    /// +1 at the upper end, −1 at the lower.
    pub sign: f64,
    /// Where it goes on straight.
    pub steepest: f64,
}

/// `z + square·z² + cube·z³` within a range, straight on with at least the slope `flattest` beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// Of `z²`.
    pub square: f64,
    /// Of `z³`.
    pub cube: f64,
    /// Where it is a polynomial.
    pub range: [f64; 2],
    /// Least slope.
    pub flattest: f64,
}
