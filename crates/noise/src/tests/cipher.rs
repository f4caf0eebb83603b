use proptest::prelude::*;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::{StreamId, chacha};

fn reference(seed: u64, stream: u64, block: u64) -> Vec<u32> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng.set_word_pos(u128::from(block) * 16);
    (0..16).map(|_| rng.next_u32()).collect()
}

fn key(seed: u64) -> chacha::Key {
    let bytes = ChaCha8Rng::seed_from_u64(seed).get_seed();
    std::array::from_fn(|w| u32::from_le_bytes(std::array::from_fn(|b| bytes[4 * w + b])))
}

proptest! {
    /// Every lane is the reference implementation's stream of that number, block by block.
    #[test]
    fn lanes_are_chacha8(seed: u64, streams: [u64; 8], block in prop_oneof![Just(0), Just(u64::from(u32::MAX)), any::<u64>()]) {
        let mut words = [[0; 8]; 16];
        chacha::blocks(&key(seed), &streams, block, &mut words);
        for l in 0..8 {
            let lane: Vec<u32> = words.iter().map(|w| w[l]).collect();
            prop_assert_eq!(lane, reference(seed, streams[l], block));
        }
    }
}

#[test]
fn replicates_and_experiments_have_streams_of_their_own() {
    let id = |experiment, replicate| StreamId { seed: 0, experiment, replicate }.number();
    assert_eq!([id(0, 0), id(0, 1), id(1, 0)], [0, 1, 1 << 32]);
    assert_eq!(id(u32::MAX, u32::MAX), u64::MAX);
}
