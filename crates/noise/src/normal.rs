//! Two independent standard normals from 128 random bits, without a branch.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, LN_2};

/// `(atanh(s)/s − 1)/s²` in `s²`, for `|s| ≤ (√2 − 1)/(√2 + 1)`: minimax, relative error of `atanh` below
/// 2·10⁻¹⁶.
const ATANH: [f64; 6] = [
    0.333333333332954,
    0.200000000254344,
    0.14285708660840385,
    0.1111167989530475,
    0.090619926199456,
    0.08408045119068998,
];

/// `sin(πy/4)/y` in `y²`, for `|y| ≤ 1`: minimax, relative error below 4·10⁻¹⁸.
const SIN: [f64; 7] = [
    FRAC_PI_4,
    -0.08074551218828054,
    0.0024903945701887364,
    -3.6576204158456556e-05,
    3.1336162166369674e-07,
    -1.75714929444801e-09,
    6.877100941327137e-12,
];

/// `cos(πy/4)` in `y²`, for `|y| ≤ 1`: minimax, error below 5·10⁻¹⁷.
const COS: [f64; 7] = [
    1.0,
    -0.30842513753403783,
    0.015854344243741596,
    -0.0003259918864837572,
    3.590859180268447e-06,
    -2.4609507465651722e-08,
    1.1365481593200674e-10,
];

/// Horner's rule; a separate multiplication and addition at each step, never fused, so that every instruction
/// set rounds alike.
#[inline(always)]
fn polynomial<const N: usize>(c: &[f64; N], x: f64) -> f64 {
    let mut sum = c[N - 1];
    for k in (0..N - 1).rev() {
        sum = sum * x + c[k];
    }
    sum
}

/// The top 52 bits of a word as a uniform of the open interval (0, 1): `(k + ½)·2⁻⁵²`, exact.
#[inline(always)]
fn open_uniform(word: u64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    // 1 − 2⁻⁵³ = the largest number below one: the difference of two exact numbers with an exact result.
    f64::from_bits(ONE | (word >> 12)) - (1.0 - f64::EPSILON / 2.0)
}

/// `−2 ln u`, for a normal positive `u`.
///
/// `u = 2ᵏ·m` with `m` in [√½, √2), and `ln m = 2 atanh((m − 1)/(m + 1))`.
#[inline(always)]
fn minus_two_ln(u: f64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    const ROOT_HALF: u64 = FRAC_1_SQRT_2.to_bits();
    const MANTISSA: u64 = (1 << 52) - 1;
    // An integer below 2⁵² in the mantissa of 2⁵² reads as 2⁵² plus that integer: a conversion every vector
    // unit has.
    const TWO_52: u64 = 0x4330 << 48;
    // Neither addition can overflow; checked ones, as in development builds, would undo the vectorisation.
    let bits = u.to_bits().wrapping_add(ONE - ROOT_HALF);
    let exponent = f64::from_bits(TWO_52 | (bits >> 52)) - (4503599627370496.0 + 1023.0);
    let m = f64::from_bits((bits & MANTISSA).wrapping_add(ROOT_HALF));
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let tail = s * (z * polynomial(&ATANH, z));
    -(exponent * (2.0 * LN_2)) - 4.0 * (s + tail)
}

/// Two independent standard normals from two uniform words, by the polar form of Box and Muller (1958).
///
/// ```text
/// r = √(−2 ln u),  u = (k + ½)·2⁻⁵² from the upper 52 bits of `radius`
/// φ = π/4·v,       v = (k + ½)·2⁻⁵² from the upper 52 bits of `angle`
/// (±r cos φ, ±r sin φ), exchanged or not: the three lowest bits of `angle` choose the octant
/// ```
///
/// The joint law is symmetric in both signs and in the exchange exactly, not to rounding. The furthest value
/// is √(−2 ln 2⁻⁵³) = 8.57; the smallest radius is √(2·2⁻⁵³) = 1.5·10⁻⁸. The error of either value is below
/// 4·10⁻¹⁵ (a few units in the last place of the furthest values).
#[inline(always)]
pub(super) fn pair(radius: u64, angle: u64) -> (f64, f64) {
    const SIGN: u64 = 1 << 63;
    let r = minus_two_ln(open_uniform(radius)).sqrt();
    let v = open_uniform(angle);
    let z = v * v;
    let sin = r * (v * polynomial(&SIN, z));
    let cos = r * polynomial(&COS, z);
    let (first, second) = if angle & 4 == 0 { (cos, sin) } else { (sin, cos) };
    (
        f64::from_bits(first.to_bits() ^ (angle << 63)),
        f64::from_bits(second.to_bits() ^ ((angle << 62) & SIGN)),
    )
}
