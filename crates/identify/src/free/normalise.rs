//! From a fit in its own scale to the paper's normalisation, with standard errors.

use super::basis::Basis;
use super::problem::{Parameters, Structure};
use super::units::OutputUnits;
use crate::{BorderPoint, Estimate, LevelErrors};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Covariance of `(a, b, f, c)` in the fit's own scale.
///
/// The scale shared by `b` and `f` is free, so the information matrix has the null direction `(0, b, −f, 0)`. Every normalised
/// parameter is blind to it; giving that direction some information makes the matrix invertible and changes none of them.
#[derive(Debug, Clone)]
pub(super) struct Covariance {
    factor: Cholesky<f64, nalgebra::Dyn>,
    /// Columns are scaled to unit information before the factorisation.
    scale: DVector<f64>,
    noise_variance: f64,
    /// `ΣgₖgₖᵀT` over batches of samples, for residuals that are not white.
    meat: Option<DMatrix<f64>>,
}

impl Covariance {
    /// From the information matrix per unit noise variance; `None` if a parameter has no information.
    pub(super) fn new(information: &DMatrix<f64>, theta: &Parameters, noise_variance: f64) -> Option<Self> {
        let (mut scaled, scale) = scaled_information(information, theta)?;
        for i in 0..scale.len() {
            scaled[(i, i)] += 1e-13;
        }
        Some(Self { factor: scaled.cholesky()?, scale, noise_variance, meat: None })
    }

    /// Adds the scatter of the gradient over batches of samples (the "sandwich").
    pub(super) fn with_batches(mut self, batches: &[DVector<f64>]) -> Self {
        let p = self.scale.len();
        let mut meat = DMatrix::zeros(p, p);
        for g in batches {
            let g = g.component_div(&self.scale);
            meat.ger(1.0, &g, &g, 1.0);
        }
        self.meat = Some(meat);
        self
    }

    /// What the information makes of a score: the first-order change of `(a, b, f, c)`.
    pub(super) fn response(&self, score: &DVector<f64>) -> DVector<f64> {
        self.factor.solve(&score.component_div(&self.scale)).component_div(&self.scale)
    }

    /// The covariance itself, row by row, in the scale of the fit.
    ///
    /// Where residuals are not white it is the least upper bound `S Q max(1, Λ) Qᵀ Sᵀ` of both estimates in the basis that makes both
    /// diagonal, `σ²M⁻¹ = S Sᵀ` and `M⁻¹ meat M⁻¹ = S Q Λ Qᵀ Sᵀ`: no standard error by it is below [`Self::standard_error`].
    pub(super) fn matrix(&self) -> DMatrix<f64> {
        let p = self.scale.len();
        let lower = self.factor.l();
        let sd = self.noise_variance.sqrt();
        // S = σ F⁻ᵀ for M = F Fᵀ.
        let inverse = lower.clone().solve_lower_triangular(&DMatrix::identity(p, p));
        let root = inverse.map_or_else(|| DMatrix::zeros(p, p), |inverse| inverse.transpose() * sd);
        let between = self.meat.as_ref().and_then(|meat| {
            let half = lower.solve_lower_triangular(meat)?;
            lower.solve_lower_triangular(&half.transpose())
        });
        let root = match between {
            Some(between) if self.noise_variance > 0.0 => {
                let symmetric = (&between + between.transpose()) * (0.5 / self.noise_variance);
                let eigen = symmetric.symmetric_eigen();
                let stretch = eigen.eigenvalues.map(|x| x.max(1.0).sqrt());
                root * eigen.eigenvectors * DMatrix::from_diagonal(&stretch)
            }
            _ => root,
        };
        let covariance = &root * root.transpose();
        DMatrix::from_fn(p, p, |i, j| covariance[(i, j)] / (self.scale[i] * self.scale[j]))
    }

    /// Standard error of a parameter with the given derivatives: the larger of the two estimates.
    pub(super) fn standard_error(&self, derivative: &DVector<f64>) -> f64 {
        let d = derivative.component_div(&self.scale);
        let x = self.factor.solve(&d);
        let white = self.noise_variance * d.dot(&x);
        let coloured = self.meat.as_ref().map_or(0.0, |m| x.dot(&(m * &x)));
        white.max(coloured).max(0.0).sqrt()
    }
}

/// The information matrix with columns scaled to unit information and the null direction filled, and the scale; `None` if a parameter has
/// no information.
pub(super) fn scaled_information(
    information: &DMatrix<f64>,
    theta: &Parameters,
) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let p = information.nrows();
    let scale = DVector::from_fn(p, |i, _| information[(i, i)].sqrt());
    if !scale.iter().all(|&s| s > 0.0) {
        return None;
    }
    let mut gauge = DVector::zeros(p);
    let (n, nb) = (theta.a.len(), theta.b.len());
    for (i, b) in theta.b.iter().enumerate() {
        gauge[n + i] = b * scale[n + i];
    }
    for (k, f) in theta.f.iter().enumerate() {
        gauge[n + nb + k] = -f * scale[n + nb + k];
    }
    let gauge = gauge.normalize();
    let mut scaled = DMatrix::from_fn(p, p, |i, j| information[(i, j)] / (scale[i] * scale[j]));
    scaled.ger(1.0, &gauge, &gauge, 1.0);
    Some((scaled, scale))
}

/// Which difference of knot values is set to one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// Knot values counted from the reference knot, which is number 0.
    low: usize,
    high: usize,
    pub(super) value: f64,
    /// Whether this is the paper's `u_M − u_m`.
    pub(super) is_papers: bool,
}

impl Span {
    /// `u_M − u_m`, of either sign, unless it is lost in the range of the curves (below a thousandth); then that range.
    pub(super) fn of(f: &[f64]) -> Self {
        let value = |k: usize| if k == 0 { 0.0 } else { f[k - 1] };
        let by_value = |x: &usize, y: &usize| value(*x).total_cmp(&value(*y));
        let low = (0..=f.len()).min_by(by_value).unwrap_or(0);
        let high = (0..=f.len()).max_by(by_value).unwrap_or(0);
        let range = value(high) - value(low);
        let papers = value(f.len());
        if papers.abs() > 1e-3 * range {
            Self { low: 0, high: f.len(), value: papers, is_papers: true }
        } else {
            Self { low, high, value: range, is_papers: false }
        }
    }
}

/// What else an [`Estimate`] reports, of the centred output, and the units that it reports in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figures {
    pub(super) noise_sd: f64,
    pub(super) excitation: f64,
    pub(super) samples: usize,
    pub(super) units: OutputUnits,
}

/// Below this share of `Σ|bᵢ|`, `B(1)` counts as zero and the level of `u` as unknown.
const NO_GAIN: f64 = 1e-9;

/// Whether `B(1)` shows the level of `u`.
pub(super) fn has_gain(theta: &Parameters) -> bool {
    theta.b.iter().sum::<f64>().abs() > NO_GAIN * theta.b.iter().map(|b| b.abs()).sum::<f64>()
}

/// A normalised parameter with its derivatives in `(a, b, f, c)`.
#[derive(Debug)]
pub(super) struct Quantity {
    pub(super) value: f64,
    pub(super) derivative: DVector<f64>,
}

/// `a`, `b`, the points of the descending border (or the only curve), and those of the ascending one, in the normalisation `u_M − u_m = 1`.
///
/// With `k = u_M − u_m` in the fit's scale: `b̂ = k b`, `F̂ = (f + c/B(1))/k`, so that `B̂(1)/Â(1)·F̂` is the stationary output. `theta` is of a
/// centred output; the quantities are those of the output in its `units`, where `c/B(1)` is `(c + origin·A(1)/scale)/B(1)`.
pub(super) fn quantities(theta: &Parameters, basis: &Basis, units: OutputUnits) -> Vec<Quantity> {
    let (n, nb, m) = (theta.a.len(), theta.b.len(), theta.f.len());
    let p = n + nb + m + 1;
    let span = Span::of(&theta.f);
    let knot = |k: usize| if k == 0 { 0.0 } else { theta.f[k - 1] };
    let b_one: f64 = theta.b.iter().sum();
    let a_one = 1.0 + theta.a.iter().sum::<f64>();
    let origin = units.relative_origin();
    let level = if has_gain(theta) { (theta.c + origin * a_one) / b_one } else { 0.0 };
    // Adds `x` times the derivative of knot value k.
    let add_knot = |d: &mut DVector<f64>, k: usize, x: f64| {
        if k > 0 {
            d[n + nb + k - 1] += x;
        }
    };
    let a = (0..n).map(|i| Quantity {
        value: theta.a[i],
        derivative: DVector::from_fn(p, |j, _| f64::from(u8::from(i == j))),
    });
    let b = (0..nb).map(|i| {
        let mut derivative = DVector::zeros(p);
        derivative[n + i] = span.value;
        add_knot(&mut derivative, span.high, theta.b[i]);
        add_knot(&mut derivative, span.low, -theta.b[i]);
        Quantity { value: units.scale * theta.b[i] * span.value, derivative: derivative * units.scale }
    });
    let points = (0..basis.sizes().sum()).map(|k| {
        let value = (knot(k) + level) / span.value;
        let mut derivative = DVector::zeros(p);
        add_knot(&mut derivative, k, 1.0 / span.value);
        add_knot(&mut derivative, span.high, -value / span.value);
        add_knot(&mut derivative, span.low, value / span.value);
        if has_gain(theta) {
            derivative[p - 1] += 1.0 / (b_one * span.value);
            for i in 0..n {
                derivative[i] += origin / (b_one * span.value);
            }
            for i in 0..nb {
                derivative[n + i] -= level / (b_one * span.value);
            }
        }
        Quantity { value, derivative }
    });
    a.chain(b).chain(points).collect()
}

/// Standard errors of the gain and of both stationary outputs, by the delta method; in output units, as `theta` is of a centred output.
pub(super) fn level_errors(theta: &Parameters, covariance: &Covariance, units: OutputUnits) -> LevelErrors {
    let (n, nb, m) = (theta.a.len(), theta.b.len(), theta.f.len());
    let (a_one, b_one) = (1.0 + theta.a.iter().sum::<f64>(), theta.b.iter().sum::<f64>());
    let span = Span::of(&theta.f);
    // `(B(1)·u + constant·c)/A(1)`, where `u` is a sum of knot values with signs.
    let error = |u: f64, knots: &[(usize, f64)], constant: f64| {
        let y = (b_one * u + constant * theta.c) / a_one;
        let mut derivative = DVector::zeros(n + nb + m + 1);
        derivative.rows_mut(0, n).fill(-y / a_one);
        derivative.rows_mut(n, nb).fill(u / a_one);
        for &(k, sign) in knots.iter().filter(|(k, _)| *k > 0) {
            derivative[n + nb + k - 1] += sign * b_one / a_one;
        }
        derivative[n + nb + m] = constant / a_one;
        units.scale * covariance.standard_error(&derivative)
    };
    LevelErrors {
        gain: error(span.value, &[(span.high, 1.0), (span.low, -1.0)], 0.0),
        y_high: error(theta.f[m - 1], &[(m, 1.0)], 1.0),
        y_low: error(0.0, &[], 1.0),
    }
}

/// The fit as an [`Estimate`] in the `units` of the output, standard errors by the delta method.
pub(super) fn normalise(
    theta: &Parameters,
    structure: Structure,
    basis: &Basis,
    covariance: Option<&Covariance>,
    Figures { noise_sd, excitation, samples, units }: Figures,
) -> Estimate {
    let (n, nb, m) = (theta.a.len(), theta.b.len(), theta.f.len());
    let a_one: f64 = 1.0 + theta.a.iter().sum::<f64>();
    let b_one: f64 = theta.b.iter().sum();
    let parameters: Vec<(f64, f64)> = quantities(theta, basis, units)
        .into_iter()
        .map(|q| (q.value, covariance.map_or(f64::NAN, |c| c.standard_error(&q.derivative))))
        .collect();
    let (a, rest) = parameters.split_at(n);
    let (b, points) = rest.split_at(nb);
    let curve = |knots: &[f64], first: usize| {
        knots.iter().zip(&points[first..]).map(|(&v, &(f, se))| BorderPoint { v, f, se }).collect()
    };
    let first = if basis.is_switched() { basis.descending().len() } else { 0 };
    let (a, a_se) = a.iter().copied().unzip();
    let (b, b_se) = b.iter().copied().unzip();
    Estimate {
        a,
        a_se,
        b,
        b_se,
        delay: structure.delay,
        noise_sd: units.scale * noise_sd,
        gain: units.scale * b_one * Span::of(&theta.f).value / a_one,
        y_high: units.level((b_one * theta.f[m - 1] + theta.c) / a_one),
        y_low: units.level(theta.c / a_one),
        descending: curve(basis.descending(), 0),
        ascending: curve(basis.ascending(), first),
        excitation,
        samples,
    }
}
