//! Running the algebra of a method compiled for its own order, so that its short loops unroll into registers.

use switchback_noise::lanes::{Work, widest};

/// The largest order that is compiled; what is larger, or of another shape, goes one by one. Code grows with the square of the order: with six it was more than
/// half of what this crate takes to build.
pub(crate) const LARGEST_ORDER: usize = 4;

/// A piece of work on `n = N` lags and `D` core parameters.
pub(super) trait SizedWork {
    /// Does it. Implementations, and what they call, are `#[inline(always)]`: see [`Work`].
    fn run<const N: usize, const D: usize>(self);
}

struct Of<W, const N: usize, const D: usize>(W);

impl<W: SizedWork, const N: usize, const D: usize> Work for Of<W, N, D> {
    #[inline(always)]
    fn run(self) {
        self.0.run::<N, D>();
    }
}

/// Runs `work` compiled for `order` lags and `size` core parameters (`a`, `b` and perhaps a constant) and for the widest vectors;
/// says whether there is such code.
pub(super) fn run(order: usize, size: usize, work: impl SizedWork) -> bool {
    match (order, size) {
        (1, 2) => widest(Of::<_, 1, 2>(work)),
        (2, 4) => widest(Of::<_, 2, 4>(work)),
        (3, 6) => widest(Of::<_, 3, 6>(work)),
        (LARGEST_ORDER, 8) => widest(Of::<_, LARGEST_ORDER, 8>(work)),
        _ if size == 2 * order + 1 => return run_with_constant(order, work),
        _ => return false,
    }
    true
}

/// [`run`] for work that always has a constant: what it would be without one is not compiled.
pub(super) fn run_with_constant(order: usize, work: impl SizedWork) -> bool {
    match order {
        1 => widest(Of::<_, 1, 3>(work)),
        2 => widest(Of::<_, 2, 5>(work)),
        3 => widest(Of::<_, 3, 7>(work)),
        LARGEST_ORDER => widest(Of::<_, LARGEST_ORDER, 9>(work)),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Sizes<'a>(&'a mut (usize, usize));

    impl SizedWork for Sizes<'_> {
        fn run<const N: usize, const D: usize>(self) {
            *self.0 = (N, D);
        }
    }

    #[test]
    fn every_order_up_to_the_largest_has_its_code_with_and_without_a_constant() {
        for order in 1..=LARGEST_ORDER {
            for size in [2 * order, 2 * order + 1] {
                let mut ran = (0, 0);
                assert!(run(order, size, Sizes(&mut ran)));
                assert_eq!(ran, (order, size));
            }
        }
        let mut ran = (0, 0);
        for size in [2 * LARGEST_ORDER + 2, 2 * LARGEST_ORDER + 3] {
            assert!(!run(LARGEST_ORDER + 1, size, Sizes(&mut ran)));
        }
        assert!(!run(2, 3, Sizes(&mut ran)));
        assert_eq!(ran, (0, 0));
    }
}
