//! What the last step leaves: parameters and their variances.

use super::super::factor::{Factor, dot};
use super::LaneFolds;
use super::work::FoldWork;
use switchback_noise::lanes::{Lane, keep_apart};

impl LaneFolds {
    /// The parameters and their variances at the end.
    #[inline(always)]
    pub(super) fn read<const N: usize, const D: usize>(
        &self,
        theta: &[Lane; D],
        (core, variance): (&Factor<D>, Lane),
        work: &mut FoldWork,
        (values, variances): (&mut Vec<Lane>, &mut Vec<Lane>),
    ) {
        let (mut a_at_one, mut b_at_one) = (Lane::splat(1.0), Lane::ZERO);
        for i in 0..N {
            a_at_one += theta[i];
            b_at_one += theta[N + i];
        }
        let inverse = Lane::splat(1.0) / b_at_one;
        let low = theta[2 * N] * a_at_one * inverse;
        let slopes = [theta[2 * N] * inverse, Lane::ZERO - low * inverse, a_at_one * inverse];
        let mut base = [Lane::ZERO; D];
        for d in 0..D {
            base[d] = slopes[d / N.max(1)];
        }
        base[2 * N] = slopes[2];
        values.clear();
        variances.clear();
        let diagonal = core.inverse_diagonal();
        for d in 0..2 * N {
            values.push(theta[d]);
            variances.push(variance * diagonal[d]);
        }
        let at_ends = {
            let solved = core.forward(&base);
            variance * dot(&solved, &solved)
        };
        let inner = self.phases.len() - 1;
        let FoldWork { factor, rows, levels, column, gaps, .. } = work;
        // The diagonal of the inverse of what the levels have in common, in the place of the gaps.
        gaps.clear();
        for j in 0..inner {
            column.clear();
            column.resize(inner, Lane::ZERO);
            let mut sum = Lane::ZERO;
            for i in j..inner {
                let mut x = if i == j { Lane::splat(1.0) } else { Lane::ZERO };
                for k in j..i {
                    keep_apart();
                    x -= factor[i * inner + k] * column[k];
                }
                column[i] = x * factor[i * inner + i];
                sum += column[i] * column[i];
            }
            gaps.push(sum);
        }
        for (e, levels) in levels.chunks_exact(inner + 1).enumerate() {
            values.push(low + levels[0]);
            variances.push(at_ends);
            let rows = &mut rows[e * inner * (D + 1)..(e + 1) * inner * (D + 1)];
            for j in (0..inner).rev() {
                let (row, below) = rows[j * (D + 1)..].split_at_mut(D + 1);
                for (other, i) in below.chunks_exact(D + 1).zip(j + 1..) {
                    keep_apart();
                    for d in 0..D {
                        row[d] -= factor[i * inner + j] * other[d];
                    }
                }
                for d in 0..D {
                    row[d] = row[d] * factor[j * inner + j];
                }
            }
            for (j, row) in rows.chunks_exact(D + 1).enumerate() {
                keep_apart();
                let mut gradient = base;
                for d in 0..D {
                    gradient[d] -= row[d];
                }
                let solved = core.forward(&gradient);
                values.push(low + levels[j + 1]);
                variances.push(variance * (gaps[j] + dot(&solved, &solved)));
            }
        }
    }
}
