//! Effects that a model may lack: a registry of components of the closed loop.
//!
//! An [`Effect`] is one file and one line of [`EFFECTS`]. It changes an axis
//! by [`Changes`]: parameters by their [`Role`](crate::part::Role), whatever the kind of part, and
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
mod effect;
mod encoder_eccentricity;
mod entry;
mod fit;
mod force_ripple;
mod forms;
mod gravity_imbalance;
mod hardening_stiffness;
mod hooks;
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
mod sensor_errors;
mod speed_controller_gain;
mod spring_force;
mod state;
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

pub use changes::Changes;
pub use effect::{ActiveEffect, Effect, EffectChannel, EffectVariable};
pub use forms::{Formed, FrictionForm};
pub(crate) use hooks::Hooks;
pub(crate) use memory::Memory;
pub use memory::{MemoryLaw, TableStep};
pub use parameter::{EffectNeed, EffectParameter, Measure, Nature, Scales};
use parameter::{PHASE, positive, shape, signed, size};
pub use sensor_errors::{CurrentOffset, SensorErrors};
pub use state::{ScrewState, Steepness, TableState};

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

impl Effect {
    /// The effect of that name.
    pub fn named(name: &str) -> Option<&'static Effect> {
        EFFECTS.iter().copied().find(|effect| effect.name == name)
    }
}
