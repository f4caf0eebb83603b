//! Sensor noise on the input, and the reversal threshold that it calls for.

/// What the sensor of `v` adds to it, and what a move must exceed to count as a reversal.
///
/// Two independent looks, since neither sees everything:
///
/// - *Small reversals set apart.* Every pair of turning points that closes a loop inside a larger one (rainflow pairs) has a
///   size; the reversals left at a threshold are those of the larger pairs. Noise, and the steps of a converter, make
///   many pairs far smaller than any motion: if at least fifteen pairs of less than 2 % of the range are followed by a gap of a
///   factor of four, the threshold lies in the gap, at twice the largest of them. In a smooth motion two turning points `τ` apart are `s ∝ τ³` apart
///   in height, with `τ` uniform near zero: such a gap above the `n` smallest has probability `4^(−n/3)`, `10⁻³` at fifteen.
/// - *High frequencies.* Differences of order `k` cancel a smooth motion and leave white noise of variance
///   `C(2k, k) σ²` with correlation `−k/(k+1)` between neighbours; the lowest order that shows this correlation gives `σ` (by
///   the median, so that the kinks at reversals do not count). A random walk never shows it; levels drawn at random
///   do, but then the "noise" exceeds 2 % of the range and is taken as motion. The threshold is `6σ`.
///
/// ```
/// use switchback_model::reversal::SensorNoise;
/// // Levels of a designed experiment are motion, not noise.
/// let levels: Vec<f64> = (0..200).map(|t| f64::from(t * 7 % 16)).collect();
/// assert_eq!(SensorNoise::of(&levels).threshold, 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorNoise {
    /// Standard deviation of white noise at high frequencies, input units; zero where none was found.
    pub sd: f64,
    /// Largest pair of turning points taken as noise, input units; zero where none was found.
    pub small_pairs: f64,
    /// Reversal threshold, input units; zero for a clean input, and the rule is then exactly (2.3).
    pub threshold: f64,
}

/// Multiples of the noise sd that a move must exceed to count as a reversal. The difference of two samples has sd
/// √2 σ, so this is 4.2 of those: about one false reversal in 10⁵ samples at rest, and none on a slope.
const THRESHOLD_IN_SD: f64 = 6.0;

/// Share of the range that noise may take up.
const LARGEST_NOISE: f64 = 0.02;

impl SensorNoise {
    /// Looks for noise on an input.
    pub fn of(v: &[f64]) -> Self {
        let (low, high) =
            v.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
        let limit = LARGEST_NOISE * (high - low);
        let small_pairs = small_cluster(&rainflow(v), limit).unwrap_or(0.0);
        let sd = (2..=4).find_map(|k| white_sd(v, k)).filter(|&sd| sd < limit).unwrap_or(0.0);
        let threshold = if small_pairs > 0.0 { 2.0 * small_pairs } else { THRESHOLD_IN_SD * sd };
        Self { sd, small_pairs, threshold }
    }
}

/// Sizes of the pairs of turning points that close inside a larger motion, in the order in which they close.
///
/// Four-point rainflow counting: of four successive turning points, the inner two form a pair if they lie within the outer
/// two (M. Matsuishi, T. Endo, 1968; ASTM E1049).
fn rainflow(v: &[f64]) -> Vec<f64> {
    let (mut stack, mut pairs): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for &now in v {
        match stack[..] {
            [.., last] if last == now => continue,
            [.., before, last] if (last > before) == (now > last) => stack.pop(),
            _ => None,
        };
        stack.push(now);
        while let [.., a, b, c, d] = stack[..] {
            let inner = (b - c).abs();
            if inner > (a - b).abs() || inner > (c - d).abs() {
                break;
            }
            pairs.push(inner);
            stack.truncate(stack.len() - 3);
            stack.push(d);
        }
    }
    // What never closes: the turning points left on the stack.
    pairs.extend(stack.windows(2).map(|w| (w[1] - w[0]).abs()));
    pairs
}

/// Least number of small pairs that are noise.
const LEAST_PAIRS: usize = 15;

/// Largest member of a cluster of sizes under the limit, set apart from all larger ones by a factor of four.
fn small_cluster(sizes: &[f64], limit: f64) -> Option<f64> {
    let mut sizes = sizes.to_vec();
    sizes.sort_by(f64::total_cmp);
    let apart = |i: &usize| sizes[*i] < limit && sizes[i + 1] > 4.0 * sizes[*i];
    (LEAST_PAIRS - 1..sizes.len().saturating_sub(1)).rev().find(apart).map(|i| sizes[i])
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
