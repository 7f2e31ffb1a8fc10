//! What an ordinary drive or CNC can be given of a plan: constants, one pulse, one table.
//!
//! ```text
//! T = (J + r² m) a/r + B v/r + r load(x) + T_r               torque feed-forward, N·m
//! s = C(x) ((r m + J_w(x)/r) a + B v/r + r load(x) + T_s)    wind-up, rad
//! ```
//!
//! T_r is the friction level sign(v) T_C with its [`ReversalPulse`] after each change of
//! direction, T_s the same level as it comes over the pulse's decay. A drive that closes
//! its position loop at the motor takes r s as an offset of the position. One that closes
//! it at the load takes ṡ as an offset of the speed: the acceleration's part is a multiple
//! of the jerk, the friction's a pulse. `docs/drive-terms.md` says how each is entered.
//!
//! Left out of the plan: the bristles' state, wind-up under the bristles' damping, s̈ in
//! the torque, the smoothing, and the inverse of the current loop.

mod apply;
mod pulse;

use axis_scalar::Scalar;
use lugre::Exponential;

pub use apply::DriveTermsFeedforward;
pub use pulse::{ReversalPulse, ReversalStart};

use crate::CompensatorError;
use crate::error::{require, within};
use crate::model::{DriveModel, DriveSection, SECTIONS, StrokeSections};

/// Numbers that an ordinary drive takes. SI units; torques and inertias at the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveTerms<T = f64> {
    /// Travel of the load per radian of the motor r, m/rad or rad/rad.
    pub travel: T,
    /// Torque per unit of the command K, N·m per unit.
    pub torque_constant: T,
    /// Inertia of all that moves, J + r² m at mid-stroke, kg·m².
    pub inertia: T,
    /// J at mid-stroke: what turns with the motor, kg·m².
    pub rotating: T,
    /// Inertia of the load m, kg or kg·m².
    pub load_inertia: T,
    /// Command per acceleration in all, (J + r² m)/(r K), unit of the command per m/s².
    pub effort_per_acceleration: T,
    /// Share of v/r that the speed feed-forward is to have in all: 1.
    pub velocity_feedforward: T,
    /// Viscous friction B, N·m per rad/s.
    pub viscous: T,
    /// Coulomb friction T_C, N·m.
    pub coulomb: T,
    /// What follows a change of direction.
    pub pulse: ReversalPulse<T>,
    /// Torque of the axis' own loads at mid-stroke, N·m.
    pub standing: T,
    /// What depends on the position.
    pub along: StrokeSections<T>,
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
    speed: T,
    velocity: T,
    acceleration: T,
    from_motor: bool,
}

/// A row of the table over the position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveTermsRow<T = f64> {
    /// Position of the load, m or rad.
    pub position: T,
    /// Offset of the position per acceleration, r C (r m + J_w/r), m per m/s²: for a
    /// position loop that is closed at the motor.
    pub position_per_acceleration: T,
    /// Offset of the motor's speed per jerk, C (r m + J_w/r), rad/s per m/s³: for one that
    /// is closed at the load.
    pub speed_per_jerk: T,
    /// Lost motion from one direction to the other, 2 r C T_C, m.
    pub lost_motion: T,
    /// Torque of the axis' own loads, N·m.
    pub load: T,
    /// Inertia J + r² m, kg·m².
    pub inertia: T,
}

impl DriveTerms {
    /// Of an axis as `model` has it, the pulse fitted to the friction along `start`.
    ///
    /// For design time: the fit runs the start some hundred times.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] names what no terms can be made from.
    pub fn new(model: &DriveModel, start: &ReversalStart) -> Result<Self, CompensatorError> {
        model.check()?;
        start.check()?;
        let r = model.travel;
        let [least, most] = model.along.ends();
        let section = model.along.at(0.5 * (least + most));
        let inertia = section.rotating + r * r * model.load_inertia;
        let torque_constant = model.torque_constant();
        // From the friction law's coordinate to the motor's.
        let ratio = r / model.lever;
        let p = model.friction.parameters();
        let terms = Self {
            travel: r,
            torque_constant,
            inertia,
            rotating: section.rotating,
            load_inertia: model.load_inertia,
            effort_per_acceleration: inertia / (r * torque_constant),
            velocity_feedforward: 1.0,
            viscous: p.viscous * ratio * ratio,
            coulomb: p.coulomb * ratio,
            pulse: pulse::fit(model, start, [inertia, section.compliance]),
            standing: r * section.load,
            along: model.along,
            effort_limit: model.effort_limit,
            period: model.period,
            own: Own {
                position: model.cascade.position,
                speed: model.cascade.speed,
                velocity: model.cascade.velocity_feedforward,
                acceleration: model.cascade.acceleration_feedforward,
                from_motor: model.cascade.from_motor,
            },
        };
        for (name, value) in [
            ("inertia", terms.inertia),
            ("effort_per_acceleration", terms.effort_per_acceleration),
            ("viscous", terms.viscous),
            ("coulomb", terms.coulomb),
            ("velocity_feedforward", terms.own.velocity),
            ("acceleration_feedforward", terms.own.acceleration),
        ] {
            require(within(value, -1e12, 1e12), name, value, "within ±1e12")?;
        }
        Ok(terms)
    }
}

impl<T: Exponential> DriveTerms<T> {
    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> DriveTerms<U> {
        let to = |value: T| U::of(value.to_f64());
        DriveTerms {
            travel: to(self.travel),
            torque_constant: to(self.torque_constant),
            inertia: to(self.inertia),
            rotating: to(self.rotating),
            load_inertia: to(self.load_inertia),
            effort_per_acceleration: to(self.effort_per_acceleration),
            velocity_feedforward: to(self.velocity_feedforward),
            viscous: to(self.viscous),
            coulomb: to(self.coulomb),
            pulse: ReversalPulse {
                delay: to(self.pulse.delay),
                amplitude: to(self.pulse.amplitude),
                decay: to(self.pulse.decay),
            },
            standing: to(self.standing),
            along: self.along.cast(),
            effort_limit: to(self.effort_limit),
            period: to(self.period),
            own: Own {
                position: to(self.own.position),
                speed: to(self.own.speed),
                velocity: to(self.own.velocity),
                acceleration: to(self.own.acceleration),
                from_motor: self.own.from_motor,
            },
        }
    }

    /// The table over the position, from the stroke's lower end to its upper.
    pub fn table(&self) -> impl Iterator<Item = DriveTermsRow<T>> + '_ {
        let [least, most] = self.along.ends();
        let gaps = T::of((SECTIONS - 1) as f64);
        (0..SECTIONS).map(move |i| self.row(least + (most - least) * T::of(i as f64) / gaps))
    }

    /// What the table has at `position`.
    #[must_use]
    pub fn row(&self, position: T) -> DriveTermsRow<T> {
        let section = self.along.at(position);
        let speed_per_jerk = section.compliance * self.winding(&section);
        DriveTermsRow {
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

    /// Command per acceleration that the drive has itself already.
    #[must_use]
    pub fn own_effort_per_acceleration(&self) -> T {
        self.own.acceleration
    }

    /// Speed of the motor per position error P, rad/s per m; 0 if no offset of the
    /// position becomes a speed.
    #[must_use]
    pub fn position_gain(&self) -> T {
        self.own.position
    }

    /// Share of v/r that the drive feeds forward itself already.
    #[must_use]
    pub fn own_velocity_feedforward(&self) -> T {
        self.own.velocity
    }

    /// The pulse as a jump of the speed reference, a/(K k_p), which the speed controller of
    /// gain k_p makes the pulse's torque of, rad/s; 0 if there is no speed controller.
    #[must_use]
    pub fn speed_injection(&self) -> T {
        let per_speed = self.torque_constant * self.own.speed;
        if per_speed > T::ZERO {
            self.pulse.amplitude / per_speed
        } else {
            T::ZERO
        }
    }

    /// The jump of the speed with which the motor is to wind the transmission up as the
    /// friction level comes after a start, C T_C/decay at mid-stroke, rad/s; twice that
    /// after a reversal. 0 if the level comes at once.
    #[must_use]
    pub fn winding_speed(&self) -> T {
        let [least, most] = self.along.ends();
        let section = self.along.at(T::HALF * (least + most));
        if self.pulse.decay > T::ZERO {
            section.compliance * self.coulomb / self.pulse.decay
        } else {
            T::ZERO
        }
    }

    /// r m + J_w/r: torque that winds the transmission up, per acceleration.
    fn winding(&self, section: &DriveSection<T>) -> T {
        self.travel * self.load_inertia + section.lagging / self.travel
    }
}
