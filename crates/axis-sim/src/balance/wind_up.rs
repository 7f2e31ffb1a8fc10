//! The transmission's wind-up, which sets the end that was not measured apart from the other.

use lugre::{LuGre, Parameters};

use super::filter::derivative;
use super::motion::Course;
use crate::axis::Axis;

/// Damping ratios with which a load that is not measured swings at least and at most.
const LEAST_DAMPING: f64 = 0.005;
const MOST_DAMPING: f64 = 0.95;

/// The transmission's wind-up, by that of the axis file.
#[derive(Clone, Copy, Debug)]
pub(super) struct WindUp {
    /// Position in which it is looked at, m or rad.
    pub at: f64,
    /// Force at the load per wind-up, N/m or N·m/rad, times the mechanism's compliance there: of a
    /// drive of two inertias 1/r².
    pub stiffness_by_compliance: f64,
}

impl WindUp {
    /// Force at the load per wind-up of an axis whose parameters may be off, and the time
    /// constant of its damping, s.
    pub fn of(&self, axis: &Axis) -> [f64; 2] {
        let compliance = axis.mechanism.compliance(self.at);
        [
            self.stiffness_by_compliance / compliance,
            axis.mechanism.stiffness_damping(),
        ]
    }

    /// Frequency at which the load swings against a motor that is held, rad/s.
    pub fn swing(&self, axis: &Axis) -> f64 {
        let [stiffness, _] = self.of(axis);
        (stiffness / axis.mechanism.load_inertia()).sqrt()
    }
}

/// Wind-up w by which a motor that is not measured leads a load that is, times the travel per radian:
/// the force F that is transmitted is known, F = k (w + τ ẇ), and of slow motion w = (F − τ Ḟ)/k.
pub(super) fn lead_of_motor(
    transmitted: Vec<f64>,
    [stiffness, damping]: [f64; 2],
    h: f64,
) -> Course {
    let rates = derivative(&transmitted, h);
    let pairs = transmitted.into_iter().zip(rates);
    let position: Vec<f64> = pairs
        .map(|(force, rate)| (force - damping * rate) / stiffness)
        .collect();
    let speed = derivative(&position, h);
    Course {
        acceleration: derivative(&speed, h),
        speed,
        position: from_its_begin(position),
    }
}

/// Wind-up w by which a load that is not measured lags the motor, whose acceleration there is a. It
/// swings against the motor as one mass on a spring:
///
/// ```text
/// m ẅ + k τ ẇ + k w = m a + F_friction + F_loads
/// ```
pub(super) fn lag_of_load(
    forces: &[f64],
    accelerations: &[f64],
    mass: f64,
    [stiffness, damping]: [f64; 2],
    h: f64,
) -> Course {
    let pairs = forces.iter().zip(accelerations);
    let per_mass: Vec<f64> = pairs.map(|(force, a)| a + force / mass).collect();
    let frequency = (stiffness / mass).sqrt();
    swing(&per_mass, frequency, 0.5 * damping * frequency, h)
}

/// Where a log's position begins is where it was set to.
fn from_its_begin(mut positions: Vec<f64>) -> Vec<f64> {
    let first = positions.first().copied().unwrap_or(0.0);
    positions.iter_mut().for_each(|x| *x -= first);
    positions
}

/// Course of w from rest under the first of the `inputs` u, which is linear between samples `h` seconds
/// apart: ẅ + 2 ζ ω ẇ + ω² w = u.
fn swing(inputs: &[f64], frequency: f64, damping: f64, h: f64) -> Course {
    // Without any, noise at ω would never die away.
    let zeta = damping.clamp(LEAST_DAMPING, MOST_DAMPING);
    let squared = frequency * frequency;
    let decay = zeta * frequency;
    let damped = frequency * (1.0 - zeta * zeta).sqrt();
    let (sin, cos) = (damped * h).sin_cos();
    let fade = (-decay * h).exp();
    let [mut w, mut rate] = [inputs.first().map_or(0.0, |u| u / squared), 0.0];
    let mut course = Course {
        position: Vec::with_capacity(inputs.len()),
        speed: Vec::with_capacity(inputs.len()),
        acceleration: Vec::with_capacity(inputs.len()),
    };
    for (k, &now) in inputs.iter().enumerate() {
        course.position.push(w);
        course.speed.push(rate);
        course
            .acceleration
            .push(now - 2.0 * decay * rate - squared * w);
        let slope = (inputs.get(k + 1).unwrap_or(&now) - now) / h;
        // The particular solution that is linear in time, and the rest about it.
        let steady = [
            (now - 2.0 * zeta * slope / frequency) / squared,
            slope / squared,
        ];
        let [d, e] = [w - steady[0], rate - steady[1]];
        w = fade * ((cos + decay / damped * sin) * d + sin / damped * e)
            + steady[0]
            + h * steady[1];
        rate = fade * ((cos - decay / damped * sin) * e - squared / damped * sin * d) + steady[1];
    }
    course.position = from_its_begin(course.position);
    course
}

/// A friction law as it acts through a spring, N/m or N·m/rad at the load, that gives way with its
/// bristles.
pub(super) fn behind_a_spring(law: &LuGre, spring: Option<f64>, lever: f64) -> LuGre {
    let own = law.parameters();
    let Some(spring) = spring.map(|k| k * lever * lever) else {
        return *law;
    };
    with_stiffness(law, own.stiffness * spring / (own.stiffness + spring))
}

/// A law with bristles of another stiffness; where that is none, the law as it is.
pub(super) fn with_stiffness(law: &LuGre, stiffness: f64) -> LuGre {
    let own = law.parameters();
    LuGre::new(Parameters { stiffness, ..own }).unwrap_or(*law)
}

#[cfg(test)]
mod tests {
    use super::swing;

    /// Under cos Ωt a load follows by 1/(ω² − Ω²), and its swinging at ω from the start dies away.
    #[test]
    fn a_load_swings_as_its_equation_of_motion_says() {
        let (frequency, damping, h) = (100.0, 0.1, 1e-3);
        for drive in [10.0, 40.0, 70.0] {
            let input: Vec<f64> = (0..4000)
                .map(|k| (drive * h * f64::from(k)).cos())
                .collect();
            let course = swing(&input, frequency, damping, h);
            for k in 1500..4000 {
                let w = course.position[k] + input[0] / (frequency * frequency);
                let [sin, cos] = [(drive * h * k as f64).sin(), (drive * h * k as f64).cos()];
                let [real, imaginary] = [
                    frequency * frequency - drive * drive,
                    2.0 * damping * frequency * drive,
                ];
                let size = real * real + imaginary * imaginary;
                let steady = (real * cos + imaginary * sin) / size;
                // An input that is linear between samples is off by (Ωh)²/12 of it.
                let close = |a: f64, b: f64| (a - b).abs() < 1e-3 / size.sqrt();
                assert!(close(w, steady), "{w} {steady}");
                let acceleration = course.acceleration[k] / (drive * drive);
                assert!(close(acceleration, -steady), "{acceleration} {steady}");
            }
        }
    }
}
