//! How much the experiments excite.

use super::data::PulseData;
use super::experiments::Experiments;
use nalgebra::{DMatrix, SymmetricEigen};

/// Smallest eigenvalue of the information matrix per sample of the over-parameterised regression: `λ_min(ΣΦΦᵀ/N)`.
///
/// `Φ` holds `−y(t−i)` about the records' mean, the pulse columns (height 1) and the constant. Over whole periods of a noise-free record this is the
/// excitation that Proposition 3.1 is after; it states it over `4n` samples, which cannot hold for `m > 3`, since `4n`
/// rank-one terms do not span `n(m+1)` directions. Positive if and only if every parameter is identifiable from the record.
///
/// # Panics
/// If no experiment is given.
pub(crate) fn excitation(experiments: &[&PulseData]) -> f64 {
    let experiments = Experiments::new(experiments);
    let columns = experiments.rank_free_columns();
    let statistics = &experiments.statistics;
    let (n, p) = (experiments.order(), columns.shared.ncols());
    let mut design = DMatrix::zeros(statistics.groups(), p + columns.local.len());
    design.columns_mut(0, p).copy_from(&columns.shared);
    for (l, column) in columns.local.iter().enumerate() {
        for &(q, w) in &column.support {
            design[(q, p + l)] = w;
        }
    }
    let size = n + design.ncols();
    let mut information = DMatrix::zeros(size, size);
    for i in 0..n {
        for l in 0..n {
            information[(i, l)] = statistics.product(i + 1, l + 1);
        }
        for k in 0..design.ncols() {
            let cross: f64 =
                (0..statistics.groups()).map(|q| -design[(q, k)] * statistics.sum(q, i + 1)).sum();
            information[(i, n + k)] = cross;
            information[(n + k, i)] = cross;
        }
    }
    for k in 0..design.ncols() {
        for l in 0..design.ncols() {
            information[(n + k, n + l)] =
                (0..statistics.groups()).map(|q| statistics.count(q) * design[(q, k)] * design[(q, l)]).sum();
        }
    }
    let eigenvalues = SymmetricEigen::new(information / statistics.samples()).eigenvalues;
    eigenvalues.min().max(0.0)
}
