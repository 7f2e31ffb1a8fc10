//! Random numbers.

/// xorshift64* (Vigna, ACM Trans. Math. Softw. 42 (2016) 30, doi:10.1145/2845077), with
/// normal deviates by Box and Muller (Ann. Math. Stat. 29 (1958) 610,
/// doi:10.1214/aoms/1177706645).
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    spare: Option<f64>,
}

impl Random {
    /// The stream of a seed and of a number within it.
    pub fn new(seed: u64, stream: u64) -> Self {
        // Seeds that are near one another must not give streams that are.
        let mixed = seed
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .wrapping_add(stream.wrapping_mul(0xd1b5_4a32_d192_ed03))
            .wrapping_add(0x2545_f491_4f6c_dd1d);
        let mut random = Self {
            state: mixed.max(1),
            spare: None,
        };
        for _ in 0..32 {
            random.next();
        }
        random
    }

    fn next(&mut self) -> u64 {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        self.state.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// Uniform on (0, 1).
    pub fn uniform(&mut self) -> f64 {
        ((self.next() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Normal with mean 0 and deviation 1.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }
}
