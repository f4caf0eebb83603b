//! A composition of effects as plain data: what the fit and the simulation both interpret.
//!
//! ```text
//! v → delay → play → borders (transition, wear, widening, relaxation) + border columns → gain → num/den → B/A → + disturbances → sensor → y
//! ```

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::infinite;
use crate::model::sensor::SensorCurve;
use crate::records::motion::Play;

/// How the working point passes from one border to the other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Transition {
    /// Travel over which it passes, in strokes.
    pub(crate) length: f64,
    /// Shape `s` of the envelope `φ(x) = exp(−(x/length)^s)`.
    pub(crate) shape: f64,
    /// What fades.
    pub(crate) law: TransitionLaw,
}

impl Transition {
    /// The travel beyond which the envelope is below `least`, and a little more.
    pub(crate) fn reach(&self, least: f64) -> f64 {
        1.001 * self.length * (-least.ln()).powf(1.0 / self.shape)
    }
}

/// What fades during a transition with envelope `φ`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum TransitionLaw {
    /// `u = C(v) + φ·(u_rev − C(v_rev))`: the distance to the border at the reversal fades.
    Offset,
    /// `u = (1−φ)·C(v) + φ·u_rev`: the value at the reversal fades.
    Held,
    /// `u = (1−φ)·C(v) + φ·C_old(v)`: the other border fades.
    Crossing,
}

/// A clock that slow changes follow, from 0 to about 1 where nothing else is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Clock {
    /// Share of the samples of the whole dataset.
    #[serde(rename = "campaign")]
    Dataset,
    /// Samples of the whole dataset, not scaled.
    Samples,
    /// Samples of each record anew.
    Record,
    /// Travel of the whole dataset.
    Travel,
    /// Share of the records that are over: between them time passes too, and nobody records how much.
    Pauses,
}

/// A slow change `Σ_k c_k·s_k(t)` of a clock.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Slow {
    /// What it follows.
    pub(crate) clock: Clock,
    /// Coefficients of the shifted Legendre polynomials of degree 1, 2, … of the clock.
    pub(crate) coefficients: Vec<f64>,
    /// Angular rate over the clock and phase of an added sinusoid, `(rate, sine, cosine)`.
    pub(crate) wave: Option<(f64, f64, f64)>,
    /// Clock and change where a drift path that is straight in between bends, clock increasing; beyond the ends it stays.
    pub(crate) bends: Vec<(f64, f64)>,
}

impl NoiseLaw {
    /// Samples back that whitening reaches, all of them where it is recursive.
    pub(crate) fn reach(&self) -> usize {
        match self.ma.is_empty() && self.output_ratio == 0.0 {
            true => self.ar.len(),
            false => usize::MAX,
        }
    }
}

impl Slow {
    /// No change, following a clock.
    pub(crate) fn on(clock: Clock) -> Self {
        Self { clock, coefficients: Vec::new(), wave: None, bends: Vec::new() }
    }

    /// Whether it is more than nothing.
    pub(crate) fn changes(&self) -> bool {
        let waves = self.wave.is_some_and(|(_, sine, cosine)| sine != 0.0 || cosine != 0.0);
        waves || self.coefficients.iter().any(|c| *c != 0.0) || self.bends.iter().any(|b| b.1 != 0.0)
    }

    /// The change at clock `s`.
    pub(crate) fn at(&self, s: f64) -> f64 {
        let x = 2.0 * s - 1.0;
        let basis = [x + 1.0, x * x - 1.0, x * x * x - x];
        let mut sum: f64 = self.coefficients.iter().zip(basis).map(|(c, b)| c * b).sum();
        if let Some((rate, sine, cosine)) = self.wave {
            sum += sine * (rate * s).sin() + cosine * ((rate * s).cos() - 1.0);
        }
        sum + self.drift_path(s)
    }

    fn drift_path(&self, s: f64) -> f64 {
        let after = self.bends.partition_point(|bend| bend.0 <= s);
        match (after.checked_sub(1).map(|last| self.bends[last]), self.bends.get(after)) {
            (Some((from, start)), Some((to, end))) => start + (end - start) * (s - from) / (to - from),
            (Some((_, value)), None) | (None, Some(&(_, value))) => value,
            (None, None) => 0.0,
        }
    }
}

/// A loop whose width depends on the speed `r` of the input, in strokes per sample: it is wider by the share `share·g(r)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Widening {
    /// Share by which the loop is wider.
    pub(crate) share: f64,
    /// Power of the speed.
    pub(crate) power: f64,
    /// Scale of the speed, strokes per sample.
    pub(crate) scale: f64,
    /// At which speeds it is wide.
    pub(crate) speeds: Speeds,
}

/// At which speeds a loop is wide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Speeds {
    /// `g = (r/scale)^power`.
    High,
    /// `g = exp(−(r/scale)^power)`.
    Low,
}

impl Widening {
    pub(crate) fn at(&self, speed: f64) -> f64 {
        let relative = (speed / self.scale).powf(self.power);
        match self.speeds {
            Speeds::High => self.share * relative,
            Speeds::Low => self.share * (-relative).exp(),
        }
    }
}

/// A working point that goes towards the middle between the borders while the input rests: by the share
/// `share·(1 − e^(−rest/tau))` of its distance, `rest` in samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Relaxation {
    /// Share of the distance that is lost in the end.
    pub(crate) share: f64,
    /// Time constant, samples.
    pub(crate) tau: f64,
}

impl Relaxation {
    pub(crate) fn after(&self, rest: usize) -> f64 {
        self.share * (1.0 - (-(rest as f64) / self.tau).exp())
    }
}

/// A column beside the border values: its coefficient is estimated with them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum BorderColumn {
    /// `branch·r^power`, `r` the speed in strokes per sample over `scale`.
    Speed { power: f64, scale: f64, while_resting: Resting },
    /// `branch·exp(−(r/scale)^power)`.
    LowSpeed { power: f64, scale: f64, while_resting: Resting },
    /// A bristle that bends towards `branch·exp(−(r/scale)^power)` along a travel of `length` strokes.
    Bristle { power: f64, scale: f64, length: f64 },
    /// `branch·ln(1 + rest/scale)` while the input rests.
    RestingLog { scale: f64 },
    /// `branch·(1 − e^(−rest/scale))`, an after-effect that ends, while the input rests.
    RestingRise { scale: f64 },
    /// `branch·ln(1 + t/scale)`, `t` the time since the last reversal.
    ReversalLog { scale: f64 },
    /// `branch·s(clock)`.
    BranchSlow { clock: Clock },
    /// What `u` differs at the start of one record from the middle between the borders; it fades as the transition does.
    Start {
        #[serde(rename = "track")]
        scaled: usize,
    },
    /// `s(clock)` on the ascending (+1) or the descending (−1) border, 0 on the other.
    SideSlow { clock: Clock, branch: f64 },
}

/// What a speed-dependent term does while the input rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Resting {
    /// It keeps its last value, as `u` does.
    Held,
    /// It takes its value at speed zero.
    Zero,
}

/// A disturbance column of the equation, `A y = B u + Σ d·ψ`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum EquationColumn {
    /// Cosine and sine at a frequency (radians per sample) on one record, or on all with the dataset's clock.
    Line {
        frequency: f64,
        #[serde(rename = "track")]
        scaled: Option<usize>,
        sine: bool,
    },
    /// A polynomial of a clock, of the given degree.
    Trend { clock: Clock, degree: usize },
    /// The change of the gain itself: what it does to a part of `u` that the borders do not show, because the output's zero is unknown.
    Gain,
    /// `radiusᵗ cos(frequency·t)` (or sine) on one record: the unknown initial state of a slow filter.
    Decay {
        #[serde(rename = "track")]
        scaled: usize,
        radius: f64,
        frequency: f64,
        sine: bool,
    },
    /// A bump function of a record: linear interpolation between `pieces` equal pieces.
    Local {
        #[serde(rename = "track")]
        scaled: usize,
        piece: usize,
        pieces: usize,
    },
    /// A constant: 1 on one record and −1 on the one it is reported against, if any.
    Offset {
        #[serde(rename = "track")]
        scaled: usize,
        against: Option<usize>,
    },
}

impl EquationColumn {
    /// Whether it is more than zeros on a record.
    pub(crate) fn acts_on(&self, number: usize) -> bool {
        match self {
            Self::Line { scaled: Some(only), .. }
            | Self::Decay { scaled: only, .. }
            | Self::Local { scaled: only, .. } => *only == number,
            Self::Offset { scaled, against } => *scaled == number || *against == Some(number),
            Self::Line { scaled: None, .. } | Self::Trend { .. } | Self::Gain => true,
        }
    }
}

/// The sensor's range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Saturation {
    /// Its lower end.
    #[serde(with = "infinite")]
    #[schemars(with = "infinite::Either")]
    pub(crate) low: f64,
    /// Its upper end.
    #[serde(with = "infinite")]
    #[schemars(with = "infinite::Either")]
    pub(crate) high: f64,
    /// Order of the equation.
    pub(crate) order: usize,
}

/// Noise on the input that acts: its variance over that of the equation error.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct InputNoise {
    /// What comes by the slope of the borders.
    pub(crate) by_slope: f64,
    /// What comes by the distance between them, where noise switches the operator.
    pub(crate) by_gap: f64,
    /// What is added to `u` itself.
    pub(crate) direct: f64,
    /// Whether a miss is kept until the next move.
    pub(crate) kept: bool,
}

/// The law of the equation error.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoiseLaw {
    /// `D(q⁻¹) e = w`: coefficients d₁, d₂, ….
    pub(crate) ar: Vec<f64>,
    /// Moving average `e = C(q⁻¹) w`: coefficients c₁, c₂, ….
    pub(crate) ma: Vec<f64>,
    /// Variance of white output noise over that of the equation error.
    pub(crate) output_ratio: f64,
    /// Noise on the input.
    pub(crate) input: Option<InputNoise>,
    /// Step of the quantisation grid that the sensor rounds to; its noise is part of `output_ratio`.
    /// Saved models know it as `lattice`.
    #[serde(rename = "lattice")]
    pub(crate) quantisation: Option<f64>,
    /// Share and standard deviation ratio of the wide component of a normal mixture.
    pub(crate) mixture: Option<(f64, f64)>,
}

/// A variance of innovations below which there is nothing.
pub(crate) const LEAST_VARIANCE: f64 = 1e-300;

impl NoiseLaw {
    /// Least variance of one component of a mixture: that of rounding to steps of `q`, `q²/12`, where the sensor does. At rest
    /// rounded readings repeat, and a narrow normal distribution over repeated values would be worth any deviance.
    pub(crate) fn least_variance(&self) -> f64 {
        self.quantisation.map_or(LEAST_VARIANCE, |step| step * step / 12.0)
    }
}

/// A composition of effects.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AugmentedModel {
    /// Coefficients of B beyond the nominal order.
    pub(crate) extra_b: usize,
    /// Delay of the input, samples.
    pub(crate) delay: f64,
    /// Standard deviation of noise on the position that acts, strokes; the branch follows the sign of the noisy moves.
    pub(crate) jitter: f64,
    /// What acts lies between the last two positions, this share of a sample back.
    pub(crate) late: f64,
    /// Play between the input and the operator.
    pub(crate) play: Play,
    /// How the working point passes from one border to the other.
    pub(crate) transition: Option<Transition>,
    /// Narrowing of the loop.
    pub(crate) wear: Option<Slow>,
    /// How the loop widens with the speed.
    pub(crate) widening: Option<Widening>,
    /// What a rest does.
    pub(crate) relaxation: Option<Relaxation>,
    /// Columns beside the border values.
    pub(crate) border_columns: Vec<BorderColumn>,
    /// Relative change of the gain.
    pub(crate) gain: Option<Slow>,
    /// Numerator of the filter between `u` and `B/A`, leading one included.
    pub(crate) numerator: Vec<f64>,
    /// Its denominator.
    pub(crate) denominator: Vec<f64>,
    /// Columns of the equation: disturbances.
    pub(crate) equation_columns: Vec<EquationColumn>,
    /// The inverse of the sensor's characteristic.
    pub(crate) curve: SensorCurve,
    /// The range of the sensor.
    pub(crate) saturation: Option<Saturation>,
    /// The law of the equation error.
    pub(crate) noise: NoiseLaw,
}

impl AugmentedModel {
    /// Puts a filter in series with those present.
    pub(crate) fn filter(&mut self, numerator: &[f64], denominator: &[f64]) {
        self.numerator = convolve(&leading_one(&self.numerator), numerator);
        self.denominator = convolve(&leading_one(&self.denominator), denominator);
    }

    /// Gain at rest of the filter in series.
    pub(crate) fn static_gain(&self) -> f64 {
        let at_rest = |coefficients: &[f64]| leading_one(coefficients).iter().sum::<f64>();
        at_rest(&self.numerator) / at_rest(&self.denominator)
    }
}

/// A polynomial in `q⁻¹`, one where it is empty.
pub(super) fn leading_one(filter: &[f64]) -> Vec<f64> {
    if filter.is_empty() { vec![1.0] } else { filter.to_vec() }
}

/// Product of two polynomials in `q⁻¹`.
pub(crate) fn convolve(a: &[f64], b: &[f64]) -> Vec<f64> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}

/// Coefficients beyond the leading one of the product of two monic polynomials given without it.
pub(crate) fn times_monic(a: &[f64], b: &[f64]) -> Vec<f64> {
    let monic = |x: &[f64]| std::iter::once(1.0).chain(x.iter().copied()).collect::<Vec<f64>>();
    convolve(&monic(a), &monic(b)).split_off(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_is_straight_between_its_bends_and_stays_beyond() {
        let drift_path =
            Slow { bends: vec![(10.0, 0.0), (20.0, 1.0), (21.0, -1.0)], ..Slow::on(Clock::Samples) };
        let at = [0.0, 10.0, 15.0, 20.0, 20.5, 21.0, 99.0].map(|s| drift_path.at(s));
        assert_eq!(at, [0.0, 0.0, 0.5, 1.0, 0.0, -1.0, -1.0]);
        assert!(drift_path.changes() && !Slow::on(Clock::Samples).changes());
    }

    #[test]
    fn the_static_gain_is_where_a_step_ends() {
        let mut augmented = AugmentedModel::default();
        assert!((augmented.static_gain() - 1.0).abs() < 1e-12);
        augmented.filter(&[0.5, 0.3], &[1.0, -0.8]);
        augmented.filter(&[1.0], &[1.0, 0.0, 0.25]);
        // The oracle: the response to a step, long after it.
        let past = |x: &[f64], t: usize, lag: usize| if t < lag { 0.0 } else { x[t - lag] };
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for t in 0..400 {
            let feed = 0.5 + if t > 0 { 0.3 } else { 0.0 };
            first.push(feed + 0.8 * past(&first, t, 1));
            second.push(first[t] - 0.25 * past(&second, t, 2));
        }
        assert!((augmented.static_gain() - second[399]).abs() < 1e-9, "{}", second[399]);
    }
}
