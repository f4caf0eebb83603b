//! Growing one tree, leaf by leaf.
//!
//! The gain of a split is the drop of the second-order loss,
//!
//! ```text
//! gain = ½·[G_L²/(H_L + λ) + G_R²/(H_R + λ) − G²/(H + λ)]
//! ```
//!
//! with sums `G`, `H` of first and second derivatives. The leaf with the largest gain is split next (T. Chen, C. Guestrin, KDD 2016; G. Ke
//! et al., NIPS 2017, for histograms and leaves). Ties go to the first column and the first edge.

use super::binned::{BINS, Binned};
use super::boosting_settings::BoostingSettings;
use rayon::prelude::*;
use switchback_diagnose::posterior::{Node, Tree};

/// Sums of a bin: first derivative, second derivative, rows.
type Sums = [f64; 3];

/// A split of a leaf.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Split {
    pub gain: f64,
    pub column: u16,
    pub edge: u8,
}

/// A leaf while the tree grows.
struct Leaf {
    /// Its node.
    node: usize,
    rows: Vec<u32>,
    histogram: Vec<Sums>,
    best: Option<Split>,
}

/// Second derivatives of a side of a split, at least.
const LEAST_CURVATURE: f64 = 1e-3;
/// Columns that a thread takes at once.
const TOGETHER: usize = 32;

/// Derivatives of the loss by a class's score at every row.
#[derive(Clone, Copy)]
pub(super) struct Derivatives<'a> {
    pub first: &'a [f64],
    pub second: &'a [f64],
}

/// A node while the tree grows.
#[derive(Clone, Copy)]
enum Growing {
    Leaf(f64),
    Split { split: Split, left: usize, right: usize },
}

/// Grows a tree on some rows and columns.
pub(super) fn grow(
    binned: &Binned,
    (rows, columns): (Vec<u32>, &[u16]),
    derivatives: Derivatives<'_>,
    settings: &BoostingSettings,
) -> Tree {
    let grower = Grower { binned, columns, derivatives, settings };
    let mut nodes = vec![Growing::Leaf(0.0)];
    let mut leaves = vec![grower.leaf(0, rows, None)];
    while leaves.len() < settings.leaves {
        let gain = |leaf: &Leaf| leaf.best.map_or(0.0, |split| split.gain);
        let next = (0..leaves.len())
            .fold(0, |best, i| if gain(&leaves[i]) > gain(&leaves[best]) { i } else { best });
        let Some(split) = leaves[next].best else { break };
        let leaf = leaves.swap_remove(next);
        let (left, right) = (nodes.len(), nodes.len() + 1);
        nodes[leaf.node] = Growing::Split { split, left, right };
        nodes.extend([Growing::Leaf(0.0); 2]);
        leaves.extend(grower.parted(leaf, split, (left, right)));
    }
    for leaf in &leaves {
        nodes[leaf.node] = Growing::Leaf(grower.value(&leaf.rows));
    }
    let mut flat = Vec::with_capacity(nodes.len());
    flatten(&nodes, 0, &mut flat);
    Tree(flat)
}

struct Grower<'a> {
    binned: &'a Binned,
    columns: &'a [u16],
    derivatives: Derivatives<'a>,
    settings: &'a BoostingSettings,
}

impl Grower<'_> {
    fn leaf(&self, node: usize, rows: Vec<u32>, histogram: Option<Vec<Sums>>) -> Leaf {
        let histogram = histogram.unwrap_or_else(|| self.histogram(&rows));
        let best = self.best(&histogram);
        Leaf { node, rows, histogram, best }
    }

    /// Both leaves of a split. The smaller one is counted, the other one is what is left of the parent.
    fn parted(&self, leaf: Leaf, split: Split, (left, right): (usize, usize)) -> [Leaf; 2] {
        let bins = &self.binned.bins[usize::from(split.column)];
        let (of_left, of_right): (Vec<u32>, Vec<u32>) =
            leaf.rows.iter().partition(|row| bins[**row as usize] <= split.edge);
        let is_left = of_left.len() <= of_right.len();
        let smaller = self.histogram(if is_left { &of_left } else { &of_right });
        let mut larger = leaf.histogram;
        for (all, part) in larger.iter_mut().zip(&smaller) {
            (0..3).for_each(|i| all[i] -= part[i]);
        }
        let (of_left_sums, of_right_sums) = if is_left { (smaller, larger) } else { (larger, smaller) };
        [self.leaf(left, of_left, Some(of_left_sums)), self.leaf(right, of_right, Some(of_right_sums))]
    }

    fn histogram(&self, rows: &[u32]) -> Vec<Sums> {
        let Derivatives { first, second } = self.derivatives;
        let gathered: Vec<[f64; 2]> =
            rows.iter().map(|r| [first[*r as usize], second[*r as usize]]).collect();
        let mut histogram = vec![[0.0; 3]; BINS * self.columns.len()];
        let chunks = histogram.par_chunks_mut(BINS).with_min_len(TOGETHER);
        chunks.zip(self.columns).for_each(|(sums, column)| {
            let bins = &self.binned.bins[usize::from(*column)];
            for (row, [g, h]) in rows.iter().zip(&gathered) {
                let sum = &mut sums[usize::from(bins[*row as usize])];
                sum[0] += g;
                sum[1] += h;
                sum[2] += 1.0;
            }
        });
        histogram
    }

    fn best(&self, histogram: &[Sums]) -> Option<Split> {
        let mut best: Option<Split> = None;
        for (sums, column) in histogram.chunks(BINS).zip(self.columns) {
            let edges = self.binned.edges[usize::from(*column)].len();
            let total = sums.iter().fold([0.0; 3], |all, s| [all[0] + s[0], all[1] + s[1], all[2] + s[2]]);
            let mut left = [0.0; 3];
            for edge in 0..edges {
                (0..3).for_each(|i| left[i] += sums[edge][i]);
                let right = [total[0] - left[0], total[1] - left[1], total[2] - left[2]];
                let Some(gain) = self.settings.gain(left, right) else { continue };
                if gain > best.map_or(self.settings.least_gain, |split| split.gain) {
                    best = Some(Split { gain, column: *column, edge: edge as u8 });
                }
            }
        }
        best
    }

    /// The Newton step of a leaf, shrunk by the learning rate; summed in the order of the rows.
    fn value(&self, rows: &[u32]) -> f64 {
        let Derivatives { first, second } = self.derivatives;
        let sum = |of: &[f64]| rows.iter().map(|r| of[*r as usize]).sum::<f64>();
        -self.settings.rate * sum(first) / (sum(second) + self.settings.l2)
    }
}

impl BoostingSettings {
    /// The gain of a split; none where a side is too small.
    pub(super) fn gain(&self, left: Sums, right: Sums) -> Option<f64> {
        let enough = |side: &Sums| side[2] >= self.least_rows as f64 && side[1] >= LEAST_CURVATURE;
        if !enough(&left) || !enough(&right) {
            return None;
        }
        let score = |g: f64, h: f64| g * g / (h + self.l2);
        let both = score(left[0] + right[0], left[1] + right[1]);
        Some(0.5 * (score(left[0], left[1]) + score(right[0], right[1]) - both))
    }
}

fn flatten(nodes: &[Growing], at: usize, flat: &mut Vec<Node>) {
    match nodes[at] {
        Growing::Leaf(value) => flat.push(Node::Leaf(value as f32)),
        Growing::Split { split, left, right } => {
            let here = flat.len();
            flat.push(Node::Split { column: split.column, edge: split.edge, right: 0 });
            flatten(nodes, left, flat);
            let behind = flat.len() as u16;
            if let Node::Split { right, .. } = &mut flat[here] {
                *right = behind;
            }
            flatten(nodes, right, flat);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn data(seed: u64, rows: usize, columns: usize) -> (Vec<Vec<f64>>, Vec<f64>, Vec<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut draw =
            |n: usize, low: f64, high: f64| (0..n).map(|_| rng.random_range(low..high)).collect::<Vec<f64>>();
        let values = (0..columns).map(|_| draw(rows, -1.0, 1.0)).collect();
        (values, draw(rows, -1.0, 1.0), draw(rows, 0.05, 0.3))
    }

    /// The oracle: every value of every column as a threshold, sums taken anew.
    fn brute_force(
        values: &[Vec<f64>],
        rows: &[usize],
        (g, h): (&[f64], &[f64]),
        settings: &BoostingSettings,
    ) -> Option<(f64, usize, f64)> {
        let sums = |side: &[usize]| {
            side.iter().fold([0.0; 3], |s: [f64; 3], r| [s[0] + g[*r], s[1] + h[*r], s[2] + 1.0])
        };
        let mut best: Option<(f64, usize, f64)> = None;
        for (column, x) in values.iter().enumerate() {
            for threshold in rows.iter().map(|r| x[*r]) {
                let (left, right): (Vec<usize>, Vec<usize>) = rows.iter().partition(|r| x[**r] <= threshold);
                if let Some(gain) = settings.gain(sums(&left), sums(&right))
                    && gain > best.map_or(settings.least_gain, |b| b.0)
                {
                    best = Some((gain, column, threshold));
                }
            }
        }
        best
    }

    /// The oracle's tree: the sums of squares of steps that leaf-wise growth takes, by definition.
    fn brute_tree(values: &[Vec<f64>], (g, h): (&[f64], &[f64]), settings: &BoostingSettings) -> Vec<f64> {
        let mut leaves: Vec<Vec<usize>> = vec![(0..g.len()).collect()];
        while leaves.len() < settings.leaves {
            let found: Vec<_> =
                leaves.iter().map(|rows| brute_force(values, rows, (g, h), settings)).collect();
            let gain = |i: usize| found[i].map_or(0.0, |f| f.0);
            let next = (0..leaves.len()).fold(0, |best, i| if gain(i) > gain(best) { i } else { best });
            let Some((_, column, threshold)) = found[next] else { break };
            let rows = leaves.remove(next);
            let (left, right) = rows.iter().partition(|r| values[column][**r] <= threshold);
            leaves.extend([left, right]);
        }
        let mut steps = vec![0.0; g.len()];
        for rows in leaves {
            let sum = |of: &[f64]| rows.iter().map(|r| of[*r]).sum::<f64>();
            let step = -settings.rate * sum(g) / (sum(h) + settings.l2);
            rows.iter().for_each(|r| steps[*r] = step);
        }
        steps
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn a_tree_is_that_of_a_brute_force_splitter(seed in any::<u64>(), rows in 10_usize..60, leaves in 2_usize..8) {
            // Fewer rows than bins: every threshold between two values is an edge.
            let (values, g, h) = data(seed, rows, 4);
            let settings = BoostingSettings { leaves, least_rows: 2, ..BoostingSettings::default() };
            let binned = Binned::new(&values);
            let all: Vec<u32> = (0..rows as u32).collect();
            let tree = grow(&binned, (all, &[0, 1, 2, 3]), Derivatives { first: &g, second: &h }, &settings);
            let steps = brute_tree(&values, (&g, &h), &settings);
            for row in 0..rows {
                let value = tree.value(|column, edge| binned.bins[usize::from(column)][row] <= edge);
                prop_assert!((f64::from(value) - steps[row]).abs() < 1e-6, "row {}: {} {}", row, value, steps[row]);
            }
        }
    }
}
