//! An effect, and one with its values.

use super::changes::Changes;
use super::parameter::{EffectNeed, EffectParameter, Nature, Scales};
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
    /// An effect made elsewhere, outside of [`EFFECTS`](super::EFFECTS), can be put into
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
