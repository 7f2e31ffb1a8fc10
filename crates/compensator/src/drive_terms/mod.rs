//! What an ordinary drive or CNC can be given of a plan: constants, one pulse, one table.
//!
//! ```text
//! T = (J + r² m) a/r + B v/r + load(x) + T_r             torque feed-forward, N·m
//! s = C(x) ((r m + J_w/r) a + B v/r + load(x) + T_s)     wind-up, rad
//! ```
//!
//! T_r is the friction level sign(v) T_C with its [`Pulse`] after each change of direction,
//! T_s the same level with the change spread over the pulse's decay. A drive that closes
//! its position loop at the motor takes r s as an offset of the position. One that closes
//! it at the load takes ṡ as an offset of the speed: of its acceleration's part a multiple
//! of the jerk, of the friction's part a pulse. `docs/drive-terms.md` says how each is
//! entered.

mod apply;
mod pulse;

use lugre::Exponential;

pub use apply::DriveTermsFeedforward;
pub use pulse::{Pulse, Start};

use crate::CompensatorError;
use crate::error::{require, within};
use crate::model::{Along, DriveModel, SECTIONS, Section};

/// Numbers that an ordinary drive takes. SI units, torques and inertias at the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveTerms<T = f64> {
    /// Travel of the load per radian of the motor r, m/rad or rad/rad.
    pub travel: T,
    /// Torque per unit of the command K, N·m per unit.
    pub torque_constant: T,
    /// Inertia of all that moves at mid-stroke, J + r² m, kg·m².
    pub inertia: T,
    /// J alone: what turns with the motor, kg·m².
    pub rotating: T,
    /// Inertia of the load m, kg or kg·m².
    pub load_inertia: T,
    /// Share of v/r that the speed feed-forward is to have in all: 1.
    pub velocity_feedforward: T,
    /// Command per acceleration, (J + r² m)/(r K), unit of the command per m/s²; what the
    /// drive has already is not taken off.
    pub effort_per_acceleration: T,
    /// Viscous friction B, N·m per rad/s.
    pub viscous: T,
    /// Coulomb friction T_C, N·m.
    pub coulomb: T,
    /// What follows a change of direction.
    pub pulse: Pulse<T>,
    /// Torque of the axis' own loads at mid-stroke, N·m.
    pub standing: T,
    /// What depends on the position.
    pub along: Along<T>,
    /// Greatest command, in its unit.
    pub effort_limit: T,
    /// Control period, s.
    pub period: T,
    own: Own<T>,
}

/// What the drive's own loops have, which is not to be added twice.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Own<T> {
    position: T,
    velocity: T,
    acceleration: T,
    from_motor: bool,
}

/// A row of the table over the position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row<T = f64> {
    /// Position of the load, m or rad.
    pub position: T,
    /// Offset of the position per acceleration r C (r m + J_w/r), m per m/s²: for a
    /// position loop that is closed at the motor.
    pub position_per_acceleration: T,
    /// Offset of the motor's speed per jerk C (r m + J_w/r), rad/s per m/s³: for one that
    /// is closed at the load.
    pub speed_per_jerk: T,
    /// Lost motion 2 r C T_C from one direction to the other, m.
    pub lost_motion: T,
    /// Torque of the axis' own loads, N·m.
    pub load: T,
    /// Inertia J + r² m there, kg·m².
    pub inertia: T,
}

impl<T: Exponential> DriveTerms<T> {
    /// Of an axis as `model` has it, the pulse fitted to the friction along `start`.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] names what no terms can be made from.
    pub fn new(model: &DriveModel<T>, start: &Start<T>) -> Result<Self, CompensatorError> {
        model.check()?;
        for (name, value) in [("acceleration", start.acceleration), ("jerk", start.jerk)] {
            let valid = "from 0 to 1e9";
            require(within(value, 0.0, 1e9), name, value, valid)?;
        }
        let moves = start.acceleration + start.jerk > T::ZERO;
        require(moves, "jerk", start.jerk, "above 0 where acceleration is 0")?;
        let r = model.travel;
        let [least, most] = model.along.ends();
        let section = model.along.at(T::HALF * (least + most));
        let inertia = section.rotating + r * r * model.load_inertia;
        let torque_constant = model.torque_constant();
        // From the friction law's coordinate to the motor's.
        let ratio = r / model.lever;
        let p = model.friction.parameters();
        let c = &model.cascade;
        Ok(Self {
            travel: r,
            torque_constant,
            inertia,
            rotating: section.rotating,
            load_inertia: model.load_inertia,
            velocity_feedforward: T::ONE,
            effort_per_acceleration: inertia / (r * torque_constant),
            viscous: p.viscous * ratio * ratio,
            coulomb: p.coulomb * ratio,
            pulse: pulse::fit(model, start),
            standing: r * section.load,
            along: model.along,
            effort_limit: model.effort_limit,
            period: model.period,
            own: Own {
                position: c.position,
                velocity: c.velocity_feedforward,
                acceleration: c.acceleration_feedforward,
                from_motor: c.from_motor,
            },
        })
    }

    /// The table over the position, from the stroke's lower end to its upper.
    pub fn table(&self) -> impl Iterator<Item = Row<T>> + '_ {
        let [least, most] = self.along.ends();
        let gaps = T::of((SECTIONS - 1) as f64);
        (0..SECTIONS).map(move |i| self.row(least + (most - least) * T::of(i as f64) / gaps))
    }

    /// What the table has at `position`.
    #[must_use]
    pub fn row(&self, position: T) -> Row<T> {
        let section = self.along.at(position);
        let speed_per_jerk = section.compliance * self.winding(&section);
        Row {
            position,
            position_per_acceleration: self.travel * speed_per_jerk,
            speed_per_jerk,
            lost_motion: T::TWO * self.travel * section.compliance * self.coulomb,
            load: self.travel * section.load,
            inertia: self.inertia + section.rotating - self.rotating,
        }
    }

    /// Whether the drive closes its position loop at the motor.
    #[must_use]
    pub fn from_motor(&self) -> bool {
        self.own.from_motor
    }

    /// r m + J_w/r: torque that winds the transmission up, per acceleration.
    fn winding(&self, section: &Section<T>) -> T {
        self.travel * self.load_inertia + section.lagging / self.travel
    }
}
