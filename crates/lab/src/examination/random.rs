//! Numbers that depend on a seed and a position alone.

/// A well-mixed number from a seed and a position: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
pub fn scramble(seed: u64, position: u64) -> u64 {
    let mut z = seed.wrapping_add((position + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A number from 0 to 1, 1 excluded, from a seed and a position.
pub(crate) fn uniform(seed: u64, position: u64) -> f64 {
    (scramble(seed, position) >> 11) as f64 / (1_u64 << 53) as f64
}
