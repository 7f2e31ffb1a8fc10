//! The numbers of an effect, and what they are on a given axis.

use crate::freedom::Freedom;
use crate::part::Role;

/// One number of an effect. Values are in SI units.
#[derive(Clone, Copy, Debug)]
pub struct EffectParameter {
    /// Its name in files.
    pub name: &'static str,
    /// What it measures, which gives its unit and its typical size on an axis.
    pub measure: Measure,
    /// What it is to the effect.
    pub nature: Nature,
    /// Where the search starts for it on [`Scales::REFERENCE`] while the effect is small;
    /// for a size, this is a typical one, whose null value is 0.
    pub typical: f64,
    /// Least and greatest value there.
    pub bounds: [f64; 2],
}

/// What a number is to its effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Nature {
    /// The effect vanishes where it is 0; of either sign, or of one only.
    Size {
        /// Whether a test draws it with either sign.
        either_sign: bool,
    },
    /// Angle at which something that repeats begins, rad.
    Phase,
    /// How often something repeats in a turn: a whole number, between these where
    /// it is searched for.
    Order([u8; 2]),
    /// The same in a turn of the motor, where those of its magnets are searched for besides: even
    /// multiples of the pole pairs, up to twelve of them.
    TurnOrder([u8; 2]),
    /// A place along the stroke; a test draws it between these shares of a motion.
    Place([f64; 2]),
    /// A width along the stroke; a test draws it between these shares of a motion.
    Width([f64; 2]),
    /// A speed: where the search starts (on [`Scales::REFERENCE`]), and between which a test
    /// draws it, in logarithm.
    Speed([f64; 3], [f64; 2]),
    /// A time constant, s: where the search starts, and between which a test draws it.
    Time([f64; 2], [f64; 2]),
    /// Any other number above zero: where the search starts (on [`Scales::REFERENCE`]), and
    /// between which a test draws it, in logarithm.
    Extent(&'static [f64], [f64; 2]),
    /// A natural frequency, Hz: where the search starts if each start takes a simulation, and
    /// between which a test draws it, in logarithm. Resonances are narrow, so that a search to
    /// which starts cost little starts at as many as lie beside each other.
    Frequency(&'static [f64], [f64; 2]),
    /// When something begins, s, drawn between these.
    Begin([f64; 2]),
    /// A number that is given, and that no search moves.
    Held,
    /// When it ends, s; drawn between these after its beginning.
    End([f64; 2]),
}

impl Nature {
    /// Whether it is a whole number that is searched for one by one.
    pub fn is_order(self) -> bool {
        matches!(self, Self::Order(_) | Self::TurnOrder(_))
    }
}

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// A share.
    Ratio,
    /// Force on the load.
    Force,
    /// Displacement of the load by which something gives way.
    Displacement,
    /// Travel of the load, as long as its motions.
    Travel,
    /// Speed of the load.
    Speed,
    /// Acceleration of the load.
    Acceleration,
    /// Force per speed of the load.
    Damping,
    /// Force per displacement of the load by which something gives way.
    Stiffness,
    /// Force per displacement of the load along its stroke.
    SpringRate,
    /// Inertia of the load.
    Inertia,
    /// Inertia of the motor.
    MotorInertia,
    /// Torque of the motor.
    MotorTorque,
    /// Angle of the motor.
    MotorAngle,
    /// Current.
    Current,
    /// Voltage.
    Voltage,
    /// Time.
    Time,
    /// Anything else, with its unit.
    Other(&'static str),
}

impl Measure {
    /// Its SI unit on a load that moves like this.
    pub fn unit(self, freedom: Freedom) -> &'static str {
        let linear = freedom == Freedom::Linear;
        let of = |along: &'static str, about: &'static str| if linear { along } else { about };
        match self {
            Self::Ratio => "",
            Self::Force => of("N", "N*m"),
            Self::Displacement | Self::Travel => of("m", "rad"),
            Self::Speed => of("m/s", "rad/s"),
            Self::Acceleration => of("m/s^2", "rad/s^2"),
            Self::Damping => of("N*s/m", "N*m*s/rad"),
            Self::Stiffness | Self::SpringRate => of("N/m", "N*m/rad"),
            Self::Inertia => of("kg", "kg*m^2"),
            Self::MotorInertia => "kg*m^2",
            Self::MotorTorque => "N*m",
            Self::MotorAngle => "rad",
            Self::Current => "A",
            Self::Voltage => "V",
            Self::Time => "s",
            Self::Other(unit) => unit,
        }
    }
}

/// Speed from which on friction slides, m/s: upper end of the range of Stribeck velocities in the survey of Armstrong-Hélouvry, Dupont
/// and Canudas de Wit (Automatica 30 (1994) 1083, doi:10.1016/0005-1098(94)90209-7).
const SLIDING: f64 = 0.1;

/// How large things are on an axis, which is what its effects are in proportion to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// How the load moves.
    pub freedom: Freedom,
    /// Greatest force of the actuator at the load, N or N·m.
    pub(super) force: f64,
    /// Displacement by which that force winds the transmission up, m or rad.
    pub(super) displacement: f64,
    /// Speed of its fastest trajectory, m/s or rad/s.
    pub(super) speed: f64,
    /// Inertia of the load, kg or kg·m².
    pub(super) inertia: f64,
    /// Inertia of all that moves, at the motor, kg·m².
    pub(super) motor_inertia: f64,
    /// Greatest torque of the motor, N·m.
    pub(super) motor_torque: f64,
    /// Greatest command of the actuator, in its unit.
    pub(super) effort: f64,
    /// Acceleration that the greatest torque gives to all that moves, m/s² or rad/s².
    pub(super) acceleration: f64,
    /// Length of a motion on which effects are looked for, m or rad.
    pub motion: f64,
    /// Least and greatest position, m or rad.
    pub stroke: [f64; 2],
    /// Where motions start, m or rad.
    pub start: f64,
}

/// Travel of the reference machine's table per radian of its screw, m/rad.
const LEVER: f64 = 0.010 / std::f64::consts::TAU;
/// Its greatest torque, N·m, at its greatest current, A.
const TORQUE: f64 = 1.641 * CURRENT;
const CURRENT: f64 = 15.0;
/// Inertia of all that moves, at the motor, kg·m².
const MOVED: f64 = 0.0096;
/// Stiffness of its transmission, N/m.
const STIFFNESS: f64 = 7.45e7;

impl Scales {
    /// The machine for which the registry states the numbers of effects: a table on a ball screw of
    /// 10 mm lead, with the numbers of `data/axes/liu2025.toml`. On an axis each number is larger by
    /// what the axis has more of its measure.
    pub const REFERENCE: Self = Self {
        freedom: Freedom::Linear,
        force: TORQUE / LEVER,
        displacement: TORQUE / LEVER / STIFFNESS,
        speed: 0.12,
        inertia: 515.0,
        motor_inertia: MOVED,
        motor_torque: TORQUE,
        effort: CURRENT,
        acceleration: TORQUE / MOVED * LEVER,
        motion: 0.2,
        stroke: [0.0, 1.5],
        start: 0.6,
    };

    /// By how much a measure is larger here than on the reference machine.
    pub fn ratio(&self, measure: Measure) -> f64 {
        let times = |of: fn(&Self) -> f64| of(self) / of(&Self::REFERENCE);
        let (force, displacement) = (times(|s| s.force), times(|s| s.displacement));
        let (speed, motion) = (times(|s| s.speed), times(|s| s.motion));
        let ratio = match measure {
            Measure::Force => force,
            Measure::Displacement => displacement,
            Measure::Travel => motion,
            Measure::Speed => speed,
            Measure::Acceleration => times(|s| s.acceleration),
            Measure::Damping => force / speed,
            Measure::Stiffness => force / displacement,
            Measure::SpringRate => force / motion,
            Measure::Inertia => times(|s| s.inertia),
            Measure::MotorInertia => times(|s| s.motor_inertia),
            Measure::MotorTorque => times(|s| s.motor_torque),
            Measure::Current => times(|s| s.effort),
            Measure::Ratio
            | Measure::MotorAngle
            | Measure::Voltage
            | Measure::Time
            | Measure::Other(_) => 1.0,
        };
        // To the digit, or the numbers of the registry would be those of no axis.
        let near = (ratio - 1.0).abs() < 0.01;
        if near || !(ratio.is_finite() && ratio > 0.0) {
            1.0
        } else {
            ratio
        }
    }
}

impl EffectParameter {
    /// Whether the effect vanishes where this is 0.
    pub fn is_size(&self) -> bool {
        matches!(self.nature, Nature::Size { .. })
    }

    /// Its SI unit; empty for a ratio.
    pub fn unit(&self, on: &Scales) -> &'static str {
        self.measure.unit(on.freedom)
    }

    /// Its typical value on an axis of those scales.
    pub fn typical(&self, on: &Scales) -> f64 {
        match self.nature {
            Nature::Place(_) | Nature::Width(_) => {
                self.typical / Scales::REFERENCE.motion * on.motion
            }
            _ => self.typical * on.ratio(self.measure),
        }
    }

    /// Least and greatest value there: a size never less than on the reference machine, and a speed at which friction changes
    /// at most 0.1 m/s along a line, from which on friction slides.
    pub fn bounds(&self, on: &Scales) -> [f64; 2] {
        let by = match self.nature {
            Nature::Place(_) => {
                let [low, high] = on.stroke;
                let beyond = 0.5 * (high - low);
                return [low - beyond, high + beyond];
            }
            Nature::Width(_) => on.motion / Scales::REFERENCE.motion,
            _ => on.ratio(self.measure),
        };
        match self.nature {
            Nature::Size { .. } => self.bounds.map(|edge| edge * by.max(1.0)),
            Nature::Speed(..) if on.freedom == Freedom::Linear => {
                self.bounds.map(|edge| (edge * by).min(SLIDING))
            }
            _ => self.bounds.map(|edge| edge * by),
        }
    }
}

/// A number that is a size: the effect vanishes at 0.
pub(super) const fn size(
    name: &'static str,
    measure: Measure,
    typical: f64,
    most: f64,
) -> EffectParameter {
    EffectParameter {
        name,
        measure,
        nature: Nature::Size { either_sign: false },
        typical,
        bounds: [-most, most],
    }
}

/// A size that may as well be negative.
pub(super) const fn signed(
    name: &'static str,
    measure: Measure,
    typical: f64,
    most: f64,
) -> EffectParameter {
    EffectParameter {
        nature: Nature::Size { either_sign: true },
        ..size(name, measure, typical, most)
    }
}

/// A size that cannot be negative.
pub(super) const fn positive(
    name: &'static str,
    measure: Measure,
    typical: f64,
    most: f64,
) -> EffectParameter {
    EffectParameter {
        bounds: [0.0, most],
        ..size(name, measure, typical, most)
    }
}

/// A number that shapes the effect.
pub(super) const fn shape(
    name: &'static str,
    measure: Measure,
    nature: Nature,
    typical: f64,
    bounds: [f64; 2],
) -> EffectParameter {
    EffectParameter {
        name,
        measure,
        nature,
        typical,
        bounds,
    }
}

/// The angle at which something that repeats begins.
pub(super) const PHASE: EffectParameter = shape(
    "phase",
    Measure::MotorAngle,
    Nature::Phase,
    0.0,
    [-7.0, 7.0],
);

/// What an axis must have for an effect to act on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectNeed {
    /// A parameter of that role.
    Role(Role),
    /// A transmission between motor and load.
    Transmission,
    /// A motor encoder, apart from the load's position.
    MotorEncoder,
    /// A channel beside the load's position in its log, that another clock may have timed: a motor
    /// encoder, or the torque that it is balanced with where no control is known.
    AnotherClock,
    /// A controller, which a logged reference drives.
    Reference,
    /// Currents that are measured.
    Currents,
    /// Poles.
    Poles,
    /// A load that turns.
    Turning,
    /// A motor that turns.
    TurningMotor,
    /// A motor that moves its load along a line without a transmission, with poles.
    LinearMotor,
}

impl EffectNeed {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Role(role) => role.name(),
            Self::Transmission => "transmission between motor and load",
            Self::MotorEncoder => "motor encoder apart from the load's position",
            Self::AnotherClock => {
                "second clock besides that of the load's position (a motor encoder, or a torque balance)"
            }
            Self::Reference => "controller that follows a reference",
            Self::Currents => "currents that are measured",
            Self::Poles => "motor poles",
            Self::Turning => "load that turns",
            Self::TurningMotor => "motor that turns",
            Self::LinearMotor => "linear motor with poles",
        }
    }
}
