//! A network with two hidden layers.

use super::bytes::{Reader, Writer};
use super::error::PosteriorError;
use super::standard::Standard;

/// A layer: `out_j = bias_j + Σ_i in_i·weight_ij`.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Weights, all of the first input first.
    pub weights: Vec<f32>,
    /// Biases, one an output.
    pub biases: Vec<f32>,
}

/// Standardised columns, two hidden layers of `max(0, ·)`, scores.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    /// Scales of the columns.
    pub standard: Standard,
    /// The three layers.
    pub layers: [Layer; 3],
}

impl Layer {
    /// Outputs of the layer, sums in the order of the inputs.
    fn of(&self, input: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = self.biases.iter().map(|b| f64::from(*b)).collect();
        for (x, weights) in input.iter().zip(self.weights.chunks(self.biases.len())) {
            out.iter_mut().zip(weights).for_each(|(o, w)| *o += x * f64::from(*w));
        }
        out
    }

    fn write(&self, out: &mut Writer) {
        out.numbers(&self.biases);
        out.numbers(&self.weights);
    }

    fn read(from: &mut Reader<'_>, inputs: usize) -> Result<Self, PosteriorError> {
        let (biases, weights) = (from.numbers()?, from.numbers()?);
        if biases.is_empty() || weights.len() != inputs * biases.len() {
            return Err(from.damaged("a layer of another size"));
        }
        Ok(Self { weights, biases })
    }
}

impl Network {
    /// Scores of a row.
    pub fn scores(&self, row: &[f64]) -> Vec<f64> {
        let [first, second, last] = &self.layers;
        let hidden = |x: Vec<f64>| -> Vec<f64> { x.into_iter().map(|x| x.max(0.0)).collect() };
        last.of(&hidden(second.of(&hidden(first.of(&self.standard.of(row))))))
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.standard.write(out);
        self.layers.iter().for_each(|layer| layer.write(out));
    }

    pub(super) fn read(
        from: &mut Reader<'_>,
        columns: usize,
        classes: usize,
    ) -> Result<Self, PosteriorError> {
        let standard = Standard::read(from, columns)?;
        let first = Layer::read(from, columns)?;
        let second = Layer::read(from, first.biases.len())?;
        let last = Layer::read(from, second.biases.len())?;
        if last.biases.len() != classes {
            return Err(from.damaged("a network of another number of classes"));
        }
        Ok(Self { standard, layers: [first, second, last] })
    }
}
