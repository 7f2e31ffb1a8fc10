//! Controls: from what the sensors show and the reference asks to the actuator's command.

pub(crate) mod absent;
mod cascade;
mod filter;
mod output;
mod p_p;
mod pid;

use std::fmt;

use compensator::{Cascade, Correction};
use trajectories::Setpoint;

pub use cascade::{NOTCH_DAMPING, NOTCH_DEPTH};

use crate::actuator::{Effort, Surroundings};
use crate::cycle::Measured;
use crate::mechanism::{Freedom, Mechanism};
use crate::part::{Key, PartError, PartKind, Values};

/// All kinds of control, one line each.
pub const CONTROLS: &[&PartKind<dyn Control>] = &[&cascade::KIND, &p_p::KIND, &pid::KIND];

/// What a controller knows in a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// What the load should do, at the load.
    pub reference: &'a Setpoint,
    /// What the sensors show.
    pub measured: &'a Measured,
    /// What the compensator adds: to the position error, and to the actuator's command.
    pub correction: &'a Correction,
    /// Greatest command that the actuator takes now, in its unit: less than its limit where a
    /// part of that is taken for something else, as a motor's current by field weakening.
    pub limit: f64,
}

/// What a controller asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Speed reference of the motor, rad/s; 0 if there is no speed loop.
    pub speed_ref: f64,
    /// Command of the actuator, in its unit.
    pub effort: f64,
    /// Whether the command is at its limit.
    pub saturated: bool,
}

/// Gains of a position controller over a speed controller, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadeGains {
    /// Kv, speed of the load per position error, 1/s.
    pub position: f64,
    /// Command per speed error of the motor, unit of the command per rad/s.
    pub speed: f64,
    /// Command per angle error of the motor, unit of the command per rad. A control without an
    /// integral passes it over.
    pub speed_integral: f64,
    /// Command per acceleration of the load; none: as it is.
    pub acceleration_feedforward: Option<f64>,
    /// Frequency (Hz), damping and depth of a notch of the command; none: as it is.
    pub notch: Option<[f64; 3]>,
}

/// A control, immutable.
pub trait Control: fmt::Debug + Send + Sync {
    /// Kv of the position loop on a load that moves by `travel` a radian: speed per
    /// position error, 1/s. None if there is no such loop.
    fn velocity_gain(&self, travel: f64) -> Option<f64>;

    /// Whether a run can begin in motion from position and speed alone: there are no
    /// integrators whose state a log does not show.
    fn starts_in_motion(&self) -> bool {
        false
    }

    /// Whether an integrator holds what constant loads ask for, so that no error is left at
    /// rest.
    fn integrates(&self) -> bool {
        false
    }

    /// Effort per speed of the motor, as it acts at once: the way by which noise of the
    /// speed comes into the command. None if no speed of the motor is read.
    fn speed_gain(&self) -> Option<f64> {
        None
    }

    /// It as corrections pass through it, run once in each `period` (s) on a load that moves
    /// by `travel` a radian. None if there is no speed loop to pass through.
    fn cascade(&self, _travel: f64, _period: f64) -> Option<Cascade> {
        None
    }

    /// A PID controller of the position in the terms of a cascade, run once in each `period` (s) on a
    /// load that moves by `travel` a radian: its speed is the difference of the position over a
    /// period, and its integral sees the position error alone. None if it is no PID controller, or
    /// has no derivative.
    fn pid(&self, _travel: f64, _period: f64) -> Option<Cascade> {
        None
    }

    /// The values of a control of this kind with other gains, what `gains` leaves out as in
    /// `values`, those that it is made from, on a load that moves by `travel` a radian. None where
    /// it is neither [`Control::cascade`] nor [`Control::pid`].
    fn retuned(&self, _values: &Values, _gains: &CascadeGains, _travel: f64) -> Option<Values> {
        None
    }

    /// Control periods, of `period` seconds each, from one execution of its speed loop to the
    /// next: that over which a speed that is derived from an angle is the mean.
    fn speed_every(&self, _period: f64) -> u32 {
        1
    }

    /// Control periods, of `period` seconds each, after which all of its loops run in one cycle again: 1 if all of them
    /// run in each.
    fn ticks(&self, _period: f64) -> u32 {
        1
    }

    /// The unit in which its gains give the actuator's command, where they are tied to one.
    fn effort(&self) -> Option<Effort> {
        None
    }

    /// Keys of the gains that act on the motor's motion; the others act on the load's.
    fn at_motor(&self) -> &'static [&'static str] {
        &[]
    }

    /// A controller at rest.
    ///
    /// # Errors
    /// [`PartError`] if it does not fit its surroundings.
    fn start(&self, on: &Surroundings) -> Result<Box<dyn Controller>, PartError>;
}

/// The units that a gain of a control may be given in, with their factors to SI: those that
/// end in the actuator's command, per m or per rad as what the gain acts on moves.
pub fn units_of_gain(
    control: &dyn Control,
    key: &Key,
    effort: Effort,
    mechanism: &dyn Mechanism,
) -> Vec<(&'static str, f64)> {
    let turns = gain_turns(control, key.name(), mechanism);
    let units = key.units().iter().copied();
    units
        .filter(|(unit, _)| gain_fits(unit, turns, effort))
        .collect()
}

/// Whether what the gain under a key acts on turns.
pub(crate) fn gain_turns(control: &dyn Control, key: &str, mechanism: &dyn Mechanism) -> bool {
    let moves = match control.at_motor().contains(&key) {
        true => mechanism.motor_freedom(),
        false => mechanism.freedom(),
    };
    moves == Freedom::Rotary
}

/// Whether a unit is that of a gain on what turns or not, to a command in `effort`.
pub(crate) fn gain_fits(unit: &str, turns: bool, effort: Effort) -> bool {
    let ends = |ends: &[&str]| ends.iter().any(|end| unit.ends_with(end));
    let along = ends(&["_per_m", "_per_m_s", "_per_mm"]);
    let about = ends(&["_per_rad", "_per_rad_s", "_per_rpm", "_per_rpm_s"]);
    let moves = if turns { !along } else { !about };
    moves && Effort::of_gain(unit).is_none_or(|of| of == effort)
}

/// A controller at work.
pub trait Controller: fmt::Debug + Send + Sync {
    /// Brings it into the state that it has when it holds `effort` with all errors at
    /// zero, the sensors showing `measured`, the load moving at `speed`.
    fn settle(&mut self, effort: f64, measured: &Measured, speed: f64);

    /// Makes its next cycle the one that comes so many after a cycle in which all of its loops ran
    /// ([`Control::ticks`]); as it starts, that is the next.
    fn begin_after(&mut self, _cycles: u32) {}

    /// One control cycle.
    fn cycle(&mut self, situation: &Situation<'_>) -> Demand;

    /// A copy.
    fn copy(&self) -> Box<dyn Controller>;
}
