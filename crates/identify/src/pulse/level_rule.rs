//! How a method reads a level off its regression.

use super::arrow::{ArrowFit, Gradient};
use nalgebra::DVector;

/// A level's value relative to the base of the levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LevelRule {
    /// Not estimated.
    Known(f64),
    /// `Σᵢ bᵢhᵢ / Σᵢ bᵢ² + plus` (3.24b), the free means `hᵢ` being the local columns `first…first+n−1`.
    RankOne { first: usize, plus: f64 },
    /// A local column itself.
    Local(usize),
}

impl LevelRule {
    /// The level in a regression of order `n`, and its derivative.
    pub(crate) fn read(self, fit: &ArrowFit, n: usize) -> (f64, Gradient) {
        let mut core = DVector::zeros(fit.core.len());
        match self {
            Self::Known(value) => (value, Gradient { core, local: Vec::new() }),
            Self::Local(local) => (fit.local[local], Gradient { core, local: vec![(local, 1.0)] }),
            Self::RankOne { first, plus } => {
                let b = fit.core.rows(n, n);
                let h = &fit.local[first..first + n];
                let norm: f64 = b.iter().map(|x| x * x).sum();
                let inner: f64 = b.iter().zip(h).map(|(b, h)| b * h).sum();
                for i in 0..n {
                    core[n + i] = h[i] / norm - 2.0 * b[i] * inner / (norm * norm);
                }
                let local = (0..n).map(|i| (first + i, b[i] / norm)).collect();
                (inner / norm + plus, Gradient { core, local })
            }
        }
    }

    /// `first` and `plus` of a level of rank one.
    pub(super) fn rank_one(self) -> Option<(usize, f64)> {
        match self {
            Self::RankOne { first, plus } => Some((first, plus)),
            Self::Known(_) | Self::Local(_) => None,
        }
    }
}
