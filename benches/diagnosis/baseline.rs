//! The unit of cost.

use cpu_time::ProcessTime;
use nalgebra::{DMatrix, DVector};
use std::hint::black_box;

/// Processor seconds of one dense least-squares solution by Householder's method, 20,000 × 60: the median of nine.
pub(crate) fn least_squares_seconds() -> f64 {
    let entry = |row: usize, column: usize| ((row * 61 + column * column * 7 + 3) as f64).sin();
    let matrix = DMatrix::from_fn(20_000, 60, entry);
    let right = DVector::from_fn(20_000, |row, _| entry(row, 60));
    let mut seconds: Vec<f64> = (0..9)
        .map(|_| {
            let (matrix, mut right) = (matrix.clone(), right.clone());
            let start = ProcessTime::now();
            let qr = matrix.qr();
            qr.q_tr_mul(&mut right);
            let head = right.rows(0, 60).into_owned();
            black_box(qr.unpack_r().solve_upper_triangular(&head));
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    seconds[4]
}
