//! The normal equations of a Gauss–Newton step.

use super::LaneFolds;
use super::work::FoldWork;
use switchback_noise::lanes::{Lane, keep_apart};

/// `x·y`.
#[inline(always)]
fn times(x: [Lane; 2], y: [Lane; 2]) -> [Lane; 2] {
    [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]]
}

/// `x*·y`.
#[inline(always)]
fn conj_times(x: [Lane; 2], y: [Lane; 2]) -> [Lane; 2] {
    [x[0] * y[0] + x[1] * y[1], x[0] * y[1] - x[1] * y[0]]
}

/// `Re(x e^{jφ})`, given `cos φ` and `sin φ`.
#[inline(always)]
fn turned(x: [Lane; 2], [cos, sin]: [f64; 2]) -> Lane {
    x[0] * cos - x[1] * sin
}

impl LaneFolds {
    /// The normal equations of the core, before the levels are eliminated; what the levels have in common with it, and with each other.
    #[inline(always)]
    pub(super) fn lay_out<const N: usize, const D: usize>(
        &self,
        theta: &[Lane; D],
        work: &mut FoldWork,
    ) -> ([[Lane; D]; D], [Lane; D]) {
        let FoldWork { weights, outputs, crosses, levels, gaps, rows, .. } = work;
        let (lines, points) = (self.lines(), self.phases.len());
        let period = self.period as f64;
        let one = Lane::splat(1.0);
        let (mut aa, mut bb) = ([Lane::ZERO; N], [Lane::ZERO; N]);
        let (mut ahead, mut behind) = ([Lane::ZERO; N], [Lane::ZERO; N]);
        let (mut normal, mut right) = ([[Lane::ZERO; D]; D], [Lane::ZERO; D]);
        crosses.clear();
        crosses.resize(self.ends.len() * lines, [[Lane::ZERO; 2]; 3]);
        gaps.clear();
        gaps.resize(self.gaps.len(), Lane::ZERO);
        let mut level_at_rest = Lane::ZERO;
        for k in 0..lines {
            keep_apart();
            let turns = &self.turns[k * self.period..(k + 1) * self.period];
            let (mut a, mut b) = ([one, Lane::ZERO], [Lane::ZERO; 2]);
            for i in 0..N {
                let [cos, sin] = turns[(i + 1) % self.period];
                a[0] += theta[i] * cos;
                a[1] -= theta[i] * sin;
                b[0] += theta[N + i] * cos;
                b[1] -= theta[N + i] * sin;
            }
            let inverse = one / (a[0] * a[0] + a[1] * a[1]);
            let a_inverse = [a[0] * inverse, Lane::ZERO - a[1] * inverse];
            let gain = times(b, a_inverse);
            let weight = weights[k];
            let weighted = [gain[0] * weight, gain[1] * weight];
            let power = weighted[0] * gain[0] + weighted[1] * gain[1];
            for (sum, gap) in gaps.iter_mut().zip(&self.gaps) {
                keep_apart();
                *sum += power * turns[*gap][0];
            }
            if k == 0 {
                level_at_rest = weighted[0] * period;
            }
            for (e, &[rest, _]) in self.ends.iter().enumerate() {
                keep_apart();
                let mut u = [Lane::splat(if k == 0 { period * rest } else { 0.0 }), Lane::ZERO];
                for (level, phase) in levels[e * points..(e + 1) * points].iter().zip(&self.phases) {
                    keep_apart();
                    let [cos, sin] = turns[*phase];
                    let pulse = *level - Lane::splat(rest);
                    u[0] += pulse * cos;
                    u[1] -= pulse * sin;
                }
                let z = times(gain, u);
                let output = outputs[e * lines + k];
                let mut left = [output[0] - z[0], output[1] - z[1]];
                let beta = times(u, a_inverse);
                let alpha = times(z, a_inverse);
                let alpha = [Lane::ZERO - alpha[0], Lane::ZERO - alpha[1]];
                let (alpha_weighted, beta_weighted) =
                    ([alpha[0] * weight, alpha[1] * weight], [beta[0] * weight, beta[1] * weight]);
                if k == 0 {
                    left[0] -= theta[2 * N] * period;
                    for i in 0..N {
                        normal[2 * N][i] += alpha_weighted[0] * period;
                        normal[2 * N][N + i] += beta_weighted[0] * period;
                    }
                    normal[2 * N][2 * N] += weight * (period * period);
                    right[2 * N] += weight * left[0] * period;
                }
                let alphas = alpha_weighted[0] * alpha[0] + alpha_weighted[1] * alpha[1];
                let betas = beta_weighted[0] * beta[0] + beta_weighted[1] * beta[1];
                let both = conj_times(alpha_weighted, beta);
                let (of_a, of_b) = (conj_times(alpha_weighted, left), conj_times(beta_weighted, left));
                for i in 0..N {
                    let [cos, sin] = turns[i % self.period];
                    aa[i] += alphas * cos;
                    bb[i] += betas * cos;
                    ahead[i] += turned(both, [cos, sin]);
                    behind[i] += turned(both, [cos, -sin]);
                    let next = turns[(i + 1) % self.period];
                    right[i] += turned(of_a, next);
                    right[N + i] += turned(of_b, next);
                }
                crosses[e * lines + k] =
                    [conj_times(weighted, alpha), conj_times(weighted, beta), conj_times(weighted, left)];
            }
        }
        for i in 0..N {
            for l in 0..N {
                if l <= i {
                    normal[i][l] = aa[i - l];
                    normal[N + i][N + l] = bb[i - l];
                }
                // The entry of b_i and a_l.
                normal[N + i][l] = if l >= i { ahead[l - i] } else { behind[i - l] };
            }
        }
        rows.clear();
        for crosses in crosses.chunks_exact(lines) {
            for &phase in &self.phases[1..] {
                let (mut of_a, mut of_b, mut of_left) = ([Lane::ZERO; N], [Lane::ZERO; N], Lane::ZERO);
                let mut places = [0; N];
                for i in 0..N {
                    places[i] = self.before(phase, i + 1);
                }
                for (cross, turns) in crosses.iter().zip(self.turns.chunks_exact(self.period)) {
                    keep_apart();
                    for i in 0..N {
                        of_a[i] += turned(cross[0], turns[places[i]]);
                        of_b[i] += turned(cross[1], turns[places[i]]);
                    }
                    of_left += turned(cross[2], turns[phase]);
                }
                rows.extend(of_a);
                rows.extend(of_b);
                rows.extend([level_at_rest, of_left]);
            }
        }
        (normal, right)
    }
}
