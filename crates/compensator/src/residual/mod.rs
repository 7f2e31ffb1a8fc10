//! What no parameter of the model holds: torque over motor angle, force over position.
//!
//! ```text
//! T_res = Σₙ aₙ cos nθ + bₙ sin nθ  +  r (u f(x) + g(x))       n = 1 … 24
//! ```
//!
//! θ is the motor's angle, x the load's position, u the share of the Coulomb level that the
//! bristles hold, −1 to 1. Cogging and ripple go into the harmonics, local friction into f,
//! a friction that differs between the directions, a spring or a cable chain into g. Both
//! are linear between knots along the stroke. The planner adds T_res to the torque that it
//! asks for; [`ResidualLearner`] finds it from logs of ordinary moves.
//!
//! Whatever gives a torque and a force besides those of the model is a [`Residual`]; whatever
//! makes one of coefficients in which it is linear is a `ResidualBasis`, which a
//! `ResidualLearner` learns behind its gate: [`ResidualModel`] of `ResidualTables`,
//! `ResidualNetwork` of `NetworkBasis`.

#[cfg(feature = "identify")]
mod basis;
#[cfg(feature = "identify")]
mod learn;
#[cfg(feature = "alloc")]
mod network;
#[cfg(feature = "identify")]
mod network_basis;
#[cfg(feature = "identify")]
mod tables;
#[cfg(feature = "identify")]
mod unexplained;

use axis_scalar::Scalar;

#[cfg(feature = "identify")]
pub use basis::{ResidualBasis, ResidualRow, over_gaussian};
#[cfg(feature = "identify")]
pub use learn::ResidualLearner;
#[cfg(feature = "alloc")]
pub use network::{NETWORK_INPUTS, ResidualNetwork};
#[cfg(feature = "identify")]
pub use network_basis::NetworkBasis;
#[cfg(feature = "identify")]
pub use tables::ResidualTables;
#[cfg(feature = "identify")]
pub use unexplained::Unexplained;

/// Harmonics of the motor's angle.
pub const HARMONICS: usize = 24;
/// Knots along the stroke.
pub const KNOTS: usize = 193;

/// Where along a motion a residual is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResidualAt<T = f64> {
    /// Angle of the motor, rad.
    pub motor_angle: T,
    /// Its speed, rad/s.
    pub motor_speed: T,
    /// Position of the load, m or rad.
    pub position: T,
    /// Share of the Coulomb level that the bristles hold, −1 to 1.
    pub direction: T,
}

/// Torque and force that an axis needs besides those of its model.
pub trait Residual<T: Scalar = f64> {
    /// Torque at the motor, N·m, and force on the load, N or N·m, both positive where they
    /// hinder positive motion.
    fn besides(&mut self, at: &ResidualAt<T>) -> [T; 2];
}

/// Torque over angle and force over position. 3 KB in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualModel<T = f64> {
    /// [aₙ, bₙ], N·m at the motor, n from 1.
    pub harmonics: [[T; 2]; HARMONICS],
    /// Lower end of the stroke and knots per length.
    pub along: [T; 2],
    /// f at the knots, N (N·m where the load turns).
    pub friction: [T; KNOTS],
    /// g at the knots.
    pub force: [T; KNOTS],
}

impl<T: Scalar> ResidualModel<T> {
    /// Nothing, over a stroke of at least a little length.
    #[must_use]
    pub fn none([least, most]: [T; 2]) -> Self {
        let length = (most - least).max(T::MIN_POSITIVE);
        Self {
            harmonics: [[T::ZERO; 2]; HARMONICS],
            along: [least, T::of((KNOTS - 1) as f64) / length],
            friction: [T::ZERO; KNOTS],
            force: [T::ZERO; KNOTS],
        }
    }

    /// Knot below a position and the share of the next one.
    pub(crate) fn knot(&self, position: T) -> (usize, T) {
        let last = T::of((KNOTS - 1) as f64);
        let along = ((position - self.along[0]) * self.along[1])
            .max(T::ZERO)
            .min(last);
        let knot = (along.to_f64() as usize).min(KNOTS - 2);
        (knot, along - T::of(knot as f64))
    }

    /// Torque at the motor and force on the load that it adds to those of the model,
    /// N·m and N: the motor at `angle` (rad), the load at `position`, the bristles at the
    /// share `direction` of the Coulomb level.
    #[must_use]
    pub fn at(&self, angle: T, position: T, direction: T) -> [T; 2] {
        let (sin, cos) = angle.sin_cos();
        // Each harmonic from the one before: turning on by the angle.
        let (mut c, mut s) = (cos, sin);
        let mut torque = T::ZERO;
        for [a, b] in &self.harmonics {
            torque += *a * c + *b * s;
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
        }
        let (knot, share) = self.knot(position);
        let at = |values: &[T; KNOTS]| values[knot] + share * (values[knot + 1] - values[knot]);
        [torque, direction * at(&self.friction) + at(&self.force)]
    }

    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> ResidualModel<U> {
        let cast = |value: T| U::of(value.to_f64());
        ResidualModel {
            harmonics: self.harmonics.map(|pair| pair.map(cast)),
            along: self.along.map(cast),
            friction: self.friction.map(cast),
            force: self.force.map(cast),
        }
    }
}

impl<T: Scalar> Residual<T> for ResidualModel<T> {
    fn besides(&mut self, at: &ResidualAt<T>) -> [T; 2] {
        self.at(at.motor_angle, at.position, at.direction)
    }
}
