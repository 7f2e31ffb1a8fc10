//! The law in `f64` gives the bits that it has always given: a hash of a long run.
//!
//! `cargo test -p lugre bits -- --nocapture` prints the hash. It was made with the law in `f64` alone, before
//! the law became generic over its scalar.

use lugre::{LuGre, Parameters};

/// FNV-1a of 64 bits, over the bits of numbers.
struct Hash(u64);

impl Hash {
    fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
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

fn laws() -> Vec<LuGre> {
    let paper = Parameters::LIU_2025;
    let other = [
        paper,
        Parameters {
            damping: 0.0,
            ..paper
        },
        Parameters {
            stiction: paper.coulomb,
            ..paper
        },
        Parameters {
            coulomb: 0.0,
            stiction: 0.0,
            ..paper
        },
        Parameters {
            coulomb: 20.0,
            stiction: 33.0,
            stribeck_speed: 0.01,
            stiffness: 4e6,
            damping: 700.0,
            viscous: 55.0,
        },
    ];
    other
        .iter()
        .map(|&p| LuGre::new(p).expect("valid"))
        .collect()
}

/// Every function of the law along a random walk of the speed across rest.
fn walk(law: &LuGre, hash: &mut Hash, random: &mut Random, speed: f64, h: f64) {
    let (mut z, mut w0) = (0.3 * law.bristle_limit(), 0.0);
    for _ in 0..20_000 {
        let w1 = 0.99 * w0 + speed * random.next();
        let (z1, torque) = law.step_torque(z, w0, w1, h);
        let (z2, impulse) = law.step_impulse(z, w0, w1, h);
        assert_eq!(z1, z2);
        for value in [
            z1,
            torque,
            impulse,
            law.level(w1),
            law.steady_state(w1),
            law.steady_bristle(w1),
            law.rate(z1, w1),
            law.stored_energy(z1),
            law.vibration_damping(w1, 400.0 * random.next()),
        ] {
            hash.add(value);
        }
        (z, w0) = (z1, w1);
    }
}

#[test]
fn double_precision_keeps_its_bits() {
    let (mut hash, mut random) = (Hash(0xcbf2_9ce4_8422_2325), Random(1));
    for law in laws() {
        for value in [
            law.flat_above(),
            law.bristle_limit(),
            law.passivity_margin(),
            law.passive_below(),
        ] {
            hash.add(value);
        }
        for speed in [1e-5, 1e-2, 1.0, 30.0] {
            for h in [1e-6, 1e-4, 1e-2] {
                walk(&law, &mut hash, &mut random, speed, h);
            }
        }
    }
    println!("{:#018x}", hash.0);
    assert_eq!(hash.0, 0x5040_ad88_0110_d008);
}
