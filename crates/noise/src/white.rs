//! Unit white normal noise, one ChaCha8 stream a replicate, replicates in lanes.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::chacha::{self, Key, WORDS};
use super::normal;
use super::width::{Kernel, Width};

/// Normals in one ChaCha block: 512 bits, 64 a normal.
const PER_BLOCK: usize = WORDS / 2;

/// Samples a replicate that [`WhiteNoise::fill`] gives at a time.
pub const BLOCK: usize = 128;

/// Names the noise of one replicate of one experiment of one study.
///
/// The noise is ChaCha8 under the key that `ChaCha8Rng::seed_from_u64(seed)` derives, on stream number
/// `experiment·2³² + replicate`, from its first block. Different streams of one key do not overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StreamId {
    /// Seed of the study.
    pub seed: u64,
    /// Experiment within the replicate (descendant, ascendant, step, …).
    pub experiment: u32,
    /// Replicate.
    pub replicate: u32,
}

impl StreamId {
    /// The stream number `experiment·2³² + replicate`.
    #[cfg(test)]
    pub(crate) fn number(self) -> u64 {
        u64::from(self.experiment) << 32 | u64::from(self.replicate)
    }
}

/// White normal noise of as many replicates as the width has lanes, in blocks of [`BLOCK`] samples.
///
/// Lane `l` carries replicate `first.replicate + l` (modulo 2³²). Its noise depends on its own [`StreamId`]
/// alone: not on the width, its neighbours or the thread.
///
/// ```
/// # use switchback_noise::{BLOCK, StreamId, WhiteNoise, Width};
/// let first = StreamId { seed: 1, experiment: 0, replicate: 0 };
/// let mut noise = WhiteNoise::new(Width::detect(), first);
/// let mut block = vec![0.0; BLOCK * noise.lanes()];
/// noise.fill(&mut block);
/// let replicate_0: Vec<f64> = block.iter().step_by(noise.lanes()).copied().collect();
/// assert_eq!(replicate_0.len(), BLOCK);
/// ```
#[derive(Clone, Debug)]
pub struct WhiteNoise {
    width: Width,
    key: Key,
    streams: Vec<u64>,
    counter: u64,
}

impl WhiteNoise {
    /// The noise of replicates `first.replicate`, `first.replicate + 1`, …, from its beginning.
    pub fn new(width: Width, first: StreamId) -> Self {
        let seed = ChaCha8Rng::seed_from_u64(first.seed).get_seed();
        let (words, _) = seed.as_chunks::<4>();
        let mut key = [0; 8];
        for (word, bytes) in key.iter_mut().zip(words) {
            *word = u32::from_le_bytes(*bytes);
        }
        let mut noise = Self { width, key, streams: vec![0; width.lanes()], counter: 0 };
        noise.restart(first.experiment, first.replicate);
        noise
    }

    /// Goes to the beginning of the noise of other replicates under the same seed.
    pub(crate) fn restart(&mut self, experiment: u32, replicate: u32) {
        for (l, stream) in self.streams.iter_mut().enumerate() {
            *stream = u64::from(experiment) << 32 | u64::from(replicate.wrapping_add(l as u32));
        }
        self.counter = 0;
    }

    /// Replicates abreast.
    pub fn lanes(&self) -> usize {
        self.width.lanes()
    }

    /// The next [`BLOCK`] samples of every lane: `out[t·lanes + l]` is sample `t` of lane `l`.
    ///
    /// # Panics
    /// If `out` does not hold `BLOCK·lanes` values.
    pub fn fill(&mut self, out: &mut [f64]) {
        assert_eq!(
            out.len(),
            BLOCK * self.lanes(),
            "a block of noise is {BLOCK} samples by {} lanes",
            self.lanes()
        );
        self.width.run(Fill { key: &self.key, streams: &self.streams, counter: self.counter, out });
        self.counter += (BLOCK / PER_BLOCK) as u64;
    }
}

/// One block of every lane, from the start of a cache line on.
#[repr(align(64))]
struct Words<const L: usize>([[u32; L]; WORDS]);

/// Fills `out` with the blocks from `counter` on.
struct Fill<'a> {
    key: &'a Key,
    streams: &'a [u64],
    counter: u64,
    out: &'a mut [f64],
}

impl Kernel for Fill<'_> {
    #[inline(always)]
    fn run<const L: usize>(self) {
        let (rows, _) = self.out.as_chunks_mut::<L>();
        let (blocks, _) = rows.as_chunks_mut::<PER_BLOCK>();
        let streams: &[u64; L] = self.streams.try_into().expect("one stream a lane");
        let mut words = Words([[0; L]; WORDS]);
        for (counter, rows) in (self.counter..).zip(blocks) {
            chacha::blocks(self.key, streams, counter, &mut words.0);
            for q in 0..PER_BLOCK / 2 {
                let (w, x) = (&words.0[4 * q..4 * q + 4], &mut rows[2 * q..2 * q + 2]);
                let mut first = [0.0; L];
                let mut second = [0.0; L];
                for l in 0..L {
                    let radius = u64::from(w[0][l]) | u64::from(w[1][l]) << 32;
                    let angle = u64::from(w[2][l]) | u64::from(w[3][l]) << 32;
                    (first[l], second[l]) = normal::pair(radius, angle);
                }
                x[0] = first;
                x[1] = second;
            }
        }
    }
}
