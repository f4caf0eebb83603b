//! Running the algebra of lanes with the widest instructions the processor has.

/// A piece of work on lanes.
pub trait Work {
    /// Does it. Implementations, and what they call, are `#[inline(always)]`, so that they take on the instruction set of the caller.
    fn run(self);
}

/// Runs `work` compiled for the widest vectors of this processor.
///
/// The bits of the results are the same with all: no operation crosses lanes, and a multiplication is never fused with an addition.
pub fn widest(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    {
        if std::is_x86_feature_detected!("avx512f") && std::is_x86_feature_detected!("avx512dq") {
            // SAFETY: both features have just been found.
            return unsafe { avx512(work) };
        }
        if std::is_x86_feature_detected!("avx2") {
            // SAFETY: the feature has just been found.
            return unsafe { avx2(work) };
        }
    }
    work.run();
}

/// Stands first in a loop over lanes: keeps the compiler from vectorising it across its iterations, which gathers and scatters what
/// lies side by side. Costs nothing.
#[inline(always)]
pub fn keep_apart() {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: an empty instruction sequence.
    unsafe {
        std::arch::asm!("", options(nomem, nostack, preserves_flags));
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq")]
fn avx512(work: impl Work) {
    work.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(work: impl Work) {
    work.run();
}
