//! Parts: what an axis is composed of.
//!
//! An axis is a mechanism, an actuator, a control, sensors, friction and
//! loads. Each comes in kinds, and a kind is one file: its keys in the axis
//! file with their units and limits, which of its parameters may be off, and
//! how the part is made from their values ([`PartKind`]). Whatever changes a
//! parameter (an effect, a tolerance, an identification) changes the values
//! and makes the part anew, so nothing else in the program knows a kind by name.

mod key;
pub mod units;
mod values;

pub use key::{Key, count, number, quantity, word};
pub(crate) use key::{Kind, table, tables, text, text_of};
pub use values::Values;

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use thiserror::Error;

/// What a parameter is in any machine: effects ask for a role, not for the
/// parameter of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Mass or inertia of the load, kg or kg·m².
    LoadInertia,
    /// Inertia of the motor's rotor, kg·m².
    MotorInertia,
    /// Stiffness between motor and load, or its most compliant member.
    TransmissionStiffness,
    /// Free travel between motor and load, at the load, m or rad.
    Backlash,
    /// Torque or force per actuator command.
    TorqueConstant,
    /// Resistance of the winding, Ω.
    Resistance,
    /// Voltage that each phase loses to the inverter's dead time, V.
    DeadTimeVoltage,
    /// Time by which the actuator's command comes late, s.
    CommandDelay,
    /// Position controller.
    PositionGain,
    /// Speed controller; all of its gains.
    SpeedGain,
    /// Share of the reference velocity that is fed forward.
    VelocityFeedforward,
    /// Bristle stiffness of the friction.
    BristleStiffness,
}

impl Role {
    /// In words, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::LoadInertia => "load inertia",
            Self::MotorInertia => "motor inertia of its own",
            Self::TransmissionStiffness => "transmission stiffness",
            Self::Backlash => "transmission that could have backlash",
            Self::TorqueConstant => "torque constant",
            Self::Resistance => "winding resistance",
            Self::DeadTimeVoltage => "inverter with dead time",
            Self::CommandDelay => "command that could come late",
            Self::PositionGain => "position controller's gain",
            Self::SpeedGain => "speed controller's gain",
            Self::VelocityFeedforward => "velocity feed-forward",
            Self::BristleStiffness => "bristle stiffness of its own",
        }
    }
}

/// Why values make no part.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{what}; valid: {valid}")]
pub struct PartError {
    /// The key at fault, where it is one.
    pub key: Option<&'static str>,
    /// What is wrong.
    pub what: String,
    /// What would be valid.
    pub valid: String,
}

impl PartError {
    /// About the value of one key.
    pub fn of(key: &'static str, what: impl Into<String>, valid: impl Into<String>) -> Self {
        Self {
            key: Some(key),
            what: what.into(),
            valid: valid.into(),
        }
    }

    /// About several values together; `error` says what and what would be valid.
    pub fn together(error: impl fmt::Display, valid: impl Into<String>) -> Self {
        Self {
            key: None,
            what: error.to_string(),
            valid: valid.into(),
        }
    }
}

/// A parameter of a kind that is known but may be off, by the axis file's
/// `[tolerances]`.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Its name in reports; with `_` for `-` in `[tolerances]`.
    pub name: &'static str,
    scale: Option<fn(&mut Values, f64)>,
    exact: bool,
    own_tolerance: Option<(f64, Option<Role>)>,
    of: Option<&'static str>,
    is_angle: bool,
}

impl Known {
    /// The parameter under a key, which is its name.
    pub const fn key(name: &'static str) -> Self {
        Self {
            name,
            scale: None,
            exact: false,
            own_tolerance: None,
            of: None,
            is_angle: false,
        }
    }

    /// The parameter under a key, exact unless `[tolerances]` names it: one that somebody
    /// has set, as a controller's gain.
    pub const fn exact(name: &'static str) -> Self {
        Self {
            exact: true,
            ..Self::key(name)
        }
    }

    /// Whether it is exact unless `[tolerances]` names it.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// One that `scale` multiplies by a factor near 1, whatever it takes.
    pub const fn by(name: &'static str, scale: fn(&mut Values, f64)) -> Self {
        Self {
            name,
            scale: Some(scale),
            exact: false,
            own_tolerance: None,
            of: None,
            is_angle: false,
        }
    }

    /// With a tolerance of its own, `share` of its value, which replaces the default tolerance of
    /// `[tolerances]` unless that table names the parameter.
    ///
    /// With a role in `covered_by`, the parameter is exact if every parameter of that role has a
    /// tolerance of `share` or more: those then account for its error.
    pub const fn with_own_tolerance(self, share: f64, covered_by: Option<Role>) -> Self {
        Self {
            own_tolerance: Some((share, covered_by)),
            ..self
        }
    }

    /// An angle, which has no size: what it is off by is no share of it but an angle in rad, with tolerances
    /// likewise.
    pub const fn as_angle(self) -> Self {
        Self {
            is_angle: true,
            ..self
        }
    }

    /// Whether what it is off by is an angle, rad, and no share of its value ([`Known::as_angle`]).
    pub fn is_angle(&self) -> bool {
        self.is_angle
    }

    /// A parameter of what stands under `key`: there is none where that is 0 or left out.
    pub const fn of(self, key: &'static str) -> Self {
        Self {
            of: Some(key),
            ..self
        }
    }

    /// Its own tolerance, and the role whose parameters can cover it ([`Known::with_own_tolerance`]).
    pub fn own_tolerance(&self) -> Option<(f64, Option<Role>)> {
        self.own_tolerance
    }

    /// Whether these values have it: a parameter that is 0 has no share to be off by.
    pub(crate) fn is_in(&self, values: &Values) -> bool {
        let is_there = |key| values.optional(key).is_some_and(|value| value != 0.0);
        self.of.is_none_or(is_there) && (self.scale.is_some() || is_there(self.name))
    }

    /// Multiplies it by a factor; nothing if the values do not have it.
    pub(crate) fn scale(&self, values: &mut Values, by: f64) {
        match self.scale {
            Some(scale) => scale(values, by),
            None => values.scale(self.name, by),
        }
    }
}

/// One kind of a part: a line of its registry.
pub struct PartKind<P: ?Sized> {
    /// Its word in the axis file.
    pub name: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// Its keys.
    pub keys: &'static [Key],
    /// The parameters that may be off.
    pub known: &'static [Known],
    /// Makes the part.
    pub build: fn(&Values) -> Result<Arc<P>, PartError>,
}

impl<P: ?Sized> PartKind<P> {
    /// A part of this kind with the least values that its keys take, to see how parts of
    /// it move; none if they make no part.
    pub(crate) fn example(&self) -> Option<Arc<P>> {
        let mut values = Values::default();
        for key in self.keys.iter().filter(|key| !key.optional) {
            key.set_least(&mut values);
        }
        (self.build)(&values).ok()
    }
}

impl<P: ?Sized> fmt::Debug for PartKind<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("PartKind").field(&self.name).finish()
    }
}

/// A part of an axis with the values it was made from.
pub struct Part<P: ?Sized + 'static> {
    kind: &'static PartKind<P>,
    values: Values,
    built: Arc<P>,
}

impl<P: ?Sized> Clone for Part<P> {
    fn clone(&self) -> Self {
        Self {
            kind: self.kind,
            values: self.values.clone(),
            built: self.built.clone(),
        }
    }
}

impl<P: ?Sized> fmt::Debug for Part<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct(self.kind.name)
            .field("values", &self.values)
            .finish_non_exhaustive()
    }
}

impl<P: ?Sized> Deref for Part<P> {
    type Target = P;

    fn deref(&self) -> &P {
        &self.built
    }
}

impl<P: ?Sized> Part<P> {
    /// Makes a part.
    ///
    /// # Errors
    /// [`PartError`] if the values make none.
    pub fn new(kind: &'static PartKind<P>, values: Values) -> Result<Self, PartError> {
        let built = (kind.build)(&values)?;
        Ok(Self {
            kind,
            values,
            built,
        })
    }

    /// Its kind.
    pub fn kind(&self) -> &'static PartKind<P> {
        self.kind
    }

    /// The parameters of it that may be off, with those that are exact unless
    /// `[tolerances]` names them.
    pub fn known(&self) -> impl Iterator<Item = &'static Known> + '_ {
        let all = self.kind.known.iter();
        all.filter(|known| known.is_in(&self.values))
    }

    /// What it was made from.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The part itself, to share.
    pub fn share(&self) -> Arc<P> {
        self.built.clone()
    }

    /// Changes values and makes the part anew; where that fails it stays as it was.
    ///
    /// # Errors
    /// [`PartError`] if the new values make no part.
    pub fn change(&mut self, change: impl FnOnce(&mut Values)) -> Result<(), PartError> {
        let mut values = self.values.clone();
        change(&mut values);
        if values != self.values {
            self.built = (self.kind.build)(&values)?;
            self.values = values;
        }
        Ok(())
    }

    /// Whether it has a parameter of that role.
    pub fn has(&self, role: Role) -> bool {
        self.kind.keys.iter().any(|key| key.role == Some(role))
    }

    /// The value of the first parameter of that role.
    pub fn value(&self, role: Role) -> Option<f64> {
        let mut keys = self.kind.keys.iter().filter(|key| key.role == Some(role));
        keys.find_map(|key| self.values.optional(key.name).or(key.default))
    }

    /// Applies `to` to the value of every parameter of that role.
    ///
    /// # Errors
    /// As [`Part::change`].
    pub fn change_role(&mut self, role: Role, to: impl Fn(f64) -> f64) -> Result<(), PartError> {
        let keys = self.kind.keys;
        self.change(|values| {
            for key in keys.iter().filter(|key| key.role == Some(role)) {
                if let Some(before) = values.optional(key.name).or(key.default) {
                    values.set(key.name, to(before));
                }
            }
        })
    }
}

/// The kind of that name among `kinds`.
pub fn named<P: ?Sized>(
    kinds: &[&'static PartKind<P>],
    name: &str,
) -> Option<&'static PartKind<P>> {
    kinds.iter().copied().find(|kind| kind.name == name)
}
