//! Effects that a model may lack: a registry of components of the closed loop.
//!
//! An [`Effect`] is one file and one line of [`EFFECTS`]. It changes an axis
//! by [`Changes`]: parameters by their [`Role`], whatever the kind of part, and
//! hooks where the loop calls it (a load, a torque at the motor, the transmission's
//! kinematics, what the sensors show). At its null value it changes nothing, to the bit.
//!
//! Effects add, whatever their order. Two entries of the same effect that agree
//! in all that shapes them (a phase, a width) are one with the sum of their
//! sizes, so that relative changes add too: twice 5 % is 10 %. Two that differ
//! in shape act side by side.
//!
//! Friction effects act through the unit bristle `u ∈ [−1, 1]` of a LuGre
//! element with the Coulomb level 1 and the axis' own pre-sliding distance, so
//! that none of them jumps at zero speed (Canudas de Wit et al., IEEE Trans.
//! Automat. Contr. 40 (1995) 419–425, doi:10.1109/9.376053).

mod asymmetric_friction;
mod asymmetric_viscous_friction;
mod backlash;
mod changes;
mod clock_offset;
mod cogging_torque;
mod constant_load;
mod control_delay;
mod controller_gain;
mod coulomb_friction;
mod current_sensor_gain;
mod current_sensor_offset;
mod cyclic_load;
mod encoder_eccentricity;
mod entry;
mod force_ripple;
mod forms;
mod gravity_imbalance;
mod hardening_stiffness;
mod install;
mod inverter_dead_time;
mod kinematic_error_harmonic;
mod lead_error;
mod load_dependent_friction;
mod maxwell_slip_hysteresis;
mod memory;
mod motor_inertia;
mod parameter;
mod payload_mass;
mod periodic_lead_error;
mod position_dependent_friction;
mod presliding;
mod process_force;
mod reference_delay;
mod speed_controller_gain;
mod spring_force;
mod stator_resistance;
mod stribeck_friction;
mod structural_resonance;
mod thermal_expansion;
mod torque_constant;
mod torque_ripple;
mod transmission_stiffness;
mod velocity_feedforward;
mod viscous_friction;
mod warming_friction;

pub(crate) use changes::Hooks;
pub use changes::{Changes, CurrentOffset, ScrewState, SensorErrors, Steepness, TableState};
pub use forms::{Formed, FrictionForm};
pub(crate) use install::install;
pub(crate) use memory::Memory;
pub use memory::{MemoryLaw, TableStep};
pub use parameter::{EffectNeed, EffectParameter, Measure, Nature, Scales};
use parameter::{PHASE, positive, shape, signed, size};

use crate::axis::Axis;
use crate::error::SetupError;
use crate::part::Role;

/// Where in the machine an effect shows itself first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectChannel {
    /// Torque balance: current against motion.
    Torque,
    /// Table against motor angle.
    Kinematics,
    /// Voltage against current and speed.
    Voltage,
    /// What the controller asks for against what it was shown.
    Controller,
    /// Time between channels.
    Clock,
}

impl EffectChannel {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Torque => "torque balance",
            Self::Kinematics => "kinematics",
            Self::Voltage => "voltage",
            Self::Controller => "controller",
            Self::Clock => "clock",
        }
    }
}

/// What of a motion an effect is best shown over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectVariable {
    /// Speed of the load.
    Speed,
    /// Position of the load.
    Position,
    /// Angle of the motor within its turn.
    MotorAngle,
    /// Acceleration of the load, which most of the force is for.
    Acceleration,
    /// q current, if there is one; time otherwise.
    Current,
    /// Distance travelled to and fro since the log began.
    Distance,
    /// Time since the log began: also for what depends on nothing, or on no single number.
    Time,
}

/// An effect of the registry.
#[derive(Clone, Copy, Debug)]
pub struct Effect {
    /// Its name, as in files and reports.
    pub name: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// Where it shows first.
    pub channel: EffectChannel,
    /// What it depends on, in words.
    pub depends_on: &'static str,
    /// What of the motion stands for that.
    pub shown_over: EffectVariable,
    /// Its numbers.
    pub parameters: &'static [EffectParameter],
    /// What an axis must have for it.
    pub needs: &'static [EffectNeed],
    /// Changes an axis; `values` are in the order of `parameters`.
    ///
    /// An effect made elsewhere, outside of [`EFFECTS`], can be put into
    /// [`crate::Axis::effects`] all the same; no search will name it.
    pub install: fn(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError>,
}

impl Effect {
    /// The values at which it changes nothing, on an axis of those scales.
    pub fn null(&self, on: &Scales) -> Vec<f64> {
        let null = |p: &EffectParameter| if p.is_size() { 0.0 } else { p.typical(on) };
        self.parameters.iter().map(null).collect()
    }

    /// Typical values there.
    pub fn typical(&self, on: &Scales) -> Vec<f64> {
        self.parameters.iter().map(|p| p.typical(on)).collect()
    }

    /// Whether an axis can have it, or else why not.
    ///
    /// # Errors
    /// The reason, as a sentence without its stop.
    pub fn applies_to(&self, axis: &Axis) -> Result<(), String> {
        self.needs.iter().try_for_each(|need| need.met(axis))
    }

    /// Roles of the axis' own parameters that it needs, and changes.
    pub fn roles(&self) -> impl Iterator<Item = Role> {
        self.needs.iter().filter_map(|need| match need {
            EffectNeed::Role(role) => Some(*role),
            _ => None,
        })
    }

    /// Its parameter of a nature.
    pub fn place_of(&self, nature: impl Fn(&Nature) -> bool) -> Option<usize> {
        self.parameters.iter().position(|p| nature(&p.nature))
    }

    /// The effect of that name.
    pub fn named(name: &str) -> Option<&'static Effect> {
        EFFECTS.iter().copied().find(|effect| effect.name == name)
    }
}

/// An effect with its values: one `[[effects]]` entry of an axis file.
#[derive(Clone, Debug)]
pub struct ActiveEffect {
    /// Which.
    pub effect: &'static Effect,
    /// SI, in the order of its parameters.
    pub values: Vec<f64>,
}

impl PartialEq for ActiveEffect {
    fn eq(&self, other: &Self) -> bool {
        self.effect.name == other.effect.name && self.values == other.values
    }
}

/// All effects, one line each.
pub const EFFECTS: &[&Effect] = &[
    &viscous_friction::EFFECT,
    &coulomb_friction::EFFECT,
    &asymmetric_friction::EFFECT,
    &asymmetric_viscous_friction::EFFECT,
    &stribeck_friction::EFFECT,
    &presliding::EFFECT,
    &position_dependent_friction::EFFECT,
    &load_dependent_friction::EFFECT,
    &warming_friction::EFFECT,
    &maxwell_slip_hysteresis::EFFECT,
    &constant_load::EFFECT,
    &process_force::EFFECT,
    &cyclic_load::EFFECT,
    &spring_force::EFFECT,
    &gravity_imbalance::EFFECT,
    &payload_mass::EFFECT,
    &structural_resonance::EFFECT,
    &motor_inertia::EFFECT,
    &torque_constant::EFFECT,
    &cogging_torque::EFFECT,
    &torque_ripple::EFFECT,
    &force_ripple::EFFECT,
    &current_sensor_offset::EFFECT,
    &current_sensor_gain::EFFECT,
    &backlash::EFFECT,
    &lead_error::EFFECT,
    &periodic_lead_error::EFFECT,
    &kinematic_error_harmonic::EFFECT,
    &thermal_expansion::EFFECT,
    &transmission_stiffness::EFFECT,
    &hardening_stiffness::EFFECT,
    &encoder_eccentricity::EFFECT,
    &inverter_dead_time::EFFECT,
    &stator_resistance::EFFECT,
    &control_delay::EFFECT,
    &controller_gain::EFFECT,
    &speed_controller_gain::EFFECT,
    &velocity_feedforward::EFFECT,
    &clock_offset::EFFECT,
    &reference_delay::EFFECT,
];
