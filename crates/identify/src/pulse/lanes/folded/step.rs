//! One Gauss–Newton step.

use super::super::factor::{Factor, SOUND};
use super::LaneFolds;
use super::work::FoldWork;
use switchback_noise::lanes::{LANES, Lane, keep_apart};

impl LaneFolds {
    /// One Gauss–Newton step; the factor of the core's information, the levels eliminated. [`FoldWork::rows`] keeps `L⁻¹C`.
    #[inline(always)]
    pub(super) fn step<const N: usize, const D: usize>(
        &self,
        theta: &mut [Lane; D],
        work: &mut FoldWork,
        sound: &mut [bool; LANES],
    ) -> Factor<D> {
        let (mut normal, mut right) = self.lay_out::<N, D>(theta, work);
        self.factor_levels(work, sound);
        let inner = self.phases.len() - 1;
        let FoldWork { factor, rows, levels, .. } = work;
        for rows in rows.chunks_exact_mut((inner * (D + 1)).max(1)) {
            for j in 0..inner {
                let (before, row) = rows.split_at_mut(j * (D + 1));
                let row = &mut row[..D + 1];
                for (other, l) in before.chunks_exact(D + 1).zip(&factor[j * inner..j * inner + j]) {
                    keep_apart();
                    for d in 0..D + 1 {
                        row[d] -= *l * other[d];
                    }
                }
                for d in 0..D + 1 {
                    row[d] = row[d] * factor[j * inner + j];
                }
                for i in 0..D {
                    right[i] -= row[i] * row[D];
                    for l in 0..D {
                        if l <= i {
                            normal[i][l] -= row[i] * row[l];
                        }
                    }
                }
            }
        }
        let (core, solved) = Factor::new(&normal);
        let change = core.solve(&right);
        let points = inner + 1;
        for (rows, levels) in
            rows.chunks_exact_mut((inner * (D + 1)).max(1)).zip(levels.chunks_exact_mut(points))
        {
            for j in (0..inner).rev() {
                let mut x = rows[j * (D + 1) + D];
                for d in 0..D {
                    x -= rows[j * (D + 1) + d] * change[d];
                }
                for l in j + 1..inner {
                    keep_apart();
                    x -= factor[l * inner + j] * rows[l * (D + 1) + D];
                }
                let x = x * factor[j * inner + j];
                rows[j * (D + 1) + D] = x;
                levels[j + 1] += x;
            }
        }
        for d in 0..D {
            theta[d] += change[d];
        }
        for l in 0..LANES {
            sound[l] &= solved[l];
        }
        core
    }

    /// Cholesky's factor of what the levels of one experiment have in common.
    #[inline(always)]
    fn factor_levels(&self, work: &mut FoldWork, sound: &mut [bool; LANES]) {
        let inner = self.phases.len() - 1;
        let FoldWork { gaps, factor, .. } = work;
        factor.clear();
        factor.extend(self.gap_of.iter().map(|gap| gaps[*gap]));
        for j in 0..inner {
            let (row, below) = factor[j * inner..].split_at_mut(inner);
            let before = row[j];
            let mut pivot = before;
            for x in &row[..j] {
                keep_apart();
                pivot -= *x * *x;
            }
            for l in 0..LANES {
                sound[l] &= pivot.0[l] > SOUND * before.0[l];
            }
            let inverse = Lane::splat(1.0) / pivot.sqrt();
            row[j] = inverse;
            for other in below.chunks_exact_mut(inner) {
                let mut x = other[j];
                for (y, z) in other[..j].iter().zip(&row[..j]) {
                    keep_apart();
                    x -= *y * *z;
                }
                other[j] = x * inverse;
            }
        }
    }
}
