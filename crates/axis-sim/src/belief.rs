//! What a compensator may believe of an axis: its parts as a feed-forward sees them.

use std::f64::consts::TAU;

use compensator::{Along, Cascade, CompensatorError, DriveModel, DriveSection, Kinematics};

use crate::axis::{Axis, LoadSensor};
use crate::effects::{Hooks, ScrewState};
use crate::error::SetupError;
use crate::plant::Start;

/// What the effects of an axis file do that depends on the position alone: what the
/// compensation tables of a drive are for. As at the start of a motion: what grows with
/// time is not in it.
#[derive(Clone, Debug)]
pub struct PositionErrors {
    hooks: Hooks,
    travel: f64,
    start: f64,
}

/// Angles over which the mean of a turn is taken.
const OF_A_TURN: u32 = 32;

impl PositionErrors {
    /// Where the load stands ahead of the motor's angle times the travel per radian, at
    /// `position` against the stroke's start, m or rad; mean over the turn around it.
    #[must_use]
    pub fn lead(&self, position: f64) -> f64 {
        self.mean(position) - self.mean(self.start)
    }

    /// What of it repeats with the motor's turn, at an angle (rad), m or rad.
    #[must_use]
    pub fn lead_in_turn(&self, angle: f64) -> f64 {
        let position = self.travel * angle;
        self.offset(angle) - self.mean(position)
    }

    /// Torque of the motor without any command, at an angle (rad), N·m.
    #[must_use]
    pub fn cogging(&self, angle: f64) -> f64 {
        self.hooks.torque_at(angle, 0.0)
    }

    fn offset(&self, angle: f64) -> f64 {
        let screw = ScrewState {
            angle,
            position: self.travel * angle,
            ..ScrewState::default()
        };
        self.hooks.offset_at(&screw)[0]
    }

    fn mean(&self, position: f64) -> f64 {
        let middle = position / self.travel;
        let at = |i: u32| middle + TAU * ((f64::from(i) + 0.5) / f64::from(OF_A_TURN) - 0.5);
        let sum: f64 = (0..OF_A_TURN).map(|i| self.offset(at(i))).sum();
        sum / f64::from(OF_A_TURN)
    }
}

impl Axis {
    /// What its effects do that depends on the position alone.
    ///
    /// # Errors
    /// [`SetupError`] where an effect does not fit the axis.
    pub fn position_errors(&self) -> Result<PositionErrors, SetupError> {
        let (axis, hooks) = self.with_effects()?;
        Ok(PositionErrors {
            travel: axis.travel_per_radian(),
            start: axis.stroke.start,
            hooks,
        })
    }

    /// Rest at `position` as a log tells it: the drive held the axis with the command `effort`
    /// (the mean over a standstill, where that is noisy), and what the axis' own loads do not
    /// ask for is held by the friction's bristles.
    ///
    /// ```
    /// # use axis_sim::{Axis, ClosedLoop, Start};
    /// # let text = include_str!("../../../data/axes/liu2025.toml");
    /// let axis = Axis::parse("liu2025.toml", text)?;
    /// // Left by a move forward: friction holds the table back by half its Coulomb level.
    /// let start = axis.held(0.7, 0.5 * 0.6757 / 1.641);
    /// assert!((start.friction - 0.5).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn held(&self, position: f64, effort: f64) -> Start {
        let r = self.travel_per_radian();
        let level = self.friction.law.parameters().coulomb / self.friction.lever(r);
        let held = self.torque_constant() * effort / r - self.load_at(position);
        Start {
            friction: if level > 0.0 {
                (held / level).clamp(-1.0, 1.0)
            } else {
                0.0
            },
            ..Start::at(position)
        }
    }

    /// Everything that a plan of this axis is made from, its effects left out.
    ///
    /// The loads are those at rest at each position. A control without a speed loop passes
    /// a learned shift of the position and the torque only.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] where no plan can be made from these parts.
    pub fn drive_model(&self) -> Result<DriveModel, CompensatorError> {
        let travel = self.travel_per_radian();
        let (drive, delay) = self.actuator.inverse(travel);
        let reach = self.mechanism.reach();
        let least = reach.map_or(self.stroke.minimum, |r| r.least.max(self.stroke.minimum));
        let most = reach.map_or(self.stroke.maximum, |r| r.most.min(self.stroke.maximum));
        let along = Along::new([least, most], |x| {
            let rotating = self.mechanism.rotating(x);
            DriveSection {
                compliance: self.mechanism.compliance(x),
                rotating: rotating.iter().map(|[inertia, _]| inertia).sum(),
                lagging: rotating.iter().map(|[inertia, lag]| inertia * lag).sum(),
                load: self.load_at(x),
            }
        })?;
        let mut cascade = self.control.cascade(travel).unwrap_or(Cascade {
            position: 0.0,
            velocity_feedforward: 0.0,
            acceleration_feedforward: 0.0,
            speed: 0.0,
            speed_integral: 0.0,
            from_motor: false,
        });
        // A load without a sensor is where the motor says that it is.
        cascade.from_motor |= matches!(self.sensors.load, LoadSensor::Missing);
        let [amplitude, order, phase] = self.mechanism.kinematic_harmonic().unwrap_or_default();
        Ok(DriveModel {
            kinematics: Kinematics {
                free_travel: self.mechanism.backlash(),
                amplitude,
                order,
                phase,
            },
            travel,
            load_inertia: self.mechanism.load_inertia(),
            friction: self.friction.law,
            lever: self.friction.lever(travel),
            along,
            drive,
            delay,
            effort_limit: self.actuator.limit(),
            cascade,
            period: self.period,
        })
    }
}
