//! What a compensator assumes of an axis: the numbers of its feed-forward.
//!
//! ```text
//! T = J a/r + r (m a + F) + (J − J_w) s̈        torque of the motor
//! s = C (r (m a + F) + J_w a/r)                wind-up of the motor against the load
//! ```
//!
//! r is the travel per radian, m the load's inertia, F the force against it (friction and
//! loads), J what turns with the motor, C the compliance from motor to load as seen at the
//! motor, and J_w = Σ Jᵢ κᵢ the part of J that lags the motor by a share κᵢ of the wind-up.
//! `docs/theory/compensator.md` derives both.

use axis_scalar::Scalar;
use foc_pmsm::{MotorParameters, Pmsm};
use lugre::{Exponential, LuGre};

use crate::error::{self, require, within};
use crate::{CompensatorError, SignalPath};

/// Positions at which [`StrokeSections`] holds its values.
pub const SECTIONS: usize = 33;

/// What of an axis depends on the load's position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveSection<T = f64> {
    /// Compliance C from motor to load, rad/(N·m) at the motor.
    pub compliance: T,
    /// J, all that turns with the motor, kg·m².
    pub rotating: T,
    /// J_w, the part of it that lags the motor, kg·m².
    pub lagging: T,
    /// Force of the axis' own loads against positive motion, N (N·m where it turns).
    pub load: T,
}

/// Sections evenly spread over the stroke; linear between them, constant beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeSections<T = f64> {
    least: T,
    per_length: T,
    sections: [DriveSection<T>; SECTIONS],
}

impl<T: Scalar> StrokeSections<T> {
    /// From the position `least` to `most` (m or rad), the section at each position from
    /// `at`.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] if the ends are not finite or not in order, or a
    /// section is not finite or has a negative compliance or inertia.
    pub fn new(
        [least, most]: [T; 2],
        mut at: impl FnMut(T) -> DriveSection<T>,
    ) -> Result<Self, CompensatorError> {
        let inside = least.is_finite() && most.is_finite() && most > least;
        require(inside, "stroke", most, "finite, and above its lower end")?;
        let gaps = T::of((SECTIONS - 1) as f64);
        let mut sections = [DriveSection::default(); SECTIONS];
        for (i, section) in sections.iter_mut().enumerate() {
            *section = at(least + (most - least) * T::of(i as f64) / gaps);
            let s = *section;
            let named = [
                ("compliance", s.compliance),
                ("rotating", s.rotating),
                ("lagging", s.lagging),
            ];
            for (name, value) in named {
                let inside = value >= T::ZERO && value.is_finite();
                require(inside, name, value, "finite and at least 0")?;
            }
            require(s.load.is_finite(), "load", s.load, "finite")?;
        }
        Ok(Self {
            least,
            per_length: gaps / (most - least),
            sections,
        })
    }

    /// Position of the first section, and sections per length.
    #[must_use]
    pub fn grid(&self) -> [T; 2] {
        [self.least, self.per_length]
    }

    /// The sections.
    #[must_use]
    pub fn sections(&self) -> &[DriveSection<T>; SECTIONS] {
        &self.sections
    }

    /// The positions of its first and its last section.
    #[must_use]
    pub fn ends(&self) -> [T; 2] {
        let gaps = T::of((SECTIONS - 1) as f64);
        [self.least, self.least + gaps / self.per_length]
    }

    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> StrokeSections<U> {
        let to = |value: T| U::of(value.to_f64());
        StrokeSections {
            least: to(self.least),
            per_length: to(self.per_length),
            sections: self.sections.map(|s| DriveSection {
                compliance: to(s.compliance),
                rotating: to(s.rotating),
                lagging: to(s.lagging),
                load: to(s.load),
            }),
        }
    }

    /// The section at `position`.
    #[must_use]
    pub fn at(&self, position: T) -> DriveSection<T> {
        let last = T::of((SECTIONS - 1) as f64);
        // Not a number goes to the lower end.
        let along = ((position - self.least) * self.per_length)
            .max(T::ZERO)
            .min(last);
        let node = (along.to_f64() as usize).min(SECTIONS - 2);
        let share = along - T::of(node as f64);
        let [a, b] = [&self.sections[node], &self.sections[node + 1]];
        let between = |a: T, b: T| a + share * (b - a);
        DriveSection {
            compliance: between(a.compliance, b.compliance),
            rotating: between(a.rotating, b.rotating),
            lagging: between(a.lagging, b.lagging),
            load: between(a.load, b.load),
        }
    }

    /// The same with every compliance times `scale`.
    #[must_use]
    pub fn with_compliance(mut self, scale: T) -> Self {
        for section in &mut self.sections {
            section.compliance *= scale;
        }
        self
    }

    /// The same with a load of `force` (N, N·m where it turns) more everywhere.
    #[must_use]
    pub fn with_load(mut self, force: T) -> Self {
        for section in &mut self.sections {
            section.load += force;
        }
        self
    }

    /// The greatest compliance, rad/(N·m).
    #[must_use]
    pub fn most_compliance(&self) -> T {
        let of = |most: T, section: &DriveSection<T>| most.max(section.compliance);
        self.sections.iter().fold(T::ZERO, of)
    }
}

/// A natural mode of the mechanism at one position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mode {
    /// Angular frequency, rad/s; 0 for the rigid motion.
    pub frequency: f64,
    /// 2ζω, 1/s.
    pub damping: f64,
    /// Mass-normalised shape at the motor, rad/√(kg·m²).
    pub motor: f64,
    /// At the load, m/√(kg·m²), or rad/√(kg·m²).
    pub load: f64,
}

/// How the actuator makes torque of its command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive<T = f64> {
    /// Torque per command (N·m per A, N·m, N or V) behind a first-order lag (rad/s;
    /// infinite for none).
    Lag {
        /// N·m per unit of the command.
        gain: T,
        /// Bandwidth, rad/s.
        bandwidth: T,
    },
    /// A permanent-magnet motor under two PI current controllers, i_d = 0.
    FieldOriented {
        /// The motor; its speed is `gear` times that of the axis' motor coordinate.
        motor: Pmsm<T>,
        /// Radians of the motor per unit of the axis' motor coordinate; 1 where it turns.
        gear: T,
        /// Gains [k_p in V/A, k_i in V/(A·s)] of the d controller.
        d: [T; 2],
        /// Those of the q controller.
        q: [T; 2],
        /// Greatest length of the voltage, V.
        voltage: T,
        /// Control periods from the sample of a current until the voltage made of it begins to
        /// act; it is held for one then.
        late: T,
    },
}

impl<T: Scalar> Drive<T> {
    /// Control periods from the sample of a current until the voltage made of it begins to
    /// act; 0 if there is no current loop.
    #[must_use]
    pub fn late(&self) -> T {
        match self {
            Self::Lag { .. } => T::ZERO,
            Self::FieldOriented { late, .. } => *late,
        }
    }

    /// Each value rounded; none if the motor's leave their ranges by that.
    fn cast<U: Scalar>(&self) -> Option<Drive<U>> {
        let to = |value: T| U::of(value.to_f64());
        Some(match self {
            Self::Lag { gain, bandwidth } => Drive::Lag {
                gain: to(*gain),
                bandwidth: to(*bandwidth),
            },
            Self::FieldOriented {
                motor,
                gear,
                d,
                q,
                voltage,
                late,
            } => {
                let p = motor.parameters();
                let parameters = MotorParameters {
                    pole_pairs: p.pole_pairs,
                    resistance: to(p.resistance),
                    inductance_d: to(p.inductance_d),
                    inductance_q: to(p.inductance_q),
                    flux_linkage: to(p.flux_linkage),
                };
                Drive::FieldOriented {
                    motor: Pmsm::new(parameters).ok()?,
                    gear: to(*gear),
                    d: d.map(to),
                    q: q.map(to),
                    voltage: to(*voltage),
                    late: to(*late),
                }
            }
        })
    }
}

impl<T: Scalar> Cascade<T> {
    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Cascade<U> {
        let to = |value: T| U::of(value.to_f64());
        Cascade {
            position: to(self.position),
            velocity_feedforward: to(self.velocity_feedforward),
            acceleration_feedforward: to(self.acceleration_feedforward),
            speed: to(self.speed),
            speed_integral: to(self.speed_integral),
            from_motor: self.from_motor,
            signal_path: self.signal_path.cast(),
        }
    }
}

/// The drive's own position and speed loop, as far as corrections pass through it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascade<T = f64> {
    /// Speed of the motor per position error P, rad/s per m; 0 if a correction of the
    /// position does not become a speed.
    pub position: T,
    /// Speed feed-forward that the drive has itself, as a share of v/r.
    pub velocity_feedforward: T,
    /// Command per acceleration of the load that the drive feeds forward itself.
    pub acceleration_feedforward: T,
    /// Command per speed error of the motor, unit of the command per rad/s.
    pub speed: T,
    /// Command per angle error of the motor, unit of the command per rad.
    pub speed_integral: T,
    /// Whether the position comes from the motor, not from the load.
    pub from_motor: bool,
    /// What lies between a correction and the command besides.
    pub signal_path: SignalPath<T>,
}

/// How the motor runs ahead of the load without any force: free travel, and an error of the
/// transmission that repeats with the motor's turn. Nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kinematics<T = f64> {
    /// Free travel between motor and load, m or rad at the load.
    pub free_travel: T,
    /// Amplitude by which the load runs ahead of r θ, a sin(n θ + φ), m or rad.
    pub amplitude: T,
    /// n, in radians of the error per radian of the motor.
    pub order: T,
    /// φ at the motor's angle 0, rad.
    pub phase: T,
}

/// Steepness of the side on which a transmission with free travel lies, over the Coulomb
/// level of the friction behind it: flanks touch under next to no torque, and noise of the
/// torque is some thousandths of that level.
const STEEP: f64 = 100.0;

impl<T: Scalar> Kinematics<T> {
    /// Part of the free travel by which the motor is ahead of the middle, m or rad at the
    /// load, where the torque through the transmission is the share `transmitted` of the
    /// Coulomb level: smooth, and never more than half of it.
    #[must_use]
    pub fn side(&self, transmitted: T) -> T {
        // tanh x = e/(e + 2), e = e^{2x} − 1; at ±20 it is 1 to the last digit.
        let twice = T::TWO * T::of(STEEP) * transmitted;
        let raised = twice.max(T::of(-40.0)).min(T::of(40.0)).exp_m1();
        T::HALF * self.free_travel * raised / (raised + T::TWO)
    }

    /// How far the load runs ahead of r θ at the motor's angle θ (rad), m or rad.
    #[must_use]
    pub fn ahead(&self, angle: T) -> T {
        if self.amplitude == T::ZERO {
            return T::ZERO;
        }
        let (sin, _) = (self.order * angle + self.phase).sin_cos();
        self.amplitude * sin
    }

    /// By how much more than r the load moves per radian at the motor's angle θ (rad), m/rad or rad/rad: as
    /// much more of a lever a force on the load has at the motor.
    #[must_use]
    pub fn growth(&self, angle: T) -> T {
        if self.amplitude == T::ZERO {
            return T::ZERO;
        }
        let (_, cos) = (self.order * angle + self.phase).sin_cos();
        self.amplitude * self.order * cos
    }

    /// Each value rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> Kinematics<U> {
        let to = |value: T| U::of(value.to_f64());
        Kinematics {
            free_travel: to(self.free_travel),
            amplitude: to(self.amplitude),
            order: to(self.order),
            phase: to(self.phase),
        }
    }

    fn check(&self) -> Result<(), CompensatorError> {
        let inside = within(self.free_travel, 0.0, 1e3);
        require(
            inside,
            "free_travel",
            self.free_travel,
            "from 0 to 1000 m or rad",
        )?;
        let named = [
            ("amplitude", self.amplitude),
            ("order", self.order),
            ("phase", self.phase),
        ];
        for (name, value) in named {
            require(within(value, -1e6, 1e6), name, value, "from -1e6 to 1e6")?;
        }
        Ok(())
    }
}

/// Everything that a plan is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveModel<T = f64> {
    /// Travel of the load per radian of the motor r, m/rad or rad/rad.
    pub travel: T,
    /// Inertia of the load m, kg or kg·m².
    pub load_inertia: T,
    /// Friction, in its own coordinate.
    pub friction: LuGre<T>,
    /// Travel of the load per unit of that coordinate.
    pub lever: T,
    /// What depends on the position.
    pub along: StrokeSections<T>,
    /// How the motor runs ahead without any force.
    pub kinematics: Kinematics<T>,
    /// The actuator.
    pub drive: Drive<T>,
    /// Time by which its command comes late, s.
    pub delay: T,
    /// Greatest command, in its unit.
    pub effort_limit: T,
    /// The loops around it.
    pub cascade: Cascade<T>,
    /// Control period, s.
    pub period: T,
}

impl<T: Exponential> DriveModel<T> {
    /// The same model, each number rounded to the nearest of another scalar.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] if friction or motor leave their ranges by that.
    pub fn cast<U: Exponential>(&self) -> Result<DriveModel<U>, CompensatorError> {
        let to = |value: T| U::of(value.to_f64());
        let outside = |name, value: T| CompensatorError::Setting {
            name,
            value: value.to_f64(),
            valid: "within its range in the other precision",
        };
        let friction = self.friction.parameters();
        Ok(DriveModel {
            travel: to(self.travel),
            load_inertia: to(self.load_inertia),
            friction: LuGre::new(friction.cast())
                .map_err(|_| outside("friction", friction.coulomb))?,
            lever: to(self.lever),
            along: self.along.cast(),
            kinematics: self.kinematics.cast(),
            drive: self
                .drive
                .cast()
                .ok_or_else(|| outside("motor", self.effort_limit))?,
            delay: to(self.delay),
            effort_limit: to(self.effort_limit),
            cascade: self.cascade.cast(),
            period: to(self.period),
        })
    }

    /// Torque per command at rest, N·m per unit of the command.
    #[must_use]
    pub fn torque_constant(&self) -> T {
        match &self.drive {
            Drive::Lag { gain, .. } => *gain,
            Drive::FieldOriented { motor, gear, .. } => *gear / motor.q_current(T::ONE),
        }
    }

    /// Refuses what no plan can be made from.
    pub(crate) fn check(&self) -> Result<(), CompensatorError> {
        error::travel_per_radian(self.travel)?;
        error::period(self.period)?;
        let positive = |name, value: T| {
            let inside = within(value, 1e-9, 1e12);
            require(inside, name, value, "from 1e-9 to 1e12")
        };
        positive("load_inertia", self.load_inertia)?;
        positive("lever", self.lever)?;
        positive("torque_constant", self.torque_constant())?;
        self.kinematics.check()?;
        let inside = self.effort_limit > T::ZERO;
        require(inside, "effort_limit", self.effort_limit, "above 0")?;
        let cycles = self.delay / self.period;
        let together = cycles + self.drive.late();
        let inside = cycles >= T::ZERO && within(together, 0.0, MOST_DELAY as f64);
        let valid = "from 0 to 16 control periods, the delay of the voltage included";
        require(inside, "delay", self.delay, valid)?;
        let c = &self.cascade;
        let gains = [
            ("position", c.position),
            ("speed", c.speed),
            ("speed_integral", c.speed_integral),
        ];
        for (name, gain) in gains {
            let inside = gain >= T::ZERO && gain.is_finite();
            require(inside, name, gain, "finite and at least 0")?;
        }
        match &self.drive {
            Drive::Lag { bandwidth, .. } => {
                let inside = *bandwidth > T::ZERO;
                require(inside, "bandwidth", *bandwidth, "above 0")?;
            }
            Drive::FieldOriented {
                q: [kp, ki], late, ..
            } => {
                require(
                    *late >= T::ZERO,
                    "late",
                    *late,
                    "at least 0 control periods",
                )?;
                let inside = *kp > T::ZERO && kp.is_finite() && *ki >= T::ZERO && ki.is_finite();
                require(inside, "current_q", *kp, "finite and above 0")?;
            }
        }
        Ok(())
    }
}

/// Most control periods by which a command and the voltage made of it may come late in a plan.
pub(crate) const MOST_DELAY: usize = 16;
