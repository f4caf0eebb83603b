//! How many replicates go abreast, chosen by the processor at run time.

/// An instruction set the kernels are compiled for.
///
/// All give the same bits: the source of a kernel is one, it is compiled once for each set, it never fuses a
/// multiplication with an addition, and no operation crosses from one lane to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Width(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    Single,
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Set {
    /// Narrowest first.
    const ALL: &[Self] = &[
        Self::Single,
        Self::Portable,
        #[cfg(target_arch = "x86_64")]
        Self::Avx2,
        #[cfg(target_arch = "x86_64")]
        Self::Avx512,
    ];

    /// Whether this processor reports every feature that the set's kernels are compiled with.
    fn is_supported(self) -> bool {
        match self {
            Self::Single | Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => std::is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                std::is_x86_feature_detected!("avx512f")
                    && std::is_x86_feature_detected!("avx512dq")
                    && std::is_x86_feature_detected!("avx512vl")
            }
        }
    }
}

/// A piece of work that can be done for any number of lanes.
pub(super) trait Kernel {
    /// Does it for `L` lanes. Implementations are `#[inline(always)]`, so that they take on the instruction
    /// set of the caller.
    fn run<const L: usize>(self);
}

impl Width {
    /// One replicate at a time: for a single stream.
    pub(crate) const SINGLE: Self = Self(Set::Single);

    /// Four abreast in whatever the target has by default.
    pub(crate) const PORTABLE: Self = Self(Set::Portable);

    /// The widest that this processor runs.
    pub fn detect() -> Self {
        Self::available().pop().unwrap_or(Self::PORTABLE)
    }

    /// Every width that this processor runs, narrowest first.
    pub fn available() -> Vec<Self> {
        Set::ALL.iter().copied().filter(|set| set.is_supported()).map(Self).collect()
    }

    /// Replicates abreast.
    pub fn lanes(self) -> usize {
        match self.0 {
            Set::Single => 1,
            Set::Portable => 4,
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => 8,
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => 16,
        }
    }

    /// Runs `kernel` compiled for this instruction set, with [`Self::lanes`] lanes.
    pub(super) fn run(self, kernel: impl Kernel) {
        match self.0 {
            Set::Single => kernel.run::<1>(),
            Set::Portable => kernel.run::<4>(),
            // SAFETY: `available` alone builds this variant, once `is_supported` has found AVX2.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(kernel) },
            // SAFETY: `available` alone builds this variant, once `is_supported` has found AVX-512 F, DQ and VL.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512(kernel) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2(kernel: impl Kernel) {
    kernel.run::<8>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl")]
fn avx512(kernel: impl Kernel) {
    kernel.run::<16>();
}
