//! What laws are made of: variables and shapes, and which of them are drawn.

use std::f64::consts::TAU;

use axis_sim::effects::EffectVariable as Shown;
use serde::{Deserialize, Serialize};

/// What a law depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LawVariable {
    /// Speed of the load.
    Speed,
    /// Position of the load.
    Position,
    /// Motor angle in its turn.
    Angle,
    /// Acceleration of the load.
    Acceleration,
    /// Time.
    Time,
    /// Torque of the motor.
    Current,
    /// Force of the transmission.
    Force,
}

impl LawVariable {
    pub(super) const ALL: [Self; 7] = [
        Self::Speed,
        Self::Position,
        Self::Angle,
        Self::Acceleration,
        Self::Time,
        Self::Current,
        Self::Force,
    ];

    /// As an outcome of the search says it ([`discrepancy::Unknown::depends_on`]): current
    /// and force are both what the drive gives.
    pub fn words(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Position => "position",
            Self::Angle => "motor angle within a turn",
            Self::Acceleration => "acceleration",
            Self::Time => "time",
            Self::Current | Self::Force => "force or torque of the drive",
        }
    }

    /// What an effect of the library is shown over.
    pub fn of(shown: Shown) -> Self {
        match shown {
            Shown::Speed => Self::Speed,
            Shown::Position => Self::Position,
            Shown::MotorAngle => Self::Angle,
            Shown::Acceleration => Self::Acceleration,
            Shown::Current => Self::Current,
            Shown::Distance | Shown::Time => Self::Time,
        }
    }
}

/// A shape over x from −1 to 1, p the number that it is drawn with (0 to 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LawShape {
    /// x
    Line,
    /// |x| − 1/2
    Size,
    /// x² − 1/3
    Square,
    /// x |x|
    Signed,
    /// x³
    Cube,
    /// sign(x) √|x|, smooth at 0
    Root,
    /// sin(k x + φ), k from 2 to 7
    Wave,
    /// tanh(x / l), l from 0.03 to 0.2
    Sign,
    /// e^(−|x| / l) − its mean, l from 0.1 to 0.5
    Bump,
}

impl LawShape {
    pub(super) const ALL: [Self; 9] = [
        Self::Line,
        Self::Size,
        Self::Square,
        Self::Signed,
        Self::Cube,
        Self::Root,
        Self::Wave,
        Self::Sign,
        Self::Bump,
    ];

    pub(super) fn at(self, x: f64, p: f64) -> f64 {
        match self {
            Self::Line => x,
            Self::Size => x.abs() - 0.5,
            Self::Square => x * x - 1.0 / 3.0,
            Self::Signed => x * x.abs(),
            Self::Cube => x.powi(3),
            Self::Root => x / (x * x + 1e-4).powf(0.25),
            Self::Wave => ((2.0 + 5.0 * p) * x + TAU * (7.0 * p).fract()).sin(),
            Self::Sign => (x / (0.03 * (0.2_f64 / 0.03).powf(p))).tanh(),
            Self::Bump => {
                let l = 0.1 + 0.4 * p;
                (-x.abs() / l).exp() - l * (1.0 - (-1.0 / l).exp())
            }
        }
    }

    /// Most by which it changes with x from −1 to 1.
    pub(super) fn steepest(self) -> f64 {
        match self {
            Self::Line | Self::Size => 1.0,
            Self::Square | Self::Signed => 2.0,
            Self::Cube => 3.0,
            Self::Wave => 7.0,
            Self::Root | Self::Bump => 10.0,
            Self::Sign => 34.0,
        }
    }
}

/// A shape over a variable.
pub(super) type Term = (LawVariable, LawShape);

/// Shapes that are drawn over a variable alone: a line each. Left out is what an effect of
/// the library is: viscous, dry and one-sided friction, springs and gravity, a force that
/// repeats or lasts, cogging, a mass, a torque constant.
pub(super) const SHAPES: &[(LawVariable, &[LawShape])] = {
    use LawShape::{Bump, Cube, Line, Root, Signed, Size, Square, Wave};
    &[
        (
            LawVariable::Speed,
            &[Signed, Cube, Wave, Square, Root, Bump],
        ),
        (
            LawVariable::Position,
            &[Size, Square, Cube, Wave, Bump, Signed],
        ),
        (LawVariable::Angle, &[Size, Square, Bump]),
        (LawVariable::Acceleration, &[Signed, Size, Cube]),
        (LawVariable::Time, &[Line, Square, Cube, Size]),
        (LawVariable::Current, &[Signed, Cube, Size, Square]),
        (LawVariable::Force, &[Signed, Square, Size]),
    ]
};

/// Products that are drawn, a line each. Left out is what the library has: friction that
/// changes along the stroke or as it warms, losses in proportion to a force, torque ripple.
pub(super) const PRODUCTS: &[[Term; 2]] = {
    use LawShape::{Bump, Line, Sign, Signed, Size, Square, Wave};
    use LawVariable::{Acceleration, Angle, Current, Position, Speed, Time};
    &[
        [(Speed, Line), (Position, Line)],
        [(Speed, Line), (Position, Wave)],
        [(Speed, Signed), (Position, Line)],
        [(Speed, Sign), (Position, Wave)],
        [(Speed, Sign), (Position, Line)],
        [(Speed, Line), (Time, Line)],
        [(Speed, Signed), (Time, Line)],
        [(Speed, Line), (Angle, Bump)],
        [(Speed, Sign), (Angle, Size)],
        [(Speed, Sign), (Acceleration, Size)],
        [(Acceleration, Line), (Position, Line)],
        [(Acceleration, Line), (Position, Square)],
        [(Acceleration, Line), (Time, Line)],
        [(Position, Line), (Time, Line)],
        [(Current, Line), (Angle, Bump)],
        [(Current, Signed), (Angle, Size)],
    ]
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Means over −1 to 1, by the midpoint rule.
    #[test]
    fn even_shapes_push_no_way_in_the_mean() {
        let n = 20_000;
        for shape in [LawShape::Size, LawShape::Square, LawShape::Bump] {
            for p in [0.0, 0.4, 1.0] {
                let x = |k: i32| (f64::from(k) + 0.5) / 1e4 - 1.0;
                let mean = (0..n).map(|k| shape.at(x(k), p)).sum::<f64>() / f64::from(n);
                assert!(mean.abs() < 1e-6, "{shape:?} {p} {mean}");
            }
        }
    }

    #[test]
    fn no_shape_is_steeper_than_said() {
        for shape in LawShape::ALL {
            for p in [0.0, 0.3, 1.0] {
                for k in -1000..1000 {
                    let x = f64::from(k) * 1e-3;
                    let slope = (shape.at(x + 1e-6, p) - shape.at(x, p)) / 1e-6;
                    assert!(slope.abs() <= 1.001 * shape.steepest(), "{shape:?} {slope}");
                }
            }
        }
    }

    /// What a shape alone over a variable may not be, as the library has it.
    #[test]
    fn no_law_is_an_effect_of_the_library() {
        let has = |v: LawVariable, s: LawShape| {
            let mut own = SHAPES.iter().filter(|(variable, _)| *variable == v);
            own.any(|(_, all)| all.contains(&s))
        };
        for (v, s) in [
            (LawVariable::Speed, LawShape::Line),
            (LawVariable::Speed, LawShape::Sign),
            (LawVariable::Speed, LawShape::Size),
            (LawVariable::Position, LawShape::Line),
            (LawVariable::Time, LawShape::Wave),
            (LawVariable::Angle, LawShape::Wave),
            (LawVariable::Acceleration, LawShape::Line),
            (LawVariable::Current, LawShape::Line),
            (LawVariable::Force, LawShape::Line),
        ] {
            assert!(!has(v, s), "{v:?} {s:?}");
        }
    }
}
