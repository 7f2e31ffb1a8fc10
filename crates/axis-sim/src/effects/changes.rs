//! What an effect may change: parameters of an axis, and hooks in its loop.
//!
//! An axis holds its effects, so that this file cannot know it: [`Changeable`] is what they ask of one.

use super::hooks::Hooks;
use super::memory::MemoryLaw;
use super::sensor_errors::SensorErrors;
use super::state::{ScrewState, Steepness, TableState};
use crate::error::SetupError;
use crate::part::Role;

/// What effects ask of an axis, and change in it.
pub(crate) trait Changeable {
    /// Applies `to` to every parameter of that role.
    ///
    /// # Errors
    /// [`SetupError::Part`] if a part refuses the new value.
    fn change(&mut self, role: Role, to: &dyn Fn(f64) -> f64) -> Result<(), SetupError>;

    /// Another axis of the same parts, to try changes on.
    fn copy(&self) -> Box<dyn Changeable>;

    /// [`Changes::travel_per_radian`].
    fn travel_per_radian(&self) -> f64;

    /// [`Changes::friction_lever`].
    fn friction_lever(&self) -> f64;

    /// [`Changes::stroke_start`].
    fn stroke_start(&self) -> f64;

    /// [`Changes::stiffness`].
    fn stiffness(&self) -> f64;

    /// [`Changes::greatest_force`].
    fn greatest_force(&self) -> f64;

    /// Electrical periods per radian of the motor, where it has poles.
    fn pole_pairs(&self) -> Option<f64>;
}

/// An axis that effects are being put into.
pub struct Changes<'a> {
    pub(crate) axis: &'a mut dyn Changeable,
    pub(crate) hooks: &'a mut Hooks,
}

/// The values of an effect with K parameters; missing ones are 0.
pub(super) fn array<const K: usize>(values: &[f64]) -> [f64; K] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0))
}

impl Changes<'_> {
    /// Adds a load, N or N·m, positive against positive motion.
    pub fn load(&mut self, load: impl Fn(&TableState) -> f64 + Send + Sync + 'static) {
        self.load_within(Steepness::UNKNOWN, load);
    }

    /// The same for a load of which it is known how steep it is at most, which saves time.
    pub fn load_within(
        &mut self,
        steepness: Steepness,
        load: impl Fn(&TableState) -> f64 + Send + Sync + 'static,
    ) {
        self.hooks.load(steepness, load);
    }

    /// Adds a load that depends on what the load did before: each run has a memory of
    /// its own. `steepness` says by how much it changes at most with the motion at the end
    /// of a step of any length.
    pub fn load_with_memory(&mut self, steepness: Steepness, law: impl MemoryLaw + 'static) {
        self.hooks.memory(steepness, law);
    }

    /// Adds a motor torque, N·m, from motor angle (rad) and the actuator's torque (N·m).
    pub fn torque(&mut self, torque: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) {
        self.hooks.torque(torque);
    }

    /// Adds a displacement o of the load on its transmission, its rate, and its derivative do/dθ
    /// over the motor's angle: m, m/s, m/rad or rad, rad/s, rad/rad. Of o only how it changes
    /// from the start on counts. By do/dθ the force F of the transmission reacts on the motor beside
    /// the travel r per radian, with the torque −F (r + do/dθ), so that what the motor
    /// gives is what the load gets; 0 of a displacement that does not come from the motor's turning.
    pub fn offset(&mut self, offset: impl Fn(&ScrewState) -> [f64; 3] + Send + Sync + 'static) {
        self.hooks.offset(offset);
    }

    /// What the sensors get wrong.
    pub fn sensors(&mut self) -> &mut SensorErrors {
        &mut self.hooks.sensors
    }

    /// Makes the load's channel of a log late by `time` seconds.
    pub fn clock_offset(&mut self, time: f64) {
        self.hooks.clock_offset += time;
    }

    /// Makes the reference's channels of a log late by `time` seconds.
    pub fn reference_delay(&mut self, time: f64) {
        self.hooks.reference_delay += time;
    }

    /// Adds to the parameter of a role, in its SI unit.
    ///
    /// # Errors
    /// [`SetupError::Part`] if the part refuses the new value.
    pub fn add(&mut self, role: Role, value: f64) -> Result<(), SetupError> {
        self.axis.change(role, &|before| before + value)
    }

    /// Changes the parameters of a role by a share of their values.
    ///
    /// # Errors
    /// [`SetupError::Part`] if the part refuses the new value.
    pub fn scale(&mut self, role: Role, share: f64) -> Result<(), SetupError> {
        self.axis.change(role, &|before| before * (1.0 + share))
    }

    /// Travel of the load per radian of the motor, m/rad or rad/rad.
    pub fn travel_per_radian(&self) -> f64 {
        self.axis.travel_per_radian()
    }

    /// Travel of the load per unit of the friction law's coordinate.
    pub fn friction_lever(&self) -> f64 {
        self.axis.friction_lever()
    }

    /// Where motions start, m or rad.
    pub fn stroke_start(&self) -> f64 {
        self.axis.stroke_start()
    }

    /// Stiffness of the transmission, N/m or N·m/rad at the load; infinite if motor and
    /// load are one.
    pub fn stiffness(&self) -> f64 {
        self.axis.stiffness()
    }

    /// Greatest force of the actuator at the load, N or N·m.
    pub fn greatest_force(&self) -> f64 {
        self.axis.greatest_force()
    }

    /// Electrical periods per radian of the motor; 1 where it has none.
    pub fn pole_pairs(&self) -> f64 {
        self.axis.pole_pairs().unwrap_or(1.0)
    }
}
