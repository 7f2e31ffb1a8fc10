//! Motions in `f64` give the bits that they have always given: a hash of many.
//!
//! `cargo test -p trajectories bits -- --nocapture` prints the hash. It was made with motions in `f64` alone,
//! before they became generic over their scalar.
#![cfg(feature = "alloc")]

use trajectories::{Chirp, Limits, Motion, Program, SCurve, Sine, Step, Sweep};

/// FNV-1a of 64 bits, over the bits of numbers.
struct Hash(u64);

impl Hash {
    fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn motion(&mut self, motion: &impl Motion, instants: u32) {
        let duration = motion.duration();
        self.add(duration);
        for i in 0..=instants {
            let s = motion.at(duration * f64::from(i) / f64::from(instants));
            for value in [s.position, s.velocity, s.acceleration, s.jerk] {
                self.add(value);
            }
        }
    }
}

/// Uniform numbers in [0, 1), always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between 2^-`range` and 2^`range`.
    fn magnitude(&mut self, range: i32) -> f64 {
        let exponent = (self.next() * f64::from(2 * range)) as i32 - range;
        (1.0 + self.next()) * f64::from_bits(((1023 + exponent) as u64) << 52)
    }
}

fn oscillations(random: &mut Random) -> Program {
    let sine = Sine {
        amplitude: 0.01 * random.next() - 0.005,
        frequency: random.magnitude(6),
        cycles: 1 + (10.0 * random.next()) as u32,
    };
    let chirp = |sweep, random: &mut Random| {
        Step::Chirp(Chirp {
            amplitude: 0.01 * random.next(),
            from_frequency: random.magnitude(6),
            to_frequency: random.magnitude(6),
            duration: 1.0 + random.next(),
            ramp: 0.1 + 0.4 * random.next(),
            sweep,
        })
    };
    let steps = vec![
        Step::Sine(sine),
        Step::Dwell {
            duration: random.next(),
        },
        chirp(Sweep::Linear, random),
        chirp(Sweep::Logarithmic, random),
    ];
    Program::new(0.6, steps).expect("valid")
}

#[test]
fn double_precision_keeps_its_bits() {
    let (mut hash, mut random) = (Hash(0xcbf2_9ce4_8422_2325), Random(1));
    for _ in 0..2000 {
        let limits = [3, 4, 7].map(|range| random.magnitude(range));
        let limits = Limits::new(limits[0], limits[1], limits[2]).expect("valid");
        let (from, distance) = (random.next() - 0.5, random.magnitude(8));
        let to = from
            + if random.next() < 0.5 {
                -distance
            } else {
                distance
            };
        let curve = SCurve::plan(from, to, &limits).expect("valid");
        hash.motion(&curve, 100);
        hash.add(curve.peak_velocity());
        hash.add(curve.peak_acceleration());
    }
    for _ in 0..100 {
        let program = oscillations(&mut random);
        hash.motion(&program, 1000);
        let e = program.extremes();
        for value in [e.position_min, e.velocity, e.acceleration, e.jerk] {
            hash.add(value);
        }
    }
    println!("{:#018x}", hash.0);
    assert_eq!(hash.0, 0xd43a_cf88_b12c_8672);
}
