//! How the excess energy of samples is spread over cells, and whether chance spreads it so.

/// One cell of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portion {
    /// Samples in it.
    pub count: usize,
    /// Its share of the excess energy.
    pub share: f64,
    /// Its share of the samples.
    pub exposure: f64,
    /// Its energy in standard deviations of that which chance leaves where there is none beyond the noise.
    pub excess: f64,
    /// How much denser the energy is than elsewhere, in standard deviations of chance.
    pub density: f64,
}

/// Energy beyond the noise, and how many samples it is of.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    energy: f64,
    count: f64,
}

impl Sum {
    fn add(&mut self, other: Self) {
        self.energy += other.energy;
        self.count += other.count;
    }
}

/// How many samples a cell must hold, and how many make a block.
#[derive(Debug, Clone, Copy)]
pub struct Blocks {
    /// Samples of a block.
    pub length: usize,
    /// Variance of one sample's energy where the mean energy, noise included, is one.
    pub variance: f64,
}

/// The portions of `cells` cells; samples of no cell count with the whole. Each sample is its energy less that of the noise, which is
/// one, and its cell.
///
/// ```text
/// excess:   Σ e over the cell, over √Σ_b (Σ e over the cell's samples of block b)²
/// density:  D = Σ (1 − π)·e over the cell − Σ π·e elsewhere = N·π·(1 − π)·(mean e in the cell − mean e elsewhere),   π the exposure,
///           over √Σ_b (D of block b, e less its mean)²
/// ```
///
/// Sums over short blocks of time may depend on what is inside a block; no standard deviation counts as smaller than independent samples
/// give it under the hypothesis tested. Both are normal by the sum over many blocks: where few blocks hold all, `|sum|/√Σ sum²` is at most
/// the root of their number, and nothing is significant.
pub fn portions(samples: &[(f64, Option<usize>)], cells: usize, law: Blocks) -> Vec<Portion> {
    let mut whole = Sum::default();
    let mut sums = vec![Sum::default(); cells + 1];
    for &(energy, cell) in samples {
        sums[cell.unwrap_or(cells)].add(Sum { energy, count: 1.0 });
        whole.add(Sum { energy, count: 1.0 });
    }
    let mean = whole.energy / whole.count.max(1.0);
    let exposure = |k: usize| sums[k].count / whole.count.max(1.0);
    let (mut excess, mut density) = (vec![0.0; cells], vec![0.0; cells]);
    for block in samples.chunks(law.length) {
        let mut all = Sum::default();
        let mut here = vec![Sum::default(); cells];
        for &(energy, cell) in block {
            all.add(Sum { energy, count: 1.0 });
            if let Some(k) = cell {
                here[k].add(Sum { energy, count: 1.0 });
            }
        }
        let centred = |sum: Sum| sum.energy - sum.count * mean;
        for (k, here) in here.iter().enumerate() {
            excess[k] += here.energy * here.energy;
            density[k] += (centred(*here) - exposure(k) * centred(all)).powi(2);
        }
    }
    let positive: f64 = sums.iter().map(|sum| sum.energy.max(0.0)).sum::<f64>().max(1e-12);
    let level = (1.0 + mean).max(1.0);
    (0..cells)
        .map(|k| {
            let Sum { energy, count } = sums[k];
            let independent = law.variance * level * level * count * (1.0 - exposure(k));
            let apart = energy - exposure(k) * whole.energy;
            Portion {
                count: count as usize,
                share: energy.max(0.0) / positive,
                exposure: exposure(k),
                excess: in_deviations(energy, excess[k].max(law.variance * count)),
                density: in_deviations(apart, density[k].max(independent)),
            }
        })
        .collect()
}

fn in_deviations(sum: f64, variance: f64) -> f64 {
    sum / variance.max(f64::MIN_POSITIVE).sqrt()
}

/// Benjamini–Hochberg: q-values of p-values.
pub fn false_discovery_rates(p: &[f64]) -> Vec<f64> {
    let m = p.len() as f64;
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&i, &j| p[j].total_cmp(&p[i]));
    let mut q = vec![1.0; p.len()];
    let mut least = 1.0_f64;
    for (k, &i) in order.iter().enumerate() {
        least = least.min(p[i] * m / (m - k as f64));
        q[i] = least;
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::white;

    const WHITE: Blocks = Blocks { length: 25, variance: 2.0 };

    /// The oracle: `min_{j ≥ i} p(j)·m/j` of the ordered p-values (Benjamini and Hochberg, 1995).
    #[test]
    fn q_values_are_the_least_rate_at_which_a_cell_is_found() {
        let q = false_discovery_rates(&[0.02, 0.04, 0.041, 0.005, 0.9]);
        let expected = [0.05, 0.051_25, 0.051_25, 0.025, 0.9];
        assert!(q.iter().zip(expected).all(|(q, expected)| (q - expected).abs() < 1e-12), "{q:?}");
    }

    /// Noise whose standard deviation in one twentieth of the samples is `louder` times that elsewhere.
    fn noise(louder: f64, samples: usize) -> Vec<(f64, Option<usize>)> {
        let mut white = white();
        let one = |t: usize| {
            let inside = t.is_multiple_of(20);
            let w = white() * if inside { louder } else { 1.0 };
            (w * w - 1.0, Some(usize::from(!inside)))
        };
        (0..samples).map(one).collect()
    }

    #[test]
    fn energy_in_few_samples_is_dense_there_and_nowhere_else() {
        let [inside, outside] = portions(&noise(4.0, 8000), 2, WHITE)[..] else { panic!("two cells") };
        assert!((inside.exposure - 0.05).abs() < 1e-12 && inside.share > 0.8, "{inside:?}");
        assert!(inside.excess > 4.75 && inside.density > 4.75, "{inside:?}");
        assert!(outside.density < -3.09, "{outside:?}");
    }

    #[test]
    fn energy_that_is_everywhere_is_dense_nowhere() {
        let louder: Vec<_> =
            noise(1.0, 8000).iter().map(|&(e, cell)| (3.0 * (e + 1.0) - 1.0, cell)).collect();
        for portion in portions(&louder, 2, WHITE) {
            assert!(portion.excess > 4.75, "{portion:?}");
            assert!(portion.density.abs() < 2.33, "{portion:?}");
            assert!((portion.share / portion.exposure - 1.0).abs() < 0.2, "{portion:?}");
        }
    }

    #[test]
    fn one_burst_is_not_significant() {
        let mut samples = vec![(0.0, Some(1)); 2000];
        samples[1000..1012].fill((500.0, Some(0)));
        let burst = portions(&samples, 2, WHITE)[0];
        assert!(burst.share > 0.99 && burst.exposure < 0.01, "{burst:?}");
        assert!(burst.excess < 1.64 && burst.density < 1.64, "{burst:?}");
    }

    #[test]
    fn samples_of_no_cell_count_with_the_whole() {
        let samples: Vec<_> = (0..400).map(|t| (1.0, (t % 4 == 0).then_some(0))).collect();
        let quarter = portions(&samples, 1, WHITE)[0];
        assert!(
            (quarter.share - 0.25).abs() < 1e-12 && (quarter.exposure - 0.25).abs() < 1e-12,
            "{quarter:?}"
        );
    }
}
