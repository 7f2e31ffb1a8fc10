//! Noise of the sensors of an axis, for runs that stand for a machine.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha20Rng;

use crate::axis::Axis;
use crate::cycle::Measured;
use crate::freedom::Freedom;

/// Standard deviations of sensor noise, white at the control rate.
#[derive(Clone, Copy, Debug)]
pub struct NoiseLevels {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Motor angle, rad.
    pub angle: f64,
    /// Motor speed, rad/s.
    pub speed: f64,
    /// Each current, A.
    pub current: f64,
}

impl NoiseLevels {
    /// A good linear scale, a motor encoder with sine interpolation and a
    /// current sensor of 15 A range.
    pub const GOOD: Self = Self {
        position: 1e-8,
        angle: 2e-6,
        speed: 0.01,
        current: 5e-3,
    };

    /// As good ones for an axis: on one of 15 A along a line, [`NoiseLevels::GOOD`].
    pub fn good(axis: &Axis) -> Self {
        let current = axis.actuator.limit() / 15.0;
        // A resolver's noise at a motor's shaft; of a motor that is the load, that of the
        // scale's differences.
        let speed = match axis.mechanism.has_motor_encoder() {
            true => Self::GOOD.speed,
            false => Self::GOOD.speed * Self::GOOD.position / Self::GOOD.angle,
        };
        let position = match axis.freedom() {
            Freedom::Linear => Self::GOOD.position,
            Freedom::Rotary => 10.0 * Self::GOOD.position,
        };
        Self {
            position,
            speed,
            current: current * Self::GOOD.current,
            ..Self::GOOD
        }
    }

    /// The same, `by` times as large.
    pub fn scaled(self, by: f64) -> Self {
        Self {
            position: by * self.position,
            angle: by * self.angle,
            speed: by * self.speed,
            current: by * self.current,
        }
    }

    /// Sensors with this noise, for [`ClosedLoop::run_sensed`](crate::ClosedLoop::run_sensed): the same seed
    /// gives the same noise.
    pub fn sensors(self, seed: u64) -> impl FnMut(&mut Measured) {
        let mut normal = NormalNumbers::new(seed);
        let mut next = move |deviation: f64| deviation * normal.draw();
        move |seen: &mut Measured| {
            seen.position += next(self.position);
            seen.motor_angle += next(self.angle);
            seen.motor_speed += next(self.speed);
            seen.current.d += next(self.current);
            seen.current.q += next(self.current);
        }
    }
}

/// Normal numbers of mean 0 and variance 1, two of two uniform ones: √(−2 ln u) cos 2πv
/// and √(−2 ln u) sin 2πv (G. E. P. Box and M. E. Muller, Ann. Math. Statist. 29 (1958)
/// 610–611, doi:10.1214/aoms/1177706645).
///
/// The search (`discrepancy`) draws its noise from another generator by another transformation:
/// with the same, a seed in common would give it the noise itself.
#[derive(Clone, Debug)]
pub struct NormalNumbers {
    random: ChaCha20Rng,
    /// The second of a pair.
    spare: Option<f64>,
}

impl NormalNumbers {
    /// Those of a seed.
    pub fn new(seed: u64) -> Self {
        Self {
            random: ChaCha20Rng::seed_from_u64(seed),
            spare: None,
        }
    }

    /// The next number.
    pub fn draw(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        // Uniform numbers may be 0, of which there is no logarithm, and are never 1.
        let u = 1.0 - self.random.random::<f64>();
        let v = self.random.random::<f64>();
        let radius = (-2.0 * u.ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Raw moments of the normal distribution are 0, 1, 0 and 3; the means of n powers
    /// of its numbers have the variances 1, 2, 15 and 96, over n.
    #[test]
    fn numbers_have_the_moments_of_the_normal_distribution() {
        let n = 400_000;
        let mut normal = NormalNumbers::new(3);
        let all: Vec<f64> = (0..n).map(|_| normal.draw()).collect();
        let moment = |k: i32| all.iter().map(|z| z.powi(k)).sum::<f64>() / f64::from(n);
        let scatter = |variance: f64| 4.0 * (variance / f64::from(n)).sqrt();
        assert!(moment(1).abs() < scatter(1.0), "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < scatter(2.0), "{}", moment(2));
        assert!(moment(3).abs() < scatter(15.0), "{}", moment(3));
        assert!((moment(4) - 3.0).abs() < scatter(96.0), "{}", moment(4));
        // The two of a pair, and neighbours, know nothing of each other.
        for lag in [1, 2, 5] {
            let pairs = all.iter().zip(&all[lag..]).map(|(a, b)| a * b);
            let along = pairs.sum::<f64>() / f64::from(n);
            assert!(along.abs() < scatter(1.0), "{lag}: {along}");
        }
        // P(|z| > 2) = 0.0455.
        let beyond = all.iter().filter(|z| z.abs() > 2.0).count() as f64 / f64::from(n);
        assert!(
            (beyond - 0.045_500).abs() < scatter(0.0455 * 0.9545),
            "{beyond}"
        );
    }

    fn drawn(mut sensors: impl FnMut(&mut Measured), n: usize) -> Vec<f64> {
        let one = |_| {
            let mut seen = Measured::default();
            sensors(&mut seen);
            [
                seen.position,
                seen.motor_angle,
                seen.motor_speed,
                seen.current.d,
                seen.current.q,
            ]
        };
        (0..n).flat_map(one).collect()
    }

    const UNIT: NoiseLevels = NoiseLevels {
        position: 1.0,
        angle: 1.0,
        speed: 1.0,
        current: 1.0,
    };

    #[test]
    fn the_same_seed_gives_the_same_noise_and_another_another() {
        let of = |seed| drawn(UNIT.sensors(seed), 50);
        assert_eq!(of(8), of(8));
        assert_ne!(of(8), of(9));
    }

    #[test]
    fn sensors_are_scaled_one_by_one() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        let good = NoiseLevels::good(&Axis::read(file.as_ref()).unwrap());
        let unit = drawn(UNIT.sensors(4), 1);
        let twice = drawn(good.scaled(2.0).sensors(4), 1);
        let by = [
            good.position,
            good.angle,
            good.speed,
            good.current,
            good.current,
        ];
        for ((unit, twice), by) in unit.iter().zip(&twice).zip(by) {
            assert!((twice - 2.0 * by * unit).abs() <= 1e-15 * twice.abs());
        }
    }
}
