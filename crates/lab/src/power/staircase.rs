//! Which size to try next, and from which size on a fault is found.
//!
//! A Bayesian staircase. The curve of an effect, [`Psychometric`], is one of a grid of curves; every fault that was put in and diagnosed turns
//! the prior into a posterior by Bayes' rule,
//!
//! ```text
//! p(θ | data) ∝ p(θ) · Π ψ(sᵢ; θ)^fᵢ · (1 − ψ(sᵢ; θ))^(1 − fᵢ),   θ = (α, β, λ),   fᵢ = 1 where found
//! ```
//!
//! with `sᵢ` the size that was reached, whatever size was asked for. What is asked for next is the size whose answer leaves the least
//! expected entropy of *the figure that is wanted*, `s₉₀ = ψ⁻¹(0.9)` in classes of half an octave with "above 8, or never" as the last: the
//! method of Watson and Pelli (QUEST, Perception & Psychophysics 33:113, 1983), with the entropy of Kontsevich and Tyler (Vision Research 39:2729,
//! 1999), of what is of interest alone as in Prins (Journal of Vision 13(7):3, 2013).
//!
//! **What is reported.** The size stated is the smallest at which the next fault is found with a probability of 0.9,
//!
//! ```text
//! s = min { s : E[ψ(s; θ) | data] ≥ 0.9 }
//! ```
//!
//! rather than an estimate of `s₉₀`: it is so by construction that, over effects that the prior is fair for, nine in ten fresh faults of the
//! size stated are found, however few draws there were; few draws make it larger. Beside it stands the 90 % credible interval of `s₉₀`. Where no
//! size up to the largest is found that often, `s₉₀` lies beyond it with a probability of 0.95, or the draws were too few to show.
//!
//! **Prior.** `α` log-uniform from ¼, half the least size tried, to 8, the largest; `β` log-uniform from 2 to 10: from one in ten to nine in ten it
//! takes a factor of 9, or of 1.6, in size. `λ` with weight ½ uniform on [0, 0.1], an effect that is found once it is large enough, and with weight ½
//! uniform on [0.1, 1], one that is never found nine times in ten: before the first draw both count as much. `γ` is known beforehand.

use super::Psychometric;

/// The share that is to be found.
pub(crate) const SHARE: f64 = 0.9;

/// Sizes asked for: half-octaves, from the least that counts as observable.
pub(crate) const SIZES: [f64; 9] =
    [0.5, std::f64::consts::FRAC_1_SQRT_2, 1.0, std::f64::consts::SQRT_2, 2.0, 2.828, 4.0, 5.657, LARGEST];

/// The largest size asked for.
pub const LARGEST: f64 = 8.0;

/// Sizes that can be stated are a twelfth of an octave apart, over four octaves.
const STATED_PER_OCTAVE: usize = 12;
const OCTAVES: usize = 4;

/// Probability in each tail beyond the interval.
const TAIL: f64 = 0.05;

/// An interval is narrow enough where its ends are this factor apart: sizes of faults are not known better.
const NARROW: f64 = 2.0;

/// A curve of the grid with what is fixed about it.
#[derive(Debug, Clone)]
struct Node {
    curve: Psychometric,
    /// `ψ` at each of [`SIZES`].
    at: [f64; SIZES.len()],
    /// `s₉₀`, infinite where there is none.
    wanted: f64,
    /// Class of `s₉₀`: how many of [`SIZES`] lie below it.
    class: usize,
}

/// The posterior of one effect's curve.
#[derive(Debug, Clone)]
pub(crate) struct Staircase {
    /// By increasing `s₉₀`.
    nodes: Vec<Node>,
    /// One a node, of sum 1.
    weights: Vec<f64>,
}

/// What the draws say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conclusion {
    /// Smallest size up to [`LARGEST`] at which the next fault is found with probability [`SHARE`].
    pub size: Option<f64>,
    /// 90 % credible interval of `s₉₀`; an end is infinite where it lies beyond [`LARGEST`].
    pub interval: [f64; 2],
    /// Probability that even at [`LARGEST`] less than [`SHARE`] are found.
    pub beyond: f64,
}

impl Conclusion {
    /// Whether it is all but certain that the effect is not found nine times in ten up to the largest size.
    pub(crate) fn is_beyond(&self) -> bool {
        is_certain(self.beyond)
    }

    /// Whether more draws would show little more.
    pub(crate) fn is_settled(&self) -> bool {
        self.is_beyond() || self.size.is_some() && self.interval[1] <= NARROW * self.interval[0].max(SIZES[0])
    }
}

/// Whether a probability leaves no more than the tail of an interval.
pub(super) fn is_certain(probability: f64) -> bool {
    probability >= 1.0 - TAIL
}

impl Staircase {
    /// The prior, with the guess rate in [0, 0.9).
    pub(crate) fn new(guess: f64) -> Self {
        let mut prior = Vec::new();
        for threshold in geometric(0.25, LARGEST, 21) {
            for slope in geometric(2.0, 10.0, 5) {
                for (lapse, weight) in lapses() {
                    prior.push((Node::new(Psychometric { threshold, slope, lapse, guess }), weight));
                }
            }
        }
        prior.sort_by(|x, y| x.0.wanted.total_cmp(&y.0.wanted));
        let (nodes, weights): (Vec<Node>, Vec<f64>) = prior.into_iter().unzip();
        Self { weights: normalised(weights), nodes }
    }

    /// Takes in that a fault of a size was found or not.
    pub(crate) fn push(&mut self, size: f64, found: bool) {
        let likelihood = |node: &Node| {
            let share = node.curve.found(size);
            if found { share } else { 1.0 - share }
        };
        let weights = self.nodes.iter().zip(&self.weights).map(|(node, w)| w * likelihood(node)).collect();
        self.weights = normalised(weights);
    }

    /// The size to ask for next, one of [`SIZES`]; the smallest of equals.
    pub(crate) fn next_size(&self) -> f64 {
        let entropies = (0..SIZES.len()).map(|i| self.expected_entropy(i));
        let best = entropies.enumerate().min_by(|x, y| x.1.total_cmp(&y.1)).map_or(0, |(i, _)| i);
        SIZES[best]
    }

    /// Entropy of the class of `s₉₀` that is expected after a fault of the `i`-th size.
    fn expected_entropy(&self, i: usize) -> f64 {
        let mut classes = [[0.0; SIZES.len() + 1]; 2];
        for (node, weight) in self.nodes.iter().zip(&self.weights) {
            classes[0][node.class] += weight * node.at[i];
            classes[1][node.class] += weight * (1.0 - node.at[i]);
        }
        classes.iter().map(|joint| weighted_entropy(joint)).sum()
    }

    /// What is known by now.
    pub(crate) fn conclusion(&self) -> Conclusion {
        let sizes: Vec<f64> = (0..=OCTAVES * STATED_PER_OCTAVE)
            .map(|k| SIZES[0] * (k as f64 / STATED_PER_OCTAVE as f64).exp2())
            .collect();
        let stated = sizes.partition_point(|size| self.predicted(*size) < SHARE);
        let wanted = |share| match self.nodes[quantile(&self.weights, 0..self.nodes.len(), share)].wanted {
            size if size > LARGEST => f64::INFINITY,
            size => size,
        };
        Conclusion {
            size: sizes.get(stated).copied(),
            interval: [TAIL, 1.0 - TAIL].map(wanted),
            beyond: self.beyond(LARGEST),
        }
    }

    /// The probability that at a size less than [`SHARE`] are found.
    pub(crate) fn beyond(&self, size: f64) -> f64 {
        self.mean(|node| f64::from(u8::from(node.wanted > size)))
    }

    /// What share is found at a size at most, with a probability of 0.95.
    pub(crate) fn found_at_most(&self, size: f64) -> f64 {
        let shares: Vec<f64> = self.nodes.iter().map(|node| node.curve.found(size)).collect();
        let mut order: Vec<usize> = (0..shares.len()).collect();
        order.sort_by(|i, k| shares[*i].total_cmp(&shares[*k]));
        shares[quantile(&self.weights, order, 1.0 - TAIL)]
    }

    /// The probability that the next fault of a size is found.
    pub(crate) fn predicted(&self, size: f64) -> f64 {
        self.mean(|node| node.curve.found(size))
    }

    fn mean(&self, of: impl Fn(&Node) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(node, weight)| weight * of(node)).sum()
    }
}

impl Node {
    fn new(curve: Psychometric) -> Self {
        let wanted = curve.size_for(SHARE).unwrap_or(f64::INFINITY);
        let class = SIZES.iter().filter(|size| **size < wanted).count();
        Self { curve, at: SIZES.map(|size| curve.found(size)), wanted, class }
    }
}

/// Lapse rates with their prior weights: the middles of equal pieces of both halves.
fn lapses() -> impl Iterator<Item = (f64, f64)> {
    let pieces = |low: f64, high: f64, count: usize| {
        let width = (high - low) / count as f64;
        (0..count).map(move |k| (low + width * (k as f64 + 0.5), 0.5 / count as f64))
    };
    pieces(0.0, 1.0 - SHARE, 5).chain(pieces(1.0 - SHARE, 1.0, 9))
}

/// So many numbers in even ratios.
fn geometric(low: f64, high: f64, count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |k| low * (high / low).powf(k as f64 / (count - 1) as f64))
}

fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
    weights
}

/// `−Σ pₖ ln(pₖ/Σp)`: the entropy of a distribution, times its mass.
fn weighted_entropy(joint: &[f64]) -> f64 {
    let mass: f64 = joint.iter().sum();
    joint.iter().filter(|p| **p > 0.0).map(|p| -p * (p / mass).ln()).sum()
}

/// The first of nodes in an order up to which a share of the weight lies.
fn quantile(weights: &[f64], order: impl IntoIterator<Item = usize>, share: f64) -> usize {
    let (mut sum, mut last) = (0.0, 0);
    for node in order {
        (sum, last) = (sum + weights[node], node);
        if sum >= share {
            break;
        }
    }
    last
}

#[cfg(test)]
mod tests;
