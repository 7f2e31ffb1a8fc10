//! What an effect may change: parameters of an axis, and hooks in its loop.

use std::fmt;
use std::sync::Arc;

use foc_pmsm::{Dq, Phases};

use super::memory::{MemoryLaw, MemoryLaws};
use crate::axis::Axis;
use crate::cycle::Measured;
use crate::error::SetupError;
use crate::part::Role;

/// The load as a force on it sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct TableState {
    /// Since the motion began, s.
    pub time: f64,
    /// m or rad, absolute.
    pub position: f64,
    /// m/s or rad/s.
    pub speed: f64,
    /// Unit bristle, −1 to 1: the direction of sliding, without a jump. 0 if no force on
    /// the load changes with it ([`Steepness::bristle`]).
    pub bristle: f64,
    /// Share of a constant load that acts: it comes up over 20 ms, so that a
    /// log may start with the machine at rest under it.
    pub loaded: f64,
    /// Force of the transmission on the load at the start of the step, N or N·m.
    ///
    /// It is that of one step before, as the one at the end is not known before the load
    /// is: what is made of it is of first order in the step. A force on the load of at most
    /// the share η < 1 of it is stable at every step, as an error of it that is carried
    /// from step to step shrinks by η.
    pub transmitted: f64,
    /// Way that the load has travelled to and fro since the log began, up to the start of
    /// the step, m or rad; never falls.
    pub travelled: f64,
}

/// The most by which a force on the load changes with each part of its motion, rising or
/// falling. The default is not at all.
///
/// It tells the search for the force at the end of a step how near it is
/// ([`feed_dynamics::TimeStepper::with_steepest_load`]); one that is given too small makes
/// that end wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steepness {
    /// With the position, N/m or N·m/rad.
    pub position: f64,
    /// With the speed, N·s/m or N·m·s/rad.
    pub speed: f64,
    /// With the unit bristle, N or N·m.
    pub bristle: f64,
    /// With the force of the transmission, N/N. No step is made shorter by it, as that is
    /// known before the step; but settled motion is searched for where it is not 0.
    pub transmitted: f64,
}

impl Steepness {
    /// Nobody knows: as steep as can be.
    pub const UNKNOWN: Self = Self {
        position: f64::INFINITY,
        speed: f64::INFINITY,
        bristle: f64::INFINITY,
        transmitted: f64::INFINITY,
    };

    /// That of two forces together.
    #[must_use]
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            position: self.position + other.position,
            speed: self.speed + other.speed,
            bristle: self.bristle + other.bristle,
            transmitted: self.transmitted + other.transmitted,
        }
    }
}

/// The transmission as an error of its kinematics sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScrewState {
    /// Since the motion began, s.
    pub time: f64,
    /// Motor angle, rad, absolute.
    pub angle: f64,
    /// Motor speed, rad/s.
    pub rate: f64,
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its speed, m/s or rad/s.
    pub speed: f64,
    /// Force of the transmission on the load, N or N·m: its course over the last step
    /// continued to the end of this one, of second order in the step.
    pub transmitted: f64,
}

/// What the sensors get wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorErrors {
    /// Share by which both currents are shown too great.
    pub current_gain: f64,
    /// What the current sensors show at no current.
    pub current_offset: CurrentOffset,
    /// Amplitude and phase of each of the motor encoder's errors, rad.
    pub eccentricities: Vec<[f64; 2]>,
}

/// What the current sensors of a motor show at no current.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurrentOffset {
    /// Of phases a and b, A.
    pub phases: [f64; 2],
    /// Electrical periods per radian of the motor; none of an actuator whose current has no
    /// angle, and one sensor.
    pub poles: Option<f64>,
}

impl CurrentOffset {
    /// It in the rotor's frame at a motor angle (rad), A; none if the sensors show nothing.
    pub(crate) fn at(&self, motor_angle: f64) -> Option<Dq> {
        let [a, b] = self.phases;
        if [a, b] == [0.0; 2] {
            return None;
        }
        Some(match self.poles {
            Some(poles) => Phases { a, b, c: -a - b }
                .clarke()
                .park(poles * motor_angle),
            None => Dq { d: 0.0, q: a },
        })
    }
}

impl SensorErrors {
    /// By how much the motor's encoder shows too much at an angle, rad.
    pub(crate) fn eccentricity(&self, angle: f64) -> f64 {
        let all = self.eccentricities.iter();
        all.map(|[amplitude, phase]| amplitude * (angle + phase).sin())
            .sum()
    }

    /// What these sensors make of what perfect ones would show.
    pub(crate) fn show(&self, mut m: Measured) -> Measured {
        let gain = 1.0 + self.current_gain;
        m.current = m.current * gain;
        if let Some(offset) = self.current_offset.at(m.motor_angle) {
            m.current = m.current + offset;
        }
        let true_angle = m.motor_angle;
        let mut speed_ratio = 1.0;
        for [amplitude, phase] in &self.eccentricities {
            let at = true_angle + phase;
            m.motor_angle += amplitude * at.sin();
            speed_ratio += amplitude * at.cos();
        }
        m.motor_speed *= speed_ratio;
        m
    }
}

type Load = Arc<dyn Fn(&TableState) -> f64 + Send + Sync>;
type Torque = Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>;
type Offset = Arc<dyn Fn(&ScrewState) -> [f64; 2] + Send + Sync>;

/// Where the loop calls effects. The default has none, and costs nothing.
#[derive(Clone, Default)]
pub(crate) struct Hooks {
    loads: Vec<Load>,
    memories: MemoryLaws,
    /// That of all loads together.
    steepness: Steepness,
    torques: Vec<Torque>,
    offsets: Vec<Offset>,
    pub(crate) sensors: SensorErrors,
    pub(crate) clock_offset: f64,
    pub(crate) reference_delay: f64,
}

impl fmt::Debug for Hooks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hooks")
            .field("loads", &self.loads.len())
            .field("memories", &self.memories)
            .field("torques", &self.torques.len())
            .field("offsets", &self.offsets.len())
            .finish_non_exhaustive()
    }
}

impl Hooks {
    /// Adds a load on the table, N, positive against positive motion, that changes with
    /// its motion by at most `steepness`.
    pub fn load(
        &mut self,
        steepness: Steepness,
        load: impl Fn(&TableState) -> f64 + Send + Sync + 'static,
    ) {
        self.steepness = self.steepness.and(steepness);
        self.loads.push(Arc::new(load));
    }

    /// Adds a load with a memory that changes with the motion at the end of a step by at
    /// most `steepness`.
    pub fn memory(&mut self, steepness: Steepness, law: impl MemoryLaw + 'static) {
        self.steepness = self.steepness.and(steepness);
        self.memories.push(law);
    }

    /// Adds a motor torque, N·m, from motor angle (rad) and air-gap torque (N·m).
    pub fn torque(&mut self, torque: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) {
        self.torques.push(Arc::new(torque));
    }

    /// Adds a displacement of the nut, and its rate: m, m/s.
    pub fn offset(&mut self, offset: impl Fn(&ScrewState) -> [f64; 2] + Send + Sync + 'static) {
        self.offsets.push(Arc::new(offset));
    }

    pub(crate) fn steepness(&self) -> Steepness {
        self.steepness
    }

    pub(crate) fn has_loads(&self) -> bool {
        !(self.loads.is_empty() && self.memories.is_empty())
    }

    pub(crate) fn memories(&self) -> &MemoryLaws {
        &self.memories
    }

    pub(crate) fn has_offsets(&self) -> bool {
        !self.offsets.is_empty()
    }

    pub(crate) fn loads_at(&self, table: &TableState) -> f64 {
        self.loads.iter().map(|load| load(table)).sum()
    }

    pub(crate) fn torque_at(&self, angle: f64, torque: f64) -> f64 {
        let added = |sum, hook: &Torque| sum + hook(angle, torque);
        self.torques.iter().fold(torque, added)
    }

    pub(crate) fn offset_at(&self, screw: &ScrewState) -> [f64; 2] {
        self.offsets.iter().fold([0.0; 2], |sum, hook| {
            let [by, rate] = hook(screw);
            [sum[0] + by, sum[1] + rate]
        })
    }
}

/// An axis that effects are being put into.
pub struct Changes<'a> {
    pub(crate) axis: &'a mut Axis,
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

    /// Adds a displacement of the load on its transmission, and its rate: m, m/s or rad,
    /// rad/s. Only how it changes from the start on counts.
    pub fn offset(&mut self, offset: impl Fn(&ScrewState) -> [f64; 2] + Send + Sync + 'static) {
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
        self.axis.change(role, |before| before + value)
    }

    /// Changes the parameters of a role by a share of their values.
    ///
    /// # Errors
    /// [`SetupError::Part`] if the part refuses the new value.
    pub fn scale(&mut self, role: Role, share: f64) -> Result<(), SetupError> {
        self.axis.change(role, |before| before * (1.0 + share))
    }

    /// Travel of the load per radian of the motor, m/rad or rad/rad.
    pub fn travel_per_radian(&self) -> f64 {
        self.axis.travel_per_radian()
    }

    /// Travel of the load per unit of the friction law's coordinate.
    pub fn friction_lever(&self) -> f64 {
        self.axis.friction.lever(self.travel_per_radian())
    }

    /// Where motions start, m or rad.
    pub fn stroke_start(&self) -> f64 {
        self.axis.stroke.start
    }

    /// Stiffness of the transmission, N/m or N·m/rad at the load; infinite if motor and
    /// load are one.
    pub fn stiffness(&self) -> f64 {
        self.axis.mechanism.stiffness().unwrap_or(f64::INFINITY)
    }

    /// Greatest force of the actuator at the load, N or N·m.
    pub fn greatest_force(&self) -> f64 {
        let torque = self.axis.torque_constant() * self.axis.actuator.limit();
        torque / self.travel_per_radian()
    }

    /// Electrical periods per radian of the motor; 1 where it has none.
    pub fn pole_pairs(&self) -> f64 {
        self.axis.actuator.pole_pairs().unwrap_or(1.0)
    }
}
