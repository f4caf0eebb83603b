//! The ChaCha8 block function, many streams abreast.

/// A key, as the eight words of the cipher's state.
pub(super) type Key = [u32; 8];

/// Words of one ChaCha block.
pub(super) const WORDS: usize = 16;

/// "expand 32-byte k", the cipher's four constant words.
const SIGMA: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];

macro_rules! quarter_round {
    ($x:ident, $a:literal, $b:literal, $c:literal, $d:literal) => {
        $x[$a] = $x[$a].wrapping_add($x[$b]);
        $x[$d] = ($x[$d] ^ $x[$a]).rotate_left(16);
        $x[$c] = $x[$c].wrapping_add($x[$d]);
        $x[$b] = ($x[$b] ^ $x[$c]).rotate_left(12);
        $x[$a] = $x[$a].wrapping_add($x[$b]);
        $x[$d] = ($x[$d] ^ $x[$a]).rotate_left(8);
        $x[$c] = $x[$c].wrapping_add($x[$d]);
        $x[$b] = ($x[$b] ^ $x[$c]).rotate_left(7);
    };
}

macro_rules! double_round {
    ($x:ident) => {
        quarter_round!($x, 0, 4, 8, 12);
        quarter_round!($x, 1, 5, 9, 13);
        quarter_round!($x, 2, 6, 10, 14);
        quarter_round!($x, 3, 7, 11, 15);
        quarter_round!($x, 0, 5, 10, 15);
        quarter_round!($x, 1, 6, 11, 12);
        quarter_round!($x, 2, 7, 8, 13);
        quarter_round!($x, 3, 4, 9, 14);
    };
}

/// Block number `counter` of each of `L` streams under one key: `out[w][l]` is word `w` of stream
/// `streams[l]`.
///
/// The layout is the one of `rand_chacha`: words 12 and 13 count blocks, words 14 and 15 hold the stream, low
/// word first (D. J. Bernstein, "ChaCha, a variant of Salsa20", 2008, with a 64-bit counter and a 64-bit
/// nonce).
///
/// The body of the lane loop is straight-line code on sixteen scalars, which the compiler turns into sixteen
/// vector registers.
#[inline(always)]
pub(super) fn blocks<const L: usize>(
    key: &Key,
    streams: &[u64; L],
    counter: u64,
    out: &mut [[u32; L]; WORDS],
) {
    // Words of one size throughout: a 64-bit value in the loop would halve the lanes that the compiler puts
    // in a register.
    let low = streams.map(|stream| stream as u32);
    let high = streams.map(|stream| (stream >> 32) as u32);
    for l in 0..L {
        let start = [
            SIGMA[0],
            SIGMA[1],
            SIGMA[2],
            SIGMA[3],
            key[0],
            key[1],
            key[2],
            key[3],
            key[4],
            key[5],
            key[6],
            key[7],
            counter as u32,
            (counter >> 32) as u32,
            low[l],
            high[l],
        ];
        let mut x = start;
        double_round!(x);
        double_round!(x);
        double_round!(x);
        double_round!(x);
        for w in 0..WORDS {
            out[w][l] = x[w].wrapping_add(start[w]);
        }
    }
}
