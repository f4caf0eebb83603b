//! Poles, as time constants or frequency and damping.

use crate::linear::roots;

/// A real pole, or a pair of conjugate ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mode {
    /// The pole.
    Real(f64),
    /// Natural frequency `ω`, radians per sample, and damping ratio `ζ` of `z = exp(ω(−ζ ± i√(1−ζ²)))`.
    Pair {
        /// Natural frequency, radians per sample.
        frequency: f64,
        /// Damping ratio, between 0 and 1.
        damping: f64,
    },
}

impl Mode {
    /// The modes of `1 + a₁q⁻¹ + …`, slowest first.
    pub(super) fn of(a: &[f64]) -> Vec<Self> {
        let mut poles = roots(&[&[1.0], a].concat());
        poles.sort_by(|p, q| q.norm().total_cmp(&p.norm()));
        let mode = |p: &nalgebra::Complex<f64>| {
            if p.im.abs() <= 1e-9 * p.norm() {
                return Some(Self::Real(p.re));
            }
            let s = p.ln();
            (p.im > 0.0).then(|| Self::Pair { frequency: s.norm(), damping: -s.re / s.norm() })
        };
        poles.iter().filter_map(mode).collect()
    }

    /// `a₁…` of the polynomial with these modes.
    pub(super) fn polynomial(modes: &[Self]) -> Vec<f64> {
        let mut a = vec![1.0];
        for mode in modes {
            let factor = match *mode {
                Self::Real(p) => vec![1.0, -p],
                Self::Pair { frequency, damping } => {
                    let radius = (-frequency * damping).exp();
                    let angle = frequency * (1.0 - damping * damping).max(0.0).sqrt();
                    vec![1.0, -2.0 * radius * angle.cos(), radius * radius]
                }
            };
            let mut product = vec![0.0; a.len() + factor.len() - 1];
            for (i, x) in a.iter().enumerate() {
                for (j, f) in factor.iter().enumerate() {
                    product[i + j] += x * f;
                }
            }
            a = product;
        }
        a.split_off(1)
    }

    /// Numerator of the sampled mode behind a zero-order hold, of unit gain at rest; its first coefficient is that of lag 1.
    ///
    /// K. J. Åström, B. Wittenmark, Computer-Controlled Systems (1997), table 2.1: `(1 − p)` of a real pole; of a pair `b₁ = 1 − α(β + ζω/w γ)`,
    /// `b₂ = α² + α(ζω/w γ − β)` with `w = ω√(1−ζ²)`, `α = exp(−ζω)`, `β = cos w`, `γ = sin w`.
    pub(super) fn sampled(self) -> Vec<f64> {
        match self {
            Self::Real(p) => vec![1.0 - p],
            Self::Pair { frequency, damping } => {
                let root = (1.0 - damping * damping).max(f64::MIN_POSITIVE).sqrt();
                let radius = (-frequency * damping).exp();
                let (sin, cos) = (frequency * root).sin_cos();
                let sin = damping / root * sin;
                vec![1.0 - radius * (cos + sin), radius * radius + radius * (sin - cos)]
            }
        }
    }

    /// Time constant of a real pole in samples, `−1/ln p`; none for a pole that is no lag of a machine in continuous time.
    pub fn time_constant(self) -> Option<f64> {
        match self {
            Self::Real(p) if p > 0.0 && p < 1.0 => Some(-1.0 / p.ln()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sampled_mode_answers_a_step_as_in_continuous_time() {
        let (frequency, damping) = (0.4_f64, 0.3_f64);
        let pair = Mode::Pair { frequency, damping };
        let (a, b) = (Mode::polynomial(&[pair]), pair.sampled());
        let (w, mut y) = (frequency * (1.0 - damping * damping).sqrt(), vec![0.0; 60]);
        for t in 1..60 {
            let before = |lag: usize| if t >= lag { y[t - lag] } else { 0.0 };
            y[t] = b[0] + if t > 1 { b[1] } else { 0.0 } - a[0] * before(1) - a[1] * before(2);
            let time = t as f64;
            let decay = (-damping * frequency * time).exp();
            let exact = 1.0 - decay * ((w * time).cos() + damping * frequency / w * (w * time).sin());
            assert!((y[t] - exact).abs() < 1e-9, "{t}");
        }
        let rest = 1.0 + Mode::polynomial(&[Mode::Real(0.8)])[0];
        assert!((Mode::Real(0.8).sampled()[0] - rest).abs() < 1e-12);
    }

    #[test]
    fn modes_and_coefficients_are_the_same_system() {
        for a in [vec![-0.7], vec![-1.2, 0.5], vec![-1.7, 0.72], vec![-2.1, 1.46, -0.336], vec![0.3]] {
            let again = Mode::polynomial(&Mode::of(&a));
            assert!(a.iter().zip(&again).all(|(x, y)| (x - y).abs() < 1e-9), "{a:?} {again:?}");
        }
        // z = exp(0.2(−0.5 ± i√0.75)).
        let a = Mode::polynomial(&[Mode::Pair { frequency: 0.2, damping: 0.5 }]);
        let Mode::Pair { frequency, damping } = Mode::of(&a)[0] else { panic!("a pair") };
        assert!((frequency - 0.2).abs() < 1e-12 && (damping - 0.5).abs() < 1e-12);
        assert!((Mode::Real((-0.25_f64).exp()).time_constant().unwrap() - 4.0).abs() < 1e-12);
    }
}
