//! Variables of the motion, and where a curve over them acts.

use std::sync::Arc;

use axis_sim::Probe;
use axis_sim::effects::{EffectVariable, Measure};
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

/// Whether that is what an effect is shown over, or a product with it.
pub fn is_over((own, factor): Over, variable: EffectVariable) -> bool {
    match variable {
        EffectVariable::Speed => own == Variable::Speed || factor != Factor::One,
        EffectVariable::Position => own == Variable::Position,
        EffectVariable::MotorAngle => own == Variable::Angle,
        EffectVariable::Acceleration => own == Variable::Acceleration,
        EffectVariable::Current => own == Variable::Effort,
        EffectVariable::Distance | EffectVariable::Time => own == Variable::Time,
    }
}
