//! Runs a kernel compiled for the widest vectors that the processor has.
//!
//! No multiplication is fused with an addition in any of the versions, so the
//! bits are the same in all of them. Without the `simd` feature (a
//! controller) the kernel is compiled once, for the target's own features.

/// A piece of work whose `run` must be inlined into each version.
pub(crate) trait Kernel {
    /// What the work gives.
    type Output;

    /// Does the work.
    fn run(self) -> Self::Output;
}

/// The instruction set found on this machine; looked up once, then passed on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Vectors {
    #[cfg(feature = "simd")]
    found: pulp::Arch,
}

impl Vectors {
    pub(crate) fn detect() -> Self {
        Self {
            #[cfg(feature = "simd")]
            found: pulp::Arch::new(),
        }
    }

    #[inline(always)]
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        #[cfg(feature = "simd")]
        return self.found.dispatch(Wide(kernel));
        #[cfg(not(feature = "simd"))]
        return kernel.run();
    }
}

#[cfg(feature = "simd")]
struct Wide<K>(K);

#[cfg(feature = "simd")]
impl<K: Kernel> pulp::WithSimd for Wide<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> K::Output {
        self.0.run()
    }
}
