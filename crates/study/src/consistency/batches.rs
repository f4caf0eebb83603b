//! The batches in which replicates are run, kept and added up.

use super::cost;
use super::sections::SECTIONS;
use crate::scenario::Scenario;
use std::ops::{Range, RangeInclusive};

/// Least and largest number of replicates in a batch: every section gets one of them at least; and what begins anew with each batch costs
/// less a replicate in the larger, and memory more.
const SIZES: [usize; 2] = [SECTIONS, 8 * SECTIONS];

/// Seconds of one thread that a batch takes where a replicate is dear: what is lost of a run that is killed.
const SECONDS: f64 = 2.0;

/// Replicates `k·size` to `(k+1)·size − 1` make batch `k`. The size follows from the scenario, whatever the number of replicates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Batches {
    size: usize,
}

impl Batches {
    pub(super) fn of(scenario: &Scenario) -> Self {
        let [least, largest] = SIZES;
        let affordable = (SECONDS / cost::of_a_replicate(scenario)) as usize;
        let size = if affordable < 2 * least { least } else { 1 << affordable.min(largest).ilog2() };
        Self { size }
    }

    #[cfg(test)]
    pub(super) fn with_size(size: usize) -> Self {
        Self { size }
    }

    pub(super) fn size(self) -> usize {
        self.size
    }

    /// A run of replicates in pieces, each within one batch.
    pub(super) fn pieces(self, range: Range<usize>) -> impl Iterator<Item = Range<usize>> {
        let size = self.size;
        let first = range.start / size;
        let batches = first..if range.is_empty() { first } else { range.end.div_ceil(size) };
        batches.map(move |k| range.start.max(k * size)..range.end.min((k + 1) * size))
    }

    /// Which of a run of replicates the `number`-th (from 1) of so many equal parts holds, cut between batches.
    ///
    /// A part leaves one set of sums for each node that it fills of the tree in which batches are added up. So each cut moves by up to an
    /// eighth of a part, to where the largest nodes end: a part fills three of them on average and six at most, however long it is.
    pub(super) fn share(self, range: Range<usize>, (number, of): (usize, usize)) -> Range<usize> {
        let first = range.start / self.size;
        let batches = range.end.div_ceil(self.size) - first;
        let leeway = batches / of / 8;
        let cut = |part: usize| {
            let batch = first + (batches as u128 * part as u128 / of as u128) as usize;
            let batch =
                if part == 0 || part == of { batch } else { roundest(batch - leeway..=batch + leeway) };
            (batch * self.size).clamp(range.start, range.end)
        };
        cut(number - 1)..cut(number)
    }
}

/// The number that is a multiple of the largest power of two.
fn roundest(among: RangeInclusive<usize>) -> usize {
    let last = *among.end();
    let multiples = (0..usize::BITS).map(|power| last >> power << power);
    multiples.take_while(|multiple| among.contains(multiple)).last().unwrap_or(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn pieces_and_shares_make_the_whole(
            start in 0..300_usize, length in 0..2000_usize, of in 1..40_usize, size in prop::sample::select(vec![16, 64, 128]),
        ) {
            let batches = Batches::with_size(size);
            let range = start..start + length;
            let pieces: Vec<_> = batches.pieces(range.clone()).collect();
            prop_assert!(pieces.iter().all(|p| p.start / size == (p.end - 1) / size && !p.is_empty()));
            prop_assert_eq!(pieces.into_iter().flatten().collect::<Vec<_>>(), range.clone().collect::<Vec<_>>());
            let shares: Vec<_> = (1..=of).map(|number| batches.share(range.clone(), (number, of))).collect();
            prop_assert!(shares.iter().all(|s| s.is_empty() || s.start % size == 0 || s.start == range.start));
            // Equal but for an eighth at each end, and for a batch.
            let part = length as f64 / size as f64 / of as f64;
            let batches = shares.iter().map(|s| s.len() as f64 / size as f64);
            prop_assert!(batches.map(|x| (x - part).abs()).all(|off| off <= 0.25 * part + 2.0));
            prop_assert_eq!(shares.into_iter().flatten().collect::<Vec<_>>(), range.collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_roundest_number_is_found() {
        let slowly = |among: RangeInclusive<usize>| among.max_by_key(|number| number.trailing_zeros());
        for (start, length) in [(1, 0), (1, 6), (17, 14), (100, 27), (127, 1), (129, 126)] {
            assert_eq!(Some(roundest(start..=start + length)), slowly(start..=start + length));
        }
        assert_eq!(roundest(0..=3), 0);
    }
}
