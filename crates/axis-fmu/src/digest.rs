//! A digest of bytes.

/// FNV-1a, 64 bits: Fowler, Noll, Vo; IETF draft-eastlake-fnv, Section 2. It finds damage, and
/// no one who means harm.
pub(crate) fn digest(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::digest;

    /// Test vectors of the draft, Appendix C.
    #[test]
    fn digests_are_those_of_the_draft() {
        assert_eq!(digest(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(digest(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(digest(b"foobar"), 0x8594_4171_f739_67e8);
    }
}
