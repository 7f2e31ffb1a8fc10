//! Runs of equal and of packed integers, in which Parquet writes levels and places in a dictionary
//! ([Encodings.md](https://github.com/apache/parquet-format/blob/master/Encodings.md#run-length-encoding--bit-packing-hybrid-rle--3)).

/// Whether `count` integers of so many bits are there, `each` of which says yes to.
pub(crate) fn all(
    mut bytes: &[u8],
    bits: u8,
    mut count: u64,
    mut each: impl FnMut(u64, u64) -> bool,
) -> Option<()> {
    if bits > 32 {
        return None;
    }
    let width = usize::from(bits).div_ceil(8);
    while count > 0 {
        let (head, rest) = varint(bytes)?;
        if head & 1 == 0 {
            let (value, rest) = rest.split_at_checked(width)?;
            let value = value
                .iter()
                .rev()
                .fold(0, |sum, b| sum << 8 | u64::from(*b));
            let run = (head >> 1).min(count);
            // A run of none would go on for ever.
            if run == 0 || !each(value, run) {
                return None;
            }
            (bytes, count) = (rest, count - run);
            continue;
        }
        // Groups of eight; of the last only what is counted need be there.
        let groups = usize::try_from(head >> 1).ok()?;
        let length = groups.checked_mul(usize::from(bits))?;
        let held = (groups as u64).checked_mul(8)?.min(count);
        let needed = usize::try_from(held.checked_mul(u64::from(bits))?.div_ceil(8)).ok()?;
        let packed = rest.get(..needed)?;
        if held == 0 {
            return None;
        }
        for k in 0..held {
            if !each(unpacked(packed, k * u64::from(bits), bits), 1) {
                return None;
            }
        }
        (bytes, count) = (rest.get(length..).unwrap_or_default(), count - held);
    }
    Some(())
}

/// The integer of so many bits from a bit on, the least first.
fn unpacked(bytes: &[u8], from: u64, bits: u8) -> u64 {
    let first = (from / 8) as usize;
    let around = bytes[first.min(bytes.len())..].iter().take(5);
    let word = around.rev().fold(0, |sum, b| sum << 8 | u64::from(*b));
    (word >> (from % 8)) & ((1 << bits) - 1)
}

fn varint(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let mut value = 0;
    for (k, byte) in bytes.iter().enumerate().take(5) {
        value |= u64::from(byte & 0x7f) << (7 * k);
        if byte & 0x80 == 0 {
            return Some((value, &bytes[k + 1..]));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::all;

    /// The example of Encodings.md: 0 to 7 in three bits each; and a run of four nines.
    #[test]
    fn packed_and_equal_integers_are_told_in_their_order() {
        let bytes = [0x03, 0b1000_1000, 0b1100_0110, 0b1111_1010];
        let mut found = Vec::new();
        let taken = all(&bytes, 3, 8, |value, run| {
            found.push((value, run));
            true
        });
        assert_eq!(taken, Some(()));
        assert_eq!(found, (0..8).map(|k| (k, 1)).collect::<Vec<_>>());
        let mut found = Vec::new();
        all(&[0x08, 9], 4, 3, |value, run| {
            found.push((value, run));
            true
        });
        assert_eq!(found, [(9, 3)]);
        for (bytes, bits) in [
            (&[][..], 3),
            (&[0x03, 0x88], 3),
            (&[0x00, 1], 1),
            (&[0x08], 4),
        ] {
            assert_eq!(all(bytes, bits, 8, |_, _| true), None, "{bytes:?}");
        }
    }
}
