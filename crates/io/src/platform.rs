//! What, beside the sources, the last digit of a result depends on; and how memory is kept.

use crate::output::sha256;
use std::fmt::Write;
use std::hint::black_box;

/// Processor, system, and a hash of what the mathematical library gives: `x86_64-linux 1f3a…`.
///
/// The C library's functions differ in the last digit from one version to the next. Sums that were kept on one platform are therefore
/// not continued on another.
pub fn platform() -> String {
    format!("{} {}", target(), &mathematics()[..16])
}

/// Processor and system: `x86_64-linux`.
fn target() -> String {
    format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)
}

/// SHA-256 of the bits of the functions that the program uses, at a thousand points.
fn mathematics() -> String {
    let functions: [fn(f64) -> f64; 12] = [
        f64::exp,
        f64::ln,
        f64::sin,
        f64::cos,
        f64::tan,
        f64::atan,
        f64::tanh,
        f64::cbrt,
        f64::exp_m1,
        f64::ln_1p,
        |x| x.powf(1.7),
        |x| x.hypot(0.3),
    ];
    let mut bits = String::new();
    for k in 1..=1000 {
        let x = f64::from(k) * 0.0123;
        for function in functions {
            let _ = write!(bits, "{:x} ", function(x).to_bits());
        }
    }
    sha256(bits)
}

/// A diagnosis takes and leaves thousands of blocks of some ten thousand bytes. The GNU C library hands them back to the system and
/// asks for them again, at a cost of a tenth of the time, until it has seen a large block come back: from then on it keeps up to twice
/// as much. Call it once, early. Elsewhere this does nothing.
pub fn keep_memory() {
    /// Of larger blocks it learns nothing.
    const LARGE: usize = 31 << 20;
    drop(black_box(Vec::<u8>::with_capacity(LARGE)));
}
