//! How effects fit an axis: its scales, and whether it has what they need.

use super::effect::Effect;
use super::parameter::{EffectNeed, Scales};
use crate::axis::Axis;
use crate::freedom::Freedom;

impl Scales {
    /// Those of an axis. Where its file lists no trajectories, it is as fast as it was seen to be ([`Axis::fastest`]), or in proportion
    /// to √(a s) as fast as the reference machine, a its greatest acceleration and s the length of a motion. An axis without a
    /// transmission has the reference machine's displacement.
    pub fn of(axis: &Axis) -> Self {
        let travel = axis.travel_per_radian();
        let torque = axis.torque_constant() * axis.actuator.limit();
        let force = torque / travel;
        let (length, whole) = (
            axis.stroke.maximum - axis.stroke.minimum,
            Self::REFERENCE.stroke,
        );
        let fastest = axis.trajectories.iter().map(|t| t.limits.velocity());
        let stiffness = axis.mechanism.stiffness();
        let inertia = axis.mechanism.total_inertia();
        let acceleration = torque / inertia * travel;
        let motion =
            (length * Self::REFERENCE.motion / (whole[1] - whole[0])).max(f64::MIN_POSITIVE);
        let reference = Self::REFERENCE;
        let reach = acceleration * motion / (reference.acceleration * reference.motion);
        Self {
            freedom: axis.freedom(),
            force,
            displacement: stiffness.map_or(Self::REFERENCE.displacement, |k| force / k),
            speed: (fastest.reduce(f64::max).or(axis.fastest))
                .unwrap_or_else(|| reference.speed * reach.sqrt()),
            inertia: axis.mechanism.load_inertia(),
            motor_inertia: inertia,
            motor_torque: torque,
            effort: axis.actuator.limit(),
            acceleration,
            motion,
            stroke: [axis.stroke.minimum, axis.stroke.maximum],
            start: axis.stroke.start,
        }
    }

    /// Those of an axis that is so many times as fast, and no different in anything else.
    pub(crate) fn faster(self, by: f64) -> Self {
        Self {
            speed: by * self.speed,
            ..self
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
