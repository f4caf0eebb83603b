//! Which border the working point is on, read off the input alone.

use crate::hysteresis::Branch;

/// The branch of every sample of an input.
///
/// A reversal counts only once `v` has moved back from its extremum by more than the threshold (a turning-point, or
/// zigzag, rule), and then takes effect *retroactively*: every sample after the turning sample is on the new
/// branch. The turning sample is the last one within half a threshold of the extremum, so that the whole of a noisy rest at an
/// extremum stays on the border it was reached on, as (2.3) has it. The rule looks ahead, which is no
/// obstacle: the input of a record, or of a simulation, is known as a whole. A causal rule would put the samples between the
/// turn and its confirmation on the wrong border.
///
/// With threshold 0 this is exactly (2.3): rising, falling, and holding at a rest.
///
/// ```
/// use switchback_estimator::estimators::free::Branches;
/// use switchback_estimator::hysteresis::Branch::{Ascending, Descending};
/// // The dip of 0.1 is sensor noise for a threshold of 0.3; the fall from 2 to 1 is a reversal.
/// let branches = Branches::of(&[0.0, 1.0, 0.9, 2.0, 1.0], 0.3).unwrap();
/// assert_eq!(branches.labels(), [Ascending, Ascending, Ascending, Ascending, Descending]);
/// assert_eq!(branches.first_known(), 1);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Branches {
    labels: Vec<Branch>,
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
    /// The threshold is in input units and not negative.
    pub fn of(v: &[f64], threshold: f64) -> Option<Self> {
        let band = threshold / 2.0;
        let (mut high, mut low) =
            (Extremum { value: *v.first()?, turn: 0 }, Extremum { value: v[0], turn: 0 });
        let mut direction = None;
        let mut labels = Vec::with_capacity(v.len());
        let (mut first_known, mut reversals) = (0, 0);
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
            if let Some((branch, turn)) = turned {
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
        direction.map(|_| Self { labels, first_known, reversals })
    }

    /// One branch a sample. Samples before the first move get the branch of that move.
    pub fn labels(&self) -> &[Branch] {
        &self.labels
    }

    /// First sample whose branch the input tells; before it `u` depends on what the rig did earlier.
    pub fn first_known(&self) -> usize {
        self.first_known
    }

    /// Number of reversals after the first move.
    pub fn reversals(&self) -> usize {
        self.reversals
    }
}

/// What the sensor of `v` adds to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorNoise {
    /// Standard deviation of the noise, input units; zero where none was found.
    pub sd: f64,
    /// Step of the value lattice, input units; zero where there is none, or where it is so coarse that the
    /// values must be the levels of a designed experiment.
    pub step: f64,
}

/// Multiples of the noise sd that a move must exceed to count as a reversal. The difference of two samples has sd
/// √2 σ, and a rest of 10⁴ samples offers some 10⁴ independent pairs: 6σ is 4.2 of those sds, about one false reversal in
/// 10⁵ samples at rest, and none on a slope.
const THRESHOLD_IN_SD: f64 = 6.0;

impl SensorNoise {
    /// Estimates the noise from the highest frequencies of `v`.
    ///
    /// Differences of order `k` cancel a smooth motion and leave white noise of variance `C(2k, k) σ²` with
    /// correlation `−k/(k+1)` between neighbours. The lowest order whose differences show that correlation gives `σ` (by the median, so
    /// that the kinks at reversals do not count). A random walk never shows it. Levels drawn at random do, but their
    /// "noise" is as large as the signal: more than 2 % of the range is taken as motion, not noise.
    pub fn of(v: &[f64]) -> Self {
        let (low, high) =
            v.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        let range = high - low;
        let step = lattice_step(v).filter(|&s| s < range / 200.0).unwrap_or(0.0);
        let sd = (2..=4).find_map(|k| white_sd(v, k)).filter(|&sd| sd < 0.02 * range).unwrap_or(0.0);
        Self { sd, step }
    }

    /// The reversal threshold that goes with it: six noise sds, and more than one step of the lattice.
    pub fn threshold(&self) -> f64 {
        (THRESHOLD_IN_SD * self.sd).max(if self.step > 0.0 && self.sd > 0.0 { 1.5 * self.step } else { 0.0 })
    }
}

/// Noise sd from differences of order `k`, if these look like differenced white noise.
fn white_sd(v: &[f64], k: usize) -> Option<f64> {
    if v.len() < 50 {
        return None;
    }
    let mut d = v.to_vec();
    for _ in 0..k {
        d = d.windows(2).map(|w| w[1] - w[0]).collect();
    }
    let mut size: Vec<f64> = d.iter().map(|x| x.abs()).collect();
    size.sort_by(f64::total_cmp);
    let sd = size[size.len() / 2] / 0.6745;
    let clipped: Vec<f64> = d.iter().map(|x| x.clamp(-4.0 * sd, 4.0 * sd)).collect();
    let power: f64 = clipped.iter().map(|x| x * x).sum();
    let neighbours: f64 = clipped.windows(2).map(|w| w[0] * w[1]).sum();
    let order = k as f64;
    let white = -order / (order + 1.0);
    let looks_white = power > 0.0 && neighbours / power < white + 0.35 / (order * (order + 1.0));
    // C(2k, k), the variance of a k-th difference of unit white noise.
    let gain: f64 = (1..=k).map(|i| (k + i) as f64 / i as f64).product();
    looks_white.then(|| sd / gain.sqrt())
}

/// Smallest step of the lattice that all values lie on, if there is one.
fn lattice_step(v: &[f64]) -> Option<f64> {
    let mut sorted = v.to_vec();
    sorted.sort_by(f64::total_cmp);
    let range = sorted[sorted.len() - 1] - sorted[0];
    let gaps: Vec<f64> = sorted.windows(2).map(|w| w[1] - w[0]).filter(|&g| g > 1e-9 * range).collect();
    let step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    // Fewer distinct values than half the samples, and every gap a whole number of steps.
    let regular = gaps.iter().all(|g| ((g / step).round() - g / step).abs() < 0.05);
    (step.is_finite() && gaps.len() * 2 < v.len() && regular).then_some(step)
}
