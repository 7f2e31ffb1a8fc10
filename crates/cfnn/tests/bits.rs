//! Networks without an allocator give the bits that they have always given, in both precisions: a hash of many
//! evaluations.
//!
//! `cargo test -p cfnn --no-default-features bits -- --nocapture` prints the hash. It was made before the
//! scalar of an evaluation became that of the other control laws.

use cfnn::{FixedNetwork, NetworkScalar, ScalingRange, pack, packed_len};

const HIDDEN: [usize; 3] = [34, 19, 8];
const PARAMETERS: usize = 5 * 34 + 39 * 19 + 58 * 8 + 66;

/// FNV-1a of 64 bits, over the bits of numbers.
fn hash(state: u64, value: f64) -> u64 {
    value
        .to_bits()
        .to_le_bytes()
        .iter()
        .fold(state, |state, &byte| {
            (state ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
}

/// Uniform numbers in [−1, 1), always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Twenty thousand evaluations; `of` rounds to the scalar, `wide` is exact.
fn run<T: NetworkScalar>(of: impl Fn(f64) -> T, wide: impl Fn(T) -> f64) -> u64 {
    let mut random = Random(1);
    let weights: [T; PARAMETERS] = std::array::from_fn(|_| of(random.next()));
    let mut packed = [of(0.0); packed_len(4, &HIDDEN, 1)];
    pack(4, &HIDDEN, 1, &weights, &mut packed).expect("the right lengths");
    let range = |end: f64| ScalingRange::new("bits", of(-end), of(end)).expect("valid");
    let input = [1.5, 0.333, 1.0, 15.0].map(range);
    let network =
        FixedNetwork::<T, 4, 1, 66>::new(&HIDDEN, &packed, input, [range(3e-5)]).expect("valid");
    (0..20_000).fold(0xcbf2_9ce4_8422_2325, |state, _| {
        let [output] = network.evaluate(&std::array::from_fn(|_| of(random.next())));
        hash(state, wide(output))
    })
}

#[test]
fn both_precisions_keep_their_bits() {
    let (double, single) = (run(|x| x, |x| x), run(|x| x as f32, f64::from));
    println!("{double:#018x} {single:#018x}");
    assert_eq!(
        (double, single),
        (0x388f_38d5_e3cb_e113, 0x6105_0927_ed47_853d)
    );
}
