//! How a feedback is designed.

use std::vec::Vec;

use super::DesignError;
use crate::error::{require, within};
use crate::model::{DriveModel, Mode};

/// Weights, noise and margins of a design. Everything is relative to the axis: its own
/// loops' gains, its actuator's limit, its control period, so that the defaults suit axes of
/// any size. What they come to on the ball-screw axis of the reference machine is in brackets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FeedbackSettings {
    /// Whether the motor's speed is the difference of two angles, a cycle apart, and so half a
    /// cycle late; false.
    pub speed_by_differences: bool,
    /// Modes that the model has, the rigid motion among them; 3.
    pub modes: usize,
    /// Weight of the load's position per command, in gains of the cascade P k_p; 500
    /// [9.5e6 A/m].
    pub stiffness: f64,
    /// Weight of the load's speed per command, in gains of the cascade k_p/r; 37
    /// [1.5e4 A/(m/s)].
    pub damping: f64,
    /// Share of the bristles' stiffness and damping that the design relies on; 0.5. A spring
    /// that is not there does more harm than one that was not counted on.
    pub bristles: f64,
    /// Share of the damping that a vibration meets in slow sliding, which the falling
    /// Stribeck curve makes negative, that the design reckons with; 1.
    pub stribeck: f64,
    /// How much the unknown force wanders, in greatest forces of the actuator per √s; 2.4e-3
    /// [6e-4 N·m a cycle at the motor].
    pub wandering: f64,
    /// Deviation of the command from what acts, in greatest commands; 1/15 [1 A]. It keeps
    /// the observer quick, and with it the margins.
    pub command: f64,
    /// Standard deviation of the position's noise, in units of r a_max T², the travel that the greatest
    /// acceleration makes in a cycle; 1.8 [70 nm].
    pub position: f64,
    /// Standard deviation of the motor's speed, in units of a_max T; 0.04 [0.01 rad/s].
    pub speed: f64,
    /// Noise of the q current, in greatest commands; 1/3000 [5 mA].
    pub current: f64,
    /// Greatest sensitivity that is accepted; 1.3. Infinite: not checked.
    pub sensitivity: f64,
    /// The same with one more cycle of delay; 1.6.
    pub sensitivity_late: f64,
    /// Both of them where the load slides so slowly that friction feeds vibrations; 2.
    pub sensitivity_slow: f64,
    /// Shares of the assumed load's inertia for which the two must hold; 0.9 and 1.4.
    pub mass: [f64; 2],
    /// Shares of the assumed σ0, σ1 and σ2 for which they must hold; 0.5 and 2.
    pub friction: [f64; 2],
}

impl Default for FeedbackSettings {
    fn default() -> Self {
        Self {
            speed_by_differences: false,
            modes: 3,
            stiffness: 500.0,
            damping: 37.0,
            bristles: 0.5,
            stribeck: 1.0,
            wandering: 2.4e-3,
            command: 1.0 / 15.0,
            position: 1.8,
            speed: 0.04,
            current: 1.0 / 3000.0,
            sensitivity: 1.3,
            sensitivity_late: 1.6,
            sensitivity_slow: 2.0,
            mass: [0.9, 1.4],
            friction: [0.5, 2.0],
        }
    }
}

/// Standard deviations a cycle: of the force in N, of the command in greatest commands, of
/// the measurements in SI.
pub(super) struct Noise {
    pub force: f64,
    pub command: f64,
    pub position: f64,
    pub speed: f64,
    pub current: f64,
}

impl FeedbackSettings {
    pub(super) fn check(&self, model: &DriveModel) -> Result<(), DesignError> {
        let positive = [
            ("stiffness", self.stiffness),
            ("damping", self.damping),
            ("bristles", self.bristles),
            ("wandering", self.wandering),
            ("command", self.command),
            ("position", self.position),
            ("speed", self.speed),
            ("current", self.current),
        ];
        for (name, value) in positive {
            require(within(value, 1e-9, 1e9), name, value, "from 1e-9 to 1e9")?;
        }
        require(
            within(self.stribeck, 0.0, 100.0),
            "stribeck",
            self.stribeck,
            "from 0 to 100",
        )?;
        for (name, value) in [
            ("sensitivity", self.sensitivity),
            ("sensitivity_late", self.sensitivity_late),
            ("sensitivity_slow", self.sensitivity_slow),
        ] {
            require(value > 1.0, name, value, "above 1")?;
        }
        for value in self.mass {
            require(
                within(value, 0.01, 100.0),
                "mass",
                value,
                "from 0.01 to 100",
            )?;
        }
        for value in self.friction {
            require(
                within(value, 0.0, 100.0),
                "friction",
                value,
                "from 0 to 100",
            )?;
        }
        let limit = model.effort_limit;
        let valid = "finite, so that a feedback can be scaled by it";
        require(within(limit, 1e-9, 1e12), "effort_limit", limit, valid)?;
        Ok(())
    }

    /// The same for another bandwidth of the state feedback, as a share of this one, and
    /// factors of how much the force wanders and of how uncertain the command is.
    #[must_use]
    pub fn softened(&self, bandwidth: f64, wandering: f64, command: f64) -> Self {
        Self {
            stiffness: self.stiffness * bandwidth * bandwidth,
            damping: self.damping * bandwidth,
            wandering: self.wandering * wandering,
            command: self.command * command,
            ..*self
        }
    }

    /// The modes that count, checked.
    pub(super) fn used(&self, modes: &[Mode]) -> Result<Vec<Mode>, DesignError> {
        let used: Vec<Mode> = modes.iter().copied().take(self.modes.max(1)).collect();
        let finite = |m: &Mode| {
            let all = [m.frequency, m.damping, m.motor, m.load];
            all.iter().all(|v| v.is_finite()) && m.frequency >= 0.0
        };
        match used.first() {
            None => Err(DesignError::Modes("there is none")),
            Some(rigid) if rigid.frequency != 0.0 => {
                Err(DesignError::Modes("the first must be the rigid motion"))
            }
            Some(rigid) if rigid.motor * rigid.load <= 0.0 => Err(DesignError::Modes(
                "in the rigid motion, motor and load must move the same way",
            )),
            _ if !used.iter().all(finite) => Err(DesignError::Modes("one is not finite")),
            _ => Ok(used),
        }
    }

    /// Weights of the load's position (1/m) and speed (s/m), against the greatest command.
    pub(super) fn weights(&self, model: &DriveModel) -> [f64; 2] {
        let per_limit = model.cascade.speed / model.effort_limit;
        [
            self.stiffness * model.cascade.position * per_limit,
            self.damping * per_limit / model.travel,
        ]
    }

    pub(super) fn noise(&self, model: &DriveModel, rigid: &Mode) -> Noise {
        let greatest = model.torque_constant() * model.effort_limit;
        let h = model.period;
        // Motor's acceleration by the greatest torque, over a cycle.
        let speed = greatest * rigid.motor * rigid.motor * h;
        Noise {
            force: self.wandering * greatest / model.travel * axis_scalar::Scalar::sqrt(h),
            command: self.command,
            position: self.position * model.travel * speed * h,
            speed: self.speed * speed,
            current: self.current * model.effort_limit,
        }
    }
}
