//! What, beside the sources, the last digit of a result depends on.

use crate::output::sha256;
use std::fmt::Write;

/// Processor, system, and a hash of what the mathematical library gives: `x86_64-unknown-linux-gnu 1f3a…`.
///
/// The C library's functions differ in the last digit from one version to the next. Sums that were kept on one platform are therefore
/// not gone on with on another.
pub fn platform() -> String {
    format!("{} {}", env!("TARGET"), &mathematics()[..16])
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
