//! What a compensator may assume of an axis: its parts and effects as a feed-forward sees them.

mod friction;
mod kinematics;
mod position_errors;

pub use position_errors::PositionErrors;

use compensator::{
    Cascade, CompensatorError, DriveModel, DriveSection, Kinematics, SignalPath, StrokeSections,
};
use lugre::LugreError;
use thiserror::Error;

use crate::axis::{Axis, LoadSensor};
use crate::effects::{ActiveEffect, EffectParameter, Hooks, Measure, ScrewState, TableState};
use crate::error::SetupError;
use crate::mechanism::Mechanism;
use crate::part::Part;
use crate::plant::Start;

/// Why no plan can be made of an axis.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlanModelError {
    /// The axis cannot have one of its effects.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Its effects leave no valid friction.
    #[error("no plan can be made of the axis: its friction with what [[effects]] add to it: {0}")]
    Friction(#[from] LugreError),
    /// Its parts make no plan.
    #[error("no plan can be made of the axis: {0}")]
    Plan(#[from] CompensatorError),
}

/// Rounds in which the lever is found that a force has at the motor: each shrinks what is off by the share
/// that an error of the kinematics changes the travel by.
const LEVER_ROUNDS: usize = 4;

impl Axis {
    /// Rest at `position` as a log tells it: the drive held the axis with the command `effort`
    /// (the mean over a standstill, where that is noisy), and what the axis' own loads do not
    /// ask for is held by the friction's bristles.
    ///
    /// ```
    /// # use axis_sim::{Axis, ClosedLoop, Start};
    /// # let text = include_str!("../../../../data/axes/liu2025.toml");
    /// let axis = Axis::parse("liu2025.toml", text)?;
    /// // Left by a move forward: friction holds the table back by half its Coulomb level.
    /// let start = axis.held(0.7, 0.5 * 0.6757 / 1.641);
    /// assert!((start.friction - 0.5).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn held(&self, position: f64, effort: f64) -> Start {
        let r = self.travel_per_radian();
        let level = self.friction.law.parameters().coulomb / self.friction.lever(r);
        let held = self.force_of(effort, position) - self.load_at(position);
        Start {
            friction: if level > 0.0 {
                (held / level).clamp(-1.0, 1.0)
            } else {
                0.0
            },
            ..Start::at(position)
        }
    }

    /// Force of the transmission on the load at rest at `position` under a command, N or N·m: the motor's
    /// torque over the travel per radian, which an error of the transmission's kinematics changes.
    fn force_of(&self, effort: f64, position: f64) -> f64 {
        let (r, torque) = (self.travel_per_radian(), self.torque_constant() * effort);
        let Some(error) = self.mechanism.kinematic_error() else {
            return torque / r;
        };
        let compliance = self.mechanism.compliance(position);
        // The force moves the angle by little, and by it the lever by less.
        (0..LEVER_ROUNDS).fold(torque / r, |force, _| {
            let [.., growth] = error(&ScrewState {
                angle: position / r + compliance * r * force,
                position,
                ..ScrewState::default()
            });
            torque / (r + growth)
        })
    }

    /// Everything that a plan of this axis is made from.
    ///
    /// Of its [effects](Axis::effects) a plan follows those that change a parameter of a part,
    /// add to the friction (dry, viscous, falling with speed: the mean of both directions and
    /// of the stroke), load it by its position, or make a wave of the transmission's kinematics over
    /// the motor's turn (one, the strongest). It does not follow other errors of these, what acts on
    /// the motor's torque or the sensors, a body that swings, waves of a load, and what is shaped by
    /// a time.
    ///
    /// The loads are those at rest at each position. A control without a speed loop passes
    /// a learned shift of the position and the torque only.
    ///
    /// # Errors
    /// [`PlanModelError`] if no plan can be made from these parts and effects.
    pub fn drive_model(&self) -> Result<DriveModel, PlanModelError> {
        let (axis, hooks) = self.followed(|p| !p.nature.is_order())?;
        let (_, with_waves) = self.followed(|_| true)?;
        axis.planned(&hooks, &with_waves)
    }

    /// The mechanism of [`Axis::drive_model`]: with the payloads, inertias and stiffnesses among the
    /// effects.
    ///
    /// # Errors
    /// [`SetupError`] if an effect does not fit the axis.
    pub fn planned_mechanism(&self) -> Result<Part<dyn Mechanism>, SetupError> {
        Ok(self.followed(|_| true)?.0.mechanism)
    }

    /// The axis with those of its effects in its parts that no time shapes, nor a number that is not
    /// `followed`, and their hooks. Nobody knows when by the clock a motion begins.
    fn followed(
        &self,
        followed: impl Fn(&EffectParameter) -> bool,
    ) -> Result<(Self, Hooks), SetupError> {
        let can_be = |active: &ActiveEffect| {
            let mut numbers = active.effect.parameters.iter();
            numbers.all(|p| p.is_size() || p.measure != Measure::Time && followed(p))
        };
        let mut axis = self.clone();
        axis.effects.retain(can_be);
        axis.with_effects()
    }

    /// The plan's model of these parts, loaded by `hooks`; a wave of the transmission is among
    /// `with_waves`. Those of a load are finer than a plan's stroke.
    fn planned(&self, hooks: &Hooks, with_waves: &Hooks) -> Result<DriveModel, PlanModelError> {
        let travel = self.travel_per_radian();
        let (drive, delay) = self.actuator.inverse(travel);
        let reach = self.mechanism.reach();
        let least = reach.map_or(self.stroke.minimum, |r| r.least.max(self.stroke.minimum));
        let most = reach.map_or(self.stroke.maximum, |r| r.most.min(self.stroke.maximum));
        let along = StrokeSections::new([least, most], |x| {
            let rotating = self.mechanism.rotating(x);
            let at_rest = TableState {
                position: x,
                loaded: 1.0,
                ..TableState::default()
            };
            DriveSection {
                compliance: self.mechanism.compliance(x),
                rotating: rotating.iter().map(|[inertia, _]| inertia).sum(),
                lagging: rotating.iter().map(|[inertia, lag]| inertia * lag).sum(),
                load: self.load_at(x) + hooks.loads_at(&at_rest),
            }
        })?;
        let mut cascade = self
            .control
            .cascade(travel, self.period)
            .unwrap_or(Cascade {
                position: 0.0,
                velocity_feedforward: 0.0,
                acceleration_feedforward: 0.0,
                speed: 0.0,
                speed_integral: 0.0,
                from_motor: false,
                signal_path: SignalPath::default(),
            });
        // A load without a sensor is where the motor says that it is.
        let missing = matches!(self.sensors.load, LoadSensor::Missing);
        cascade.signal_path.other_position |= cascade.from_motor && !missing;
        cascade.from_motor |= missing;
        let [amplitude, order, phase] = kinematics::harmonic(self, with_waves).unwrap_or_default();
        Ok(DriveModel {
            kinematics: Kinematics {
                free_travel: self.mechanism.backlash(),
                amplitude,
                order,
                phase,
            },
            travel,
            load_inertia: self.mechanism.load_inertia(),
            friction: friction::with_effects(self, hooks)?,
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
