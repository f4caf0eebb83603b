//! Eight replicates abreast.

use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

/// Replicates in a [`Lane`]. Fixed, so that nothing depends on the processor.
pub const LANES: usize = 8;

/// One number of eight replicates. No operation crosses from one to another, so a replicate's results are the same bits whatever its neighbours.
///
/// It begins at a cache line, so that no full-width load or store straddles two.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lane(pub [f64; LANES]);

impl Lane {
    /// All zero.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// The same number in every replicate.
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    /// Square roots.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let mut result = self;
        for l in 0..LANES {
            result.0[l] = self.0[l].sqrt();
        }
        result
    }

    /// Moduli.
    #[inline(always)]
    pub fn abs(self) -> Self {
        let mut result = self;
        for l in 0..LANES {
            result.0[l] = self.0[l].abs();
        }
        result
    }

    /// The larger of each two; of a number and what is none, the latter.
    #[inline(always)]
    pub fn larger(self, other: Self) -> Self {
        let mut result = self;
        for l in 0..LANES {
            result.0[l] = if self.0[l] >= other.0[l] || self.0[l].is_nan() { self.0[l] } else { other.0[l] };
        }
        result
    }

    /// The larger of each and `floor`.
    #[inline(always)]
    pub fn at_least(self, floor: f64) -> Self {
        let mut result = self;
        for l in 0..LANES {
            if self.0[l] < floor {
                result.0[l] = floor;
            }
        }
        result
    }

    /// 1 where it is at most the other, else 0.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Self {
        let mut result = self;
        for l in 0..LANES {
            result.0[l] = if self.0[l] <= other.0[l] { 1.0 } else { 0.0 };
        }
        result
    }

    /// Each where `chosen`, else `other`.
    #[inline(always)]
    pub fn where_or(self, chosen: &[bool; LANES], other: Self) -> Self {
        let mut result = other;
        for l in 0..LANES {
            if chosen[l] {
                result.0[l] = self.0[l];
            }
        }
        result
    }
}

impl Default for Lane {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

macro_rules! operator {
    ($operator:ident, $name:ident, $symbol:tt) => {
        impl $operator for Lane {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let mut result = self;
                for l in 0..LANES {
                    result.0[l] = self.0[l] $symbol other.0[l];
                }
                result
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Mul<f64> for Lane {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Self::splat(factor)
    }
}

impl AddAssign for Lane {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lane {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
