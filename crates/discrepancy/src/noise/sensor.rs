//! Noise of the sensors, as the search supposes it.

use axis_sim::Measured;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Standard deviations of sensor noise, white at the control rate.
///
/// It is the model's: a maker of simulated logs to try a search on needs a generator of
/// its own, or the search would know the noise that it is to find its way through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorNoise {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Motor angle, rad.
    pub angle: f64,
    /// Motor speed, rad/s.
    pub speed: f64,
    /// Each current, A.
    pub current: f64,
}

impl SensorNoise {
    /// Of sensors without any.
    pub const NONE: Self = Self {
        position: 0.0,
        angle: 0.0,
        speed: 0.0,
        current: 0.0,
    };

    /// Sensors with this noise, for [`axis_sim::ClosedLoop::run_sensed`]: the same seed
    /// gives the same noise.
    pub fn sensors(self, seed: u64) -> impl FnMut(&mut Measured) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = move |deviation: f64| {
            let unit: f64 = StandardNormal.sample(&mut random);
            deviation * unit
        };
        move |seen: &mut Measured| {
            seen.position += normal(self.position);
            seen.motor_angle += normal(self.angle);
            seen.motor_speed += normal(self.speed);
            seen.current.d += normal(self.current);
            seen.current.q += normal(self.current);
        }
    }
}

/// A sensor of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sensor {
    Position,
    Angle,
    Speed,
    Current,
}

impl Sensor {
    pub(super) const ALL: [Self; 4] = [Self::Position, Self::Angle, Self::Speed, Self::Current];

    /// That of its noise.
    pub(super) fn of(self, noise: &mut SensorNoise) -> &mut f64 {
        match self {
            Self::Position => &mut noise.position,
            Self::Angle => &mut noise.angle,
            Self::Speed => &mut noise.speed,
            Self::Current => &mut noise.current,
        }
    }

    /// This sensor's noise, and no other's.
    pub(super) fn alone(self, mut all: SensorNoise) -> SensorNoise {
        let mut own = SensorNoise::NONE;
        *self.of(&mut own) = *self.of(&mut all);
        own
    }

    /// With this sensor's noise so many times as large.
    pub(super) fn times(self, mut noise: SensorNoise, by: f64) -> SensorNoise {
        *self.of(&mut noise) *= by;
        noise
    }
}
