//! What a free run is fitted to, and how.

use super::basis::Basis;
use super::problem::{Parameters, Segment, Structure};
use super::simulation_error::{
    BATCH, Effort, Refinement, each_batch, free_run, free_run_errors, linearise_whitened, whitened_cost,
};
use nalgebra::{DMatrix, DVector};
use switchback_model::noise_model::{noise_model, whitened};

/// Stretches of records that a free run is to follow.
///
/// Where the input repeats itself, so does the free run once it has settled, and the squared errors of all repetitions are those of their mean, times their
/// number, and a constant. A [`Fold`] makes use of it: the fit then costs the same for any length of the record.
#[derive(Debug)]
pub(super) struct Runs<'a> {
    /// What is simulated.
    pub(super) segments: Vec<Segment<'a>>,
    /// The record whose repetitions the only segment stands for.
    pub(super) fold: Option<Fold<'a>>,
}

/// A record that is simulated over three periods only: the first as it was measured; the second without weight, to settle; the third for all that
/// followed the first. What is left of the first after a period must be lost in rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fold<'a> {
    pub(super) y: &'a [f64],
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) period: usize,
}

/// Means over the repetitions, as outputs of the three periods of a [`Fold`], and what each sample stands for.
#[derive(Debug)]
pub(super) struct Folded {
    pub(super) y: Vec<f64>,
    pub(super) weights: Vec<f64>,
}

impl Fold<'_> {
    /// The means, unless the record is too short to be worth it.
    pub(super) fn means(&self) -> Option<Folded> {
        let Self { y, from, to, period } = *self;
        let end = from + 3 * period;
        if to <= end {
            return None;
        }
        let (mut sums, mut counts) = (vec![0.0; period], vec![0.0; period]);
        for t in from + period..to {
            sums[(t - from) % period] += y[t];
            counts[(t - from) % period] += 1.0;
        }
        let mut folded = Folded { y: y[..end].to_vec(), weights: vec![0.0; end] };
        folded.weights[from..from + period].fill(1.0);
        for p in 0..period {
            let mean = sums[p] / counts[p];
            folded.y[from + period + p] = mean;
            folded.y[from + 2 * period + p] = mean;
            folded.weights[from + 2 * period + p] = counts[p];
        }
        Some(folded)
    }

    /// The sample of the three periods that simulates a sample of the record.
    fn simulated(&self, t: usize) -> usize {
        if t < self.from + self.period {
            t
        } else {
            self.from + 2 * self.period + (t - self.from) % self.period
        }
    }
}

/// Fits of the noise and of the system in turn: one of each is asymptotically enough, since the errors of the two are uncorrelated in open loop; the second
/// forgets the bias that a first one on residuals of a poorer fit has.
const ROUNDS: usize = 2;

impl<'a> Runs<'a> {
    pub(super) fn new(segments: Vec<Segment<'a>>) -> Self {
        Self { segments, fold: None }
    }

    /// The free-run errors of the records, one list a stretch.
    pub(super) fn residuals(&self, structure: Structure, theta: &Parameters) -> Vec<Vec<f64>> {
        let Some(fold) = self.fold else {
            return self.segments.iter().map(|s| free_run_errors(structure, theta, s)).collect();
        };
        let run = free_run(structure, theta, &self.segments[0]);
        vec![(fold.from..fold.to).map(|t| fold.y[t] - run[fold.simulated(t) - fold.from]).collect()]
    }

    /// The parameters of least free-run error, filtered by `D`, from a start with a stable `A`.
    pub(super) fn refined(
        &self,
        structure: Structure,
        basis: &Basis,
        start: Parameters,
        whitening: &[f64],
        effort: Effort,
    ) -> Parameters {
        let curves: Vec<usize> = basis.sizes().collect();
        let constant = if self.fold.is_some() {
            energy(&self.residuals(structure, &start), whitening)
                - whitened_cost(structure, &start, &self.segments, whitening)
        } else {
            0.0
        };
        let refinement = Refinement { whitening, constant, ..Refinement::new(effort, &curves) };
        refinement.run(structure, start, &self.segments)
    }

    /// A fit of least free-run error with the noise modelled apart: the residuals' autoregression and the fit to errors
    /// filtered by it, in turn. White residuals leave the fit as it is.
    ///
    /// In open loop the fit is consistent whatever the filter; filtered by the noise's own it is the prediction-error estimate of a Box–Jenkins model,
    /// at the Cramér–Rao bound for normal noise (L. Ljung, System Identification, 2nd ed. 1999, ch. 8 and 9; P. C. Young, Recursive Estimation and
    /// Time-Series Analysis, 2nd ed. 2011, doi 10.1007/978-3-642-21981-8).
    pub(super) fn prewhitened(
        &self,
        structure: Structure,
        basis: &Basis,
        mut theta: Parameters,
        mut whitening: Vec<f64>,
    ) -> (Parameters, Vec<f64>) {
        for _ in 0..ROUNDS {
            let next = noise_model(&self.residuals(structure, &theta));
            if next.is_empty() && whitening.is_empty() {
                break;
            }
            whitening = next;
            theta = self.refined(structure, basis, theta, &whitening, Effort::FINAL);
        }
        (theta, whitening)
    }

    /// The information matrix per unit variance of the white errors.
    pub(super) fn information(
        &self,
        structure: Structure,
        theta: &Parameters,
        whitening: &[f64],
    ) -> DMatrix<f64> {
        linearise_whitened(structure, theta, &self.segments, whitening).information
    }

    /// The information matrix, the sum of squared filtered errors, and the gradient over each batch of samples of the records.
    pub(super) fn scatter(
        &self,
        structure: Structure,
        theta: &Parameters,
        whitening: &[f64],
    ) -> (DMatrix<f64>, f64, Vec<DVector<f64>>) {
        let model = linearise_whitened(structure, theta, &self.segments, whitening);
        let residuals = self.residuals(structure, theta);
        let energy = energy(&residuals, whitening);
        let Some(fold) = self.fold else { return (model.information, energy, model.batches) };
        let p = model.information.nrows();
        let segment = &self.segments[0];
        let mut jacobian = DMatrix::zeros(p, segment.len());
        each_batch(structure, theta, segment, whitening, |t, (columns, first), errors| {
            let batch = columns.view(first, errors.len());
            jacobian.columns_mut(t - segment.from, errors.len()).copy_from(&batch);
        });
        let errors = residuals.into_iter().flat_map(|r| whitened(r, whitening)).collect::<Vec<_>>();
        let batch = |(number, errors): (usize, &[f64])| {
            let mut gradient = DVector::zeros(p);
            for (s, error) in errors.iter().enumerate() {
                let column = fold.simulated(fold.from + number * BATCH + s) - fold.from;
                gradient.axpy(*error, &jacobian.column(column), 1.0);
            }
            gradient
        };
        (model.information, energy, errors.chunks(BATCH).enumerate().map(batch).collect())
    }
}

/// Sum of squared filtered errors.
fn energy(residuals: &[Vec<f64>], whitening: &[f64]) -> f64 {
    let square = |r: &Vec<f64>| whitened(r.clone(), whitening).iter().map(|e| e * e).sum::<f64>();
    residuals.iter().map(square).sum()
}
