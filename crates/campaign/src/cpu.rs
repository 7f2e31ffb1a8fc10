//! What the bits of a result may depend on beside its inputs.

/// The instruction set by which numerical libraries choose their kernels at run time:
/// architecture, and what of AVX2, FMA and AVX-512F the processor has.
///
/// Kernels for another set sum in another order or round less often, so the last bits of
/// a result may differ between processors that do not have the same.
pub fn instruction_set() -> String {
    let mut name = std::env::consts::ARCH.to_owned();
    for (feature, there) in features() {
        if there {
            name.push(' ');
            name.push_str(feature);
        }
    }
    name
}

#[cfg(target_arch = "x86_64")]
fn features() -> [(&'static str, bool); 3] {
    [
        ("avx2", std::arch::is_x86_feature_detected!("avx2")),
        ("fma", std::arch::is_x86_feature_detected!("fma")),
        ("avx512f", std::arch::is_x86_feature_detected!("avx512f")),
    ]
}

#[cfg(not(target_arch = "x86_64"))]
fn features() -> [(&'static str, bool); 0] {
    []
}
