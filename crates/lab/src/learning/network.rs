//! Training of the network: cross-entropy with a ridge, Adam (D. Kingma, J. Ba, ICLR 2015), batches of drawn rows.

use super::standardised::standard;
use super::table::Table;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use switchback_diagnose::posterior::{Layer, Network, softmax};

/// How a network is trained.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkSettings {
    /// Units of the hidden layers.
    pub hidden: [usize; 2],
    /// Passes over the rows.
    pub epochs: usize,
    /// Rows of a step.
    pub batch: usize,
    /// Learning rate; it falls to a twentieth along a half cosine.
    pub rate: f64,
    /// Ridge on the weights.
    pub ridge: f64,
    /// Share of the columns that a row is shown while training.
    pub shown: f64,
    /// Seed of the draws.
    pub seed: u64,
}

impl Default for NetworkSettings {
    /// The prototype's sizes.
    fn default() -> Self {
        Self { hidden: [160, 80], epochs: 25, batch: 128, rate: 1e-3, ridge: 1e-4, shown: 0.9, seed: 1 }
    }
}

/// A layer while it is trained.
#[derive(Debug, Clone)]
struct Dense {
    outputs: usize,
    /// Weights, all of the first input first, then the biases.
    numbers: Vec<f64>,
}

impl Dense {
    fn drawn((inputs, outputs): (usize, usize), rng: &mut ChaCha8Rng) -> Self {
        let scale = (2.0 / inputs.max(1) as f64).sqrt();
        let mut numbers: Vec<f64> =
            StandardNormal.sample_iter(rng).take(inputs * outputs).map(|w: f64| scale * w).collect();
        numbers.extend(vec![0.0; outputs]);
        Self { outputs, numbers }
    }

    fn parts(&self) -> (&[f64], &[f64]) {
        self.numbers.split_at(self.numbers.len() - self.outputs)
    }

    fn of(&self, input: &[f64]) -> Vec<f64> {
        let (weights, biases) = self.parts();
        let mut out = biases.to_vec();
        for (x, weights) in input.iter().zip(weights.chunks(self.outputs)) {
            if *x != 0.0 {
                out.iter_mut().zip(weights).for_each(|(o, w)| *o += x * w);
            }
        }
        out
    }

    /// Adds what a row contributes to the gradient, and gives the error of the inputs.
    fn back(&self, input: &[f64], error: &[f64], gradient: &mut [f64]) -> Vec<f64> {
        let (weights, _) = self.parts();
        let (of_weights, of_biases) = gradient.split_at_mut(weights.len());
        of_biases.iter_mut().zip(error).for_each(|(g, e)| *g += e);
        let each = input.iter().zip(weights.chunks(self.outputs)).zip(of_weights.chunks_mut(self.outputs));
        each.map(|((x, weights), gradient)| {
            if *x != 0.0 {
                gradient.iter_mut().zip(error).for_each(|(g, e)| *g += x * e);
            }
            weights.iter().zip(error).map(|(w, e)| w * e).sum()
        })
        .collect()
    }
}

type Layers = [Dense; 3];
type Gradient = [Vec<f64>; 3];

/// Rows that a thread takes at once: partial sums are added in their order, so that nothing depends on threads.
const TOGETHER: usize = 16;

/// Loss and gradient of one row.
fn row_gradient(layers: &Layers, row: &[f64], (label, weight): (usize, f64), gradient: &mut Gradient) -> f64 {
    let positive = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| x.max(0.0)).collect() };
    let first = layers[0].of(row);
    let shown = positive(&first);
    let second = layers[1].of(&shown);
    let seen = positive(&second);
    let p = softmax(&layers[2].of(&seen));
    let error: Vec<f64> =
        p.iter().enumerate().map(|(k, p)| weight * (p - f64::from(u8::from(k == label)))).collect();
    let gate = |error: Vec<f64>, before: &[f64]| -> Vec<f64> {
        error.into_iter().zip(before).map(|(e, x)| if *x > 0.0 { e } else { 0.0 }).collect()
    };
    let error = gate(layers[2].back(&seen, &error, &mut gradient[2]), &second);
    let error = gate(layers[1].back(&shown, &error, &mut gradient[1]), &first);
    layers[0].back(row, &error, &mut gradient[0]);
    -weight * libm::log(p[label].max(f64::MIN_POSITIVE))
}

fn zeros(layers: &Layers) -> Gradient {
    std::array::from_fn(|k| vec![0.0; layers[k].numbers.len()])
}

/// Mean loss and gradient over some rows.
fn gradient(layers: &Layers, rows: &[(Vec<f64>, usize, f64)]) -> (f64, Gradient) {
    let parts: Vec<(f64, Gradient)> = rows
        .par_chunks(TOGETHER)
        .map(|rows| {
            let mut part = zeros(layers);
            let loss =
                rows.iter().map(|(row, label, w)| row_gradient(layers, row, (*label, *w), &mut part)).sum();
            (loss, part)
        })
        .collect();
    let (mut loss, mut sum) = (0.0, zeros(layers));
    for (part, of_part) in parts {
        loss += part;
        for (sum, part) in sum.iter_mut().zip(of_part) {
            sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
        }
    }
    let count = rows.len().max(1) as f64;
    sum.iter_mut().flatten().for_each(|g| *g /= count);
    (loss / count, sum)
}

/// Moments of the gradient.
struct Adam {
    first: Gradient,
    second: Gradient,
    steps: i32,
}

impl Adam {
    const MEMORY: (f64, f64) = (0.9, 0.999);

    fn step(&mut self, layers: &mut Layers, gradient: &Gradient, (rate, ridge): (f64, f64)) {
        self.steps += 1;
        let (b1, b2) = Self::MEMORY;
        let (c1, c2) = (1.0 - b1.powi(self.steps), 1.0 - b2.powi(self.steps));
        for k in 0..3 {
            let moments = self.first[k].iter_mut().zip(&mut self.second[k]);
            for ((x, g), (m, v)) in layers[k].numbers.iter_mut().zip(&gradient[k]).zip(moments) {
                *m = b1 * *m + (1.0 - b1) * g;
                *v = b2 * *v + (1.0 - b2) * g * g;
                *x -= rate * (*m / c1 / ((*v / c2).sqrt() + 1e-8) + ridge * *x);
            }
        }
    }
}

/// Trains a network on a table.
pub fn train_network(table: &Table, settings: &NetworkSettings) -> Network {
    let standard = standard(&table.values);
    let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
    let [h1, h2] = settings.hidden;
    let sizes = [(table.columns.len(), h1), (h1, h2), (h2, table.classes.len())];
    let mut layers: Layers = sizes.map(|size| Dense::drawn(size, &mut rng));
    let mut adam = Adam { first: zeros(&layers), second: zeros(&layers), steps: 0 };
    let mean = table.weights.iter().sum::<f64>() / table.rows() as f64;
    let mut order: Vec<usize> = (0..table.rows()).collect();
    let batches = table.rows().div_ceil(settings.batch);
    for epoch in 0..settings.epochs {
        order.shuffle(&mut rng);
        for (number, batch) in order.chunks(settings.batch).enumerate() {
            let rows: Vec<(Vec<f64>, usize, f64)> = batch
                .iter()
                .map(|r| {
                    let mut z = standard.of(&table.row(*r));
                    for z in &mut z {
                        *z = if rng.random::<f64>() < settings.shown { *z / settings.shown } else { 0.0 };
                    }
                    (z, table.labels[*r], table.weights[*r] / mean)
                })
                .collect();
            let done = (epoch * batches + number) as f64 / (settings.epochs * batches) as f64;
            let rate = settings.rate * (0.05 + 0.95 * 0.5 * (1.0 + libm::cos(std::f64::consts::PI * done)));
            let (_, gradient) = gradient(&layers, &rows);
            adam.step(&mut layers, &gradient, (rate, settings.ridge));
        }
    }
    let layer = |dense: &Dense| {
        let (weights, biases) = dense.parts();
        let short = |x: &[f64]| x.iter().map(|x| *x as f32).collect();
        Layer { weights: short(weights), biases: short(biases) }
    };
    Network { standard, layers: layers.each_ref().map(layer) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gradient_is_that_of_finite_differences() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let layers: Layers = [(5, 7), (7, 4), (4, 3)].map(|size| Dense::drawn(size, &mut rng));
        let rows: Vec<(Vec<f64>, usize, f64)> = (0..40)
            .map(|k| {
                ((0..5).map(|_| rng.random_range(-2.0..2.0)).collect(), k % 3, rng.random_range(0.5..2.0))
            })
            .collect();
        let (_, exact) = gradient(&layers, &rows);
        for k in 0..3 {
            for i in (0..layers[k].numbers.len()).step_by(3) {
                let at = |step: f64| {
                    let mut moved = layers.clone();
                    moved[k].numbers[i] += step;
                    gradient(&moved, &rows).0
                };
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!(
                    (exact[k][i] - slope).abs() < 1e-6 * (1.0 + slope.abs()),
                    "{k} {i}: {} {slope}",
                    exact[k][i]
                );
            }
        }
    }
}
