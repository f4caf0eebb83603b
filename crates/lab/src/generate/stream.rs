//! Random streams: one for each purpose of each record, all from the rig's seed.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What the randomness is for. Streams of different purposes never overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// The nominal system.
    Machine,
    /// The inputs of the records.
    Drive,
    /// What the machine has before any effect is put in.
    Base,
    /// What is put in, and how much.
    Cause,
    /// The shape numbers of the `i`-th effect.
    Shape(usize),
    /// The white equation error of a record.
    Noise(usize),
    /// What the `i`-th effect draws at one of its five hooks in a record.
    Effect {
        /// Position of the effect in the rig.
        effect: usize,
        /// Position of the record in the dataset.
        record: usize,
    },
}

/// The stream of `purpose` in the rig of `seed`.
pub(crate) fn stream(seed: u64, purpose: Purpose) -> ChaCha8Rng {
    let number = match purpose {
        Purpose::Machine => 0,
        Purpose::Drive => 1,
        Purpose::Base => 2,
        Purpose::Cause => 3,
        Purpose::Shape(effect) => 16 + effect as u64,
        Purpose::Noise(record) => 1 << 16 | record as u64,
        Purpose::Effect { effect, record } => 1 << 32 | (effect as u64) << 16 | record as u64,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(number);
    rng
}
