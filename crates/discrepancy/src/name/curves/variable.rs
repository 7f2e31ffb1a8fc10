//! Variables of the motion, and where a curve over them acts.

use std::sync::Arc;

use axis_sim::Probe;
use axis_sim::effects::Measure;
use axis_sim::mechanism::Freedom;

/// Where a disturbance acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Force,
    Offset,
}

impl Place {
    /// Size of a probe, small beside what the axis feels: N, m.
    pub fn size(self) -> f64 {
        match self {
            Self::Force => 10.0,
            Self::Offset => 2e-7,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Force => "torque balance (as a force on the load, against positive motion)",
            Self::Offset => "kinematics (as a displacement between motor and load)",
        }
    }

    pub fn probe(self, samples: Vec<f64>) -> Probe {
        match self {
            Self::Force => Probe::Load(samples.into()),
            Self::Offset => Probe::Offset(Arc::from(samples)),
        }
    }
}

/// A variable of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    Speed,
    Position,
    Time,
    Angle,
    Acceleration,
    /// What the drive gives: its current, or its command.
    Effort,
}

impl Variable {
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Position => "position",
            Self::Time => "time",
            Self::Angle => "motor angle within a turn",
            Self::Acceleration => "acceleration",
            Self::Effort => "force or torque of the drive",
        }
    }

    /// On a load that moves like this.
    pub fn unit(self, freedom: Freedom) -> &'static str {
        match self {
            Self::Speed => Measure::Speed.unit(freedom),
            Self::Position => Measure::Displacement.unit(freedom),
            Self::Time => "s",
            Self::Angle => "rad",
            Self::Acceleration => Measure::Acceleration.unit(freedom),
            Self::Effort => "in the unit of the drive's channel",
        }
    }
}

/// What a curve is multiplied by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    One,
    Speed,
    /// Of motion: −1 to 1, without a jump.
    Direction,
}

/// On what a law depends.
pub type Over = (Variable, Factor);

/// That in words.
pub fn depends_on((variable, factor): Over) -> String {
    match factor {
        Factor::One => variable.name().to_owned(),
        Factor::Speed => format!("the product of speed and {}", variable.name()),
        Factor::Direction => format!("{} and the direction of motion", variable.name()),
    }
}
