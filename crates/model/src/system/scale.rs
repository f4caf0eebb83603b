//! Sizes by which laws choose their starts.

use super::linear_part::LinearPart;
use super::motion::Motion;
use crate::reversal::ReversalRule;

/// Typical sizes in a dataset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Range of the input.
    pub travel: f64,
    /// Median move, input units a sample.
    pub speed: f64,
    /// Root mean square of the second difference of the input.
    pub acceleration: f64,
    /// Mean of the output.
    pub level: f64,
    /// Standard deviation of the output.
    pub output: f64,
    /// Ends of the output.
    pub ends: (f64, f64),
    /// Samples in the longest record.
    pub samples: usize,
    /// Records.
    pub records: usize,
    /// Time constant of the slowest pole, samples.
    pub settling: f64,
}

impl Scale {
    /// The sizes of records, `(v, y)` each, behind a linear part.
    pub fn of(linear: &LinearPart, rule: ReversalRule, records: &[(&[f64], &[f64])]) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut ends, mut sum, mut square, mut count) = ((low, high), 0.0, 0.0, 0.0);
        let (mut moves, mut bends) = (Vec::new(), 0.0);
        for (v, y) in records {
            for v in *v {
                (low, high) = (low.min(*v), high.max(*v));
            }
            for y in *y {
                ends = (ends.0.min(*y), ends.1.max(*y));
                sum += y;
                square += y * y;
                count += 1.0;
            }
            let motion = Motion::of(v, rule);
            moves.extend(motion.moved.iter().copied().filter(|m| *m > 0.0));
            bends += v.windows(3).map(|v| (v[2] - 2.0 * v[1] + v[0]).powi(2)).sum::<f64>();
        }
        let count = f64::max(count, 1.0);
        let middle = moves.len() / 2;
        let speed =
            if moves.is_empty() { 1.0 } else { *moves.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let radius = crate::linear::spectral_radius(linear.a()).min(1.0 - 1e-9);
        Self {
            travel: high - low,
            speed,
            acceleration: (bends / count).sqrt().max(f64::MIN_POSITIVE),
            level: sum / count,
            output: (square / count - (sum / count).powi(2)).max(0.0).sqrt(),
            ends,
            samples: records.iter().map(|(v, _)| v.len()).max().unwrap_or(0),
            records: records.len(),
            settling: if radius > 0.0 { (-1.0 / radius.ln()).max(0.5) } else { 0.5 },
        }
    }
}
