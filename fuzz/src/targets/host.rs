//! What the process of an FMU says: outputs of the records asked for, or a reason, whatever it writes.

use switchback_host::heard;

/// Samples of the records.
const LENGTHS: [usize; 3] = [2, 1, 4];

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    let mut steps = 0;
    let end = heard(&LENGTHS, bytes, || steps += 1);
    assert!(end.runs.len() <= LENGTHS.len() && steps <= bytes.iter().filter(|byte| **byte == b'\n').count());
    for (y, length) in end.runs.iter().zip(LENGTHS) {
        assert!(y.len() == length && y.iter().all(|y| y.is_finite()));
    }
    // In pieces of any size it says the same.
    let slow = std::io::BufReader::with_capacity(3, bytes);
    assert_eq!(heard(&LENGTHS, slow, || ()), end);
}
