//! How effects fit an axis: its scales, and whether it has what they need.

use super::effect::Effect;
use super::parameter::{EffectNeed, PAPER_MOTION, Scales};
use crate::axis::Axis;
use crate::freedom::Freedom;

/// The paper's axis (data/axes/liu2025.toml), of which effects give typical sizes.
const PAPER_LEVER: f64 = 0.010 / std::f64::consts::TAU;
const PAPER_TORQUE: f64 = 1.641 * 15.0;
const PAPER_STIFFNESS: f64 = 7.45e7;
const PAPER_SPEED: f64 = 0.12;
const PAPER_MASS: f64 = 515.0;
const PAPER_INERTIA: f64 = 0.0096;

impl Scales {
    /// Those of an axis. Where its file lists no trajectories, nothing says how fast it is meant
    /// to be, and the paper's speed stands.
    pub fn of(axis: &Axis) -> Self {
        let travel = axis.travel_per_radian();
        let torque = axis.torque_constant() * axis.actuator.limit();
        let force = torque / travel;
        let stroke = axis.stroke.maximum - axis.stroke.minimum;
        let fastest = axis.trajectories.iter().map(|t| t.limits.velocity());
        let fastest = fastest.reduce(f64::max).unwrap_or(PAPER_SPEED);
        let stiffness = axis.mechanism.stiffness();
        let load = axis.mechanism.load_inertia();
        let paper_force = PAPER_TORQUE / PAPER_LEVER;
        Self {
            freedom: axis.freedom(),
            force: force / paper_force,
            displacement: stiffness.map_or(1.0, |k| (force / k) / (paper_force / PAPER_STIFFNESS)),
            speed: fastest / PAPER_SPEED,
            inertia: load / PAPER_MASS,
            motor_inertia: axis.mechanism.total_inertia() / PAPER_INERTIA,
            motor_torque: torque / PAPER_TORQUE,
            effort: axis.actuator.limit() / 15.0,
            acceleration: (torque / axis.mechanism.total_inertia() * travel)
                / (PAPER_TORQUE / PAPER_INERTIA * PAPER_LEVER),
            motion: (stroke * PAPER_MOTION / 1.5).max(f64::MIN_POSITIVE),
            stroke: [axis.stroke.minimum, axis.stroke.maximum],
            start: axis.stroke.start,
        }
    }
}

impl EffectNeed {
    /// Whether the axis has it, or else what it lacks.
    fn met(self, axis: &Axis) -> Result<(), String> {
        let has = match self {
            Self::Role(role) => axis.has(role),
            Self::Transmission => axis.mechanism.stiffness().is_some(),
            Self::MotorEncoder => axis.mechanism.has_motor_encoder(),
            Self::AnotherClock => axis.mechanism.has_motor_encoder() || !axis.has_control(),
            Self::Reference => axis.has_control(),
            Self::Currents => axis.actuator.has_currents(),
            Self::Poles => axis.actuator.pole_pairs().is_some(),
            Self::Turning => axis.freedom() == Freedom::Rotary,
            Self::TurningMotor => axis.mechanism.motor_freedom() == Freedom::Rotary,
            Self::LinearMotor => {
                axis.freedom() == Freedom::Linear
                    && axis.mechanism.stiffness().is_none()
                    && axis.actuator.pole_pairs().is_some()
            }
        };
        if has {
            return Ok(());
        }
        Err(format!("this axis has no {}", self.name()))
    }
}

impl Effect {
    /// Whether an axis can have it, or else why not.
    ///
    /// # Errors
    /// The reason, as a sentence without its stop.
    pub fn applies_to(&self, axis: &Axis) -> Result<(), String> {
        self.needs.iter().try_for_each(|need| need.met(axis))
    }
}
