//! Where each sample lies: in the motion, on the borders, in the records.

use super::context::{Context, Signal};
use switchback_model::system::Motion;

/// One entry a sample, records joined.
#[derive(Default)]
pub(super) struct Setting {
    /// Number of the record.
    pub(super) record: Vec<usize>,
    /// Share of the dataset that is over.
    pub(super) clock: Vec<f64>,
    /// Direction of motion, with the sign of the loop's width.
    pub(super) branch: Vec<f64>,
    /// Travel since the reversal over the range of the input.
    pub(super) travel: Vec<f64>,
    /// Samples since the reversal.
    pub(super) since: Vec<f64>,
    /// Samples of rest.
    pub(super) rest: Vec<f64>,
    /// Speed over its median.
    pub(super) speed: Vec<f64>,
    /// Position, from 0 to 1 over the range.
    pub(super) position: Vec<f64>,
    /// Run, from 0 to 1 between its quantiles of 1 and 99 %.
    pub(super) level: Vec<f64>,
    /// Signals that a variance may follow.
    pub(super) follows: Vec<(&'static str, Vec<f64>)>,
    /// The working point, its half width with the loop's sign, and the slope of the border it is on.
    pub(super) u: Vec<f64>,
    pub(super) half: Vec<f64>,
    pub(super) slope: Vec<f64>,
    /// Move of the working point.
    pub(super) move_of_u: Vec<f64>,
    /// Share of all travel that is over.
    pub(super) travelled: Vec<f64>,
    /// First sample of each record, and the end.
    pub(super) starts: Vec<usize>,
}

/// Largest speed that counts, in medians.
const FASTEST: f64 = 12.0;

impl Setting {
    pub(super) fn of(context: &Context<'_>, runs: &Signal) -> Self {
        let base = context.base;
        let (low, high) = base.borders.range();
        let range = context.scale.travel.max(f64::MIN_POSITIVE);
        let tiny = 1e-4 * range;
        let mut out = Self { starts: vec![0], ..Self::default() };
        let (mut half_sum, mut path) = (0.0, 0.0);
        for (k, stretch) in context.stretches.iter().enumerate() {
            let motion = Motion::of(&stretch.v, base.rule);
            let (mut travel, mut before) = (0.0, f64::NAN);
            for (t, v) in stretch.v.iter().enumerate() {
                travel = if motion.since[t] == 0.0 { 0.0 } else { travel + motion.moved[t] };
                let (mean, half) = base.borders.at(*v);
                let ahead = base.borders.at(v + tiny);
                let behind = base.borders.at(v - tiny);
                let d = motion.direction[t];
                let u = mean + d * half;
                half_sum += half;
                path += motion.moved[t];
                out.travelled.push(path);
                out.half.push(half);
                out.slope.push(((ahead.0 + d * ahead.1) - (behind.0 + d * behind.1)) / (2.0 * tiny));
                out.move_of_u.push(if before.is_nan() { 0.0 } else { u - before });
                before = u;
                out.u.push(u);
                out.record.push(k);
                out.clock.push(stretch.span.clock(t));
                out.branch.push(d);
                out.travel.push(travel / range);
                out.since.push(motion.since[t]);
                out.rest.push(motion.rest[t]);
                out.speed.push((motion.speed[t] / context.scale.speed).min(FASTEST));
                out.position.push(((v - low) / (high - low)).clamp(0.0, 1.0));
            }
            out.starts.push(out.record.len());
        }
        let sign = if half_sum < 0.0 { -1.0 } else { 1.0 };
        out.branch.iter_mut().for_each(|b| *b *= sign);
        out.half.iter_mut().for_each(|h| *h *= sign);
        out.travelled.iter_mut().for_each(|x| *x /= path.max(f64::MIN_POSITIVE));
        let all: Vec<f64> = runs.iter().flatten().copied().collect();
        let (bottom, top) = (quantile(&all, 0.01), quantile(&all, 0.99));
        out.level = all
            .iter()
            .map(|y| ((y - bottom) / (top - bottom).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0))
            .collect();
        let slopes: Vec<f64> = out.slope.iter().map(|s| s * s).collect();
        let most = quantile(&slopes, 0.98);
        let slopes: Vec<f64> = slopes.into_iter().map(|s| s.min(most)).collect();
        let moving: Vec<f64> = out.rest.iter().map(|r| f64::from(u8::from(*r == 0.0))).collect();
        let mean = out.u.iter().sum::<f64>() / out.u.len().max(1) as f64;
        out.follows = vec![
            ("slope_while_moving", slopes.iter().zip(&moving).map(|(s, m)| s * m).collect()),
            ("slope", slopes),
            ("moving", moving),
            ("width", out.half.iter().map(|h| h * h).collect()),
            ("reversal", out.since.iter().map(|s| f64::from(u8::from(*s < 3.0))).collect()),
            ("level", out.level.clone()),
            ("extremes", out.level.iter().map(|l| (l - 0.5).powi(2)).collect()),
            ("speed", out.speed.iter().map(|s| s.min(5.0)).collect()),
            ("size", out.u.iter().map(|u| (u - mean).powi(2)).collect()),
            ("jumps", out.move_of_u.iter().map(|d| d * d).collect()),
        ];
        out
    }
}

/// The standard deviation of the normal distribution with this median of absolute values.
pub(super) fn spread(values: impl Iterator<Item = f64>) -> f64 {
    const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;
    quantile(&values.map(f64::abs).collect::<Vec<_>>(), 0.5) / MEDIAN_OF_NORMAL
}

/// A sample quantile, not interpolated.
pub(super) fn quantile(values: &[f64], level: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let mut values = values.to_vec();
    let k = ((values.len() - 1) as f64 * level).round() as usize;
    *values.select_nth_unstable_by(k, f64::total_cmp).1
}
