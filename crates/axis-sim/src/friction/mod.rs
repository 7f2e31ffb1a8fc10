//! Friction at the load, by kind: LuGre, of which Coulomb's friction with a pre-sliding distance
//! and a viscous part are parameters, and other laws of the crate `lugre`.
//!
//! The simulated machine has the law of its kind. Plans, feed-forward and the search for what a
//! model lacks know LuGre alone: they take the LuGre law with the same stiffness, the means of both
//! directions' levels, an exponent of 2, and the viscous part that is linear. What friction may have besides are effects ([`crate::effects`]).

mod bouc_wen;
mod contact;
mod coulomb;
mod dahl;
mod elasto_plastic;
mod keys;
mod lugre_at_load;
mod lugre_at_motor;
mod maxwell_slip;

pub(crate) use contact::{Contact, ContactState};

use std::sync::Arc;

use lugre::{LuGre, Parameters};

use crate::freedom::Freedom;
use crate::part::{PartError, PartKind};

/// All kinds of friction, one line each.
pub const FRICTIONS: &[&PartKind<Friction>] = &[
    &lugre_at_motor::KIND,
    &lugre_at_load::LINEAR,
    &lugre_at_load::ROTARY,
    &coulomb::LINEAR,
    &coulomb::ROTARY,
    &dahl::LINEAR,
    &dahl::ROTARY,
    &elasto_plastic::LINEAR,
    &elasto_plastic::ROTARY,
    &bouc_wen::LINEAR,
    &bouc_wen::ROTARY,
    &maxwell_slip::LINEAR,
    &maxwell_slip::ROTARY,
];

/// Coulomb's friction at a load.
pub(crate) fn dry(freedom: Freedom) -> &'static PartKind<Friction> {
    match freedom {
        Freedom::Linear => &coulomb::LINEAR,
        Freedom::Rotary => &coulomb::ROTARY,
    }
}

/// Friction between the load and its guides.
#[derive(Clone, Debug)]
pub struct Friction {
    /// The law, in its own coordinate; of a kind that is not LuGre, the LuGre law nearest to it.
    pub law: LuGre,
    /// The coordinate.
    pub at: FrictionPlace,
    /// Unit element that effects act through: Coulomb level 1, the same
    /// pre-sliding distance.
    pub unit: LuGre,
    /// The law of a kind that is not LuGre.
    pub(crate) contact: Option<Arc<dyn Contact>>,
}

/// The coordinate of a friction law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionPlace {
    /// The motor's shaft: N·m over rad/s; the force on the load is that divided by r.
    Motor,
    /// The load: N over m/s, or N·m over rad/s.
    Load(Freedom),
}

/// Units of a friction law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrictionUnits {
    /// Where it acts, in words.
    pub at: &'static str,
    /// Of its speed.
    pub speed: &'static str,
    /// Of its force or torque.
    pub force: &'static str,
    /// Of its damping.
    pub damping: &'static str,
    /// Of its bristles' stiffness.
    pub stiffness: &'static str,
}

impl FrictionPlace {
    /// The units of a law in this coordinate.
    pub fn units(self) -> FrictionUnits {
        let rotary = |at| FrictionUnits {
            at,
            speed: "rad/s",
            force: "N·m",
            damping: "N·m·s/rad",
            stiffness: "N·m/rad",
        };
        match self {
            Self::Motor => rotary("the motor's shaft"),
            Self::Load(Freedom::Rotary) => rotary("the load"),
            Self::Load(Freedom::Linear) => FrictionUnits {
                at: "the load",
                speed: "m/s",
                force: "N",
                damping: "N·s/m",
                stiffness: "N/m",
            },
        }
    }
}

impl Friction {
    /// Load travel per unit of the law's coordinate, where the load moves by
    /// `travel` a radian of the motor.
    pub fn lever(&self, travel: f64) -> f64 {
        match self.at {
            FrictionPlace::Motor => travel,
            FrictionPlace::Load(_) => 1.0,
        }
    }

    fn new(
        parameters: Parameters,
        unit_stiffness: f64,
        at: FrictionPlace,
    ) -> Result<Self, PartError> {
        let valid = "stiction at least as great as coulomb";
        let law = LuGre::new(parameters).map_err(|e| PartError::together(e, valid))?;
        let unit = Parameters {
            coulomb: 1.0,
            stiction: 1.0,
            stribeck_speed: parameters.stribeck_speed,
            stiffness: unit_stiffness,
            damping: 0.0,
            viscous: 0.0,
        };
        let unit = LuGre::new(unit).map_err(|e| PartError::together(e, "another stiffness"))?;
        Ok(Self {
            law,
            at,
            unit,
            contact: None,
        })
    }
}
