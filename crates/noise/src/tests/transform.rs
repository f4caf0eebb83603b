use std::f64::consts::FRAC_PI_4;

use proptest::prelude::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::normal::pair;
use crate::{BLOCK, StreamId, WhiteNoise, Width, white_samples};

/// The definition, with the standard library's functions.
fn pair_by_definition(radius: u64, angle: u64) -> (f64, f64) {
    let uniform = |word: u64| ((word >> 12) as f64 + 0.5) / 2f64.powi(52);
    let u = uniform(radius);
    // Near one, ln loses no digit where its argument is the distance from one.
    let ln = if u > 0.5 { (-(1.0 - u)).ln_1p() } else { u.ln() };
    let r = (-2.0 * ln).sqrt();
    let (sin, cos) = (FRAC_PI_4 * uniform(angle)).sin_cos();
    let (first, second) = if angle & 4 == 0 { (cos, sin) } else { (sin, cos) };
    let sign = |bit: u64| if angle & bit == 0 { 1.0 } else { -1.0 };
    (r * first * sign(1), r * second * sign(2))
}

fn error(radius: u64, angle: u64) -> f64 {
    let (a, b) = pair(radius, angle);
    let (x, y) = pair_by_definition(radius, angle);
    (a - x).abs().max((b - y).abs())
}

proptest! {
    #[test]
    fn the_transform_is_box_and_mullers(radius: u64, angle: u64) {
        prop_assert!(error(radius, angle) < 4e-15);
    }
}

#[test]
fn the_error_is_below_the_documented_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let ends = [0, 1 << 12, u64::MAX, u64::MAX - (1 << 12), 1 << 63];
    let corners = ends.iter().flat_map(|&r| ends.iter().map(move |&a| (r, a)));
    let shifts = (0..2_000_000).map(|i| (rng.next_u64() >> (i % 52), rng.next_u64()));
    let worst = corners.chain(shifts).map(|(r, a)| error(r, a)).fold(0.0, f64::max);
    assert!(worst < 4e-15, "{worst:e}");
}

#[test]
fn the_furthest_value_is_beyond_eight_standard_deviations() {
    let (far, _) = pair(0, 0);
    assert!((far - (2.0 * 53.0 * std::f64::consts::LN_2).sqrt()).abs() < 1e-14);
    let (near, other) = pair(u64::MAX, 0);
    assert!((near / 2f64.powi(-26) - 1.0).abs() < 1e-15 && other > 0.0, "{near:e} {other:e}");
}

/// One replicate's noise has the same bits at any width and beside any neighbours.
#[test]
fn widths_agree_to_the_bit() {
    for width in Width::available() {
        for first in [0, 3, u32::MAX - 2] {
            let mut noise = WhiteNoise::new(width, StreamId { seed: 11, experiment: 2, replicate: first });
            let lanes = noise.lanes();
            let mut block = vec![0.0; BLOCK * lanes];
            for b in 0..3 {
                noise.fill(&mut block);
                for l in 0..lanes {
                    let replicate = first.wrapping_add(l as u32);
                    let alone = white_samples(StreamId { seed: 11, experiment: 2, replicate }, 3 * BLOCK);
                    let lane: Vec<f64> = block.iter().skip(l).step_by(lanes).copied().collect();
                    assert_eq!(lane, alone[b * BLOCK..(b + 1) * BLOCK], "{width:?}, replicate {replicate}");
                }
            }
        }
    }
}

/// The words of the reference generator, two a pair, in its own order.
#[test]
fn the_noise_is_the_transform_of_the_reference_stream() {
    let stream = StreamId { seed: 5, experiment: 1, replicate: 9 };
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    rng.set_stream(stream.number());
    for w in white_samples(stream, 200).chunks(2) {
        let (radius, angle) = (rng.next_u64(), rng.next_u64());
        assert_eq!((w[0], w[1]), pair(radius, angle));
    }
}

#[test]
fn value_stability() {
    let w = white_samples(StreamId { seed: 1, experiment: 0, replicate: 0 }, 6);
    assert_eq!(
        w,
        [
            -1.3464569470844512,
            -0.0851192787311182,
            1.001397100935051,
            -0.1742244275013513,
            1.346496567502262,
            0.8406480819158925
        ]
    );
}
