//! Laws of no library, drawn from a grammar.
//!
//! A force on the load, or a torque on the motor, `c · f(a) · g(b)`: a and b are variables of
//! the motion, each from −1 to 1 over it, f and g shapes over them. [`Law::draw`] makes one
//! of a seed, so that laws can be had that nobody looked at before. What an effect of the
//! library is by itself is not drawn: what is left out is left out of [`SHAPES`].

use std::f64::consts::{PI, TAU};

use axis_sim::effects::{
    ActiveEffect, Changes, Effect, EffectChannel, EffectParameter, Measure, MemoryLaw, Nature,
    Scales, Steepness, TableStep, Variable as Shown,
};
use axis_sim::{Axis, SetupError, Start};
use serde::{Deserialize, Serialize};

/// What a law depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Variable {
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

impl Variable {
    const ALL: [Self; 7] = [
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
            Self::Angle => "motor angle in its turn",
            Self::Acceleration => "acceleration",
            Self::Time => "time",
            Self::Current | Self::Force => "what the drive gives",
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
            Shown::Way | Shown::Time => Self::Time,
        }
    }
}

/// A shape over x from −1 to 1, p the number that it is drawn with (0 to 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
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

impl Shape {
    const ALL: [Self; 9] = [
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

    fn at(self, x: f64, p: f64) -> f64 {
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
    fn steepest(self) -> f64 {
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

/// Shapes that are drawn over a variable alone: a line each. Left out is what an effect of
/// the library is: viscous, dry and one-sided friction, springs and gravity, a force that
/// repeats or lasts, cogging, a mass, a torque constant.
const SHAPES: &[(Variable, &[Shape])] = {
    use Shape::{Bump, Cube, Line, Root, Signed, Size, Square, Wave};
    &[
        (Variable::Speed, &[Signed, Cube, Wave, Square, Root, Bump]),
        (
            Variable::Position,
            &[Size, Square, Cube, Wave, Bump, Signed],
        ),
        (Variable::Angle, &[Size, Square, Bump]),
        (Variable::Acceleration, &[Signed, Size, Cube]),
        (Variable::Time, &[Line, Square, Cube, Size]),
        (Variable::Current, &[Signed, Cube, Size, Square]),
        (Variable::Force, &[Signed, Square, Size]),
    ]
};

/// Products that are drawn, a line each. Left out is what the library has: friction that
/// changes along the stroke or as it warms, losses in proportion to a force, torque ripple.
const PRODUCTS: &[((Variable, Shape), (Variable, Shape))] = {
    use Shape::{Bump, Line, Sign, Signed, Size, Square, Wave};
    use Variable::{Acceleration, Angle, Current, Position, Speed, Time};
    &[
        ((Speed, Line), (Position, Line)),
        ((Speed, Line), (Position, Wave)),
        ((Speed, Signed), (Position, Line)),
        ((Speed, Sign), (Position, Wave)),
        ((Speed, Sign), (Position, Line)),
        ((Speed, Line), (Time, Line)),
        ((Speed, Signed), (Time, Line)),
        ((Speed, Line), (Angle, Bump)),
        ((Speed, Sign), (Angle, Size)),
        ((Speed, Sign), (Acceleration, Size)),
        ((Acceleration, Line), (Position, Line)),
        ((Acceleration, Line), (Position, Square)),
        ((Acceleration, Line), (Time, Line)),
        ((Position, Line), (Time, Line)),
        ((Current, Line), (Angle, Bump)),
        ((Current, Signed), (Angle, Size)),
    ]
};

/// One factor of a law: a variable, a shape over it, and the number that shapes it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Of what.
    pub variable: Variable,
    /// In which shape.
    pub shape: Shape,
    /// From 0 to 1.
    pub number: f64,
}

/// A law of no library.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Law {
    /// One factor, or two.
    pub factors: Vec<Factor>,
    /// Where the variables' middles are, and half of their ranges, in the order of the
    /// factors.
    pub ranges: Vec<[f64; 2]>,
}

/// Motion that laws are drawn for.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// Least and greatest position, m or rad.
    pub position: [f64; 2],
    /// Greatest speed, m/s or rad/s.
    pub speed: f64,
    /// Greatest acceleration, m/s² or rad/s².
    pub acceleration: f64,
    /// Duration, s.
    pub duration: f64,
}

impl Law {
    /// A law by numbers from 0 to 1: which, and two that shape it.
    pub fn draw(axis: &Axis, ranges: &Ranges, at: [f64; 3]) -> Self {
        let pick = |share: f64, n: usize| ((share * n as f64) as usize).min(n - 1);
        let single = SHAPES
            .iter()
            .flat_map(|(v, all)| all.iter().map(move |s| (*v, *s)));
        let singles: Vec<(Variable, Shape)> = single.filter(|(v, _)| exists(axis, *v)).collect();
        // Two of three laws have one factor.
        let chosen: Vec<(Variable, Shape)> = if at[0] < 2.0 / 3.0 {
            vec![singles[pick(1.5 * at[0], singles.len())]]
        } else {
            let (a, b) = PRODUCTS[pick(3.0 * at[0] - 2.0, PRODUCTS.len())];
            vec![a, b]
        };
        let numbers = chosen.iter().zip(&at[1..]);
        let factors: Vec<Factor> = numbers
            .map(|(&(variable, shape), &number)| Factor {
                variable,
                shape,
                number,
            })
            .collect();
        let of = |f: &Factor| range(axis, ranges, f.variable);
        Self {
            ranges: factors.iter().map(of).collect(),
            factors,
        }
    }

    /// In tables.
    pub fn name(&self) -> String {
        let one = |f: &Factor| format!("{:?}({:?})", f.shape, f.variable).to_lowercase();
        let factors: Vec<String> = self.factors.iter().map(one).collect();
        let place = if self.is_at_motor() {
            "torque"
        } else {
            "force"
        };
        format!("{place} {}", factors.join("*"))
    }

    /// What it depends on.
    pub fn variables(&self) -> Vec<Variable> {
        self.factors.iter().map(|f| f.variable).collect()
    }

    /// Its usual size on an axis: N or N·m, of the motor N·m.
    pub fn typical(&self, axis: &Axis) -> f64 {
        let scales = Scales::of(axis);
        match self.is_at_motor() {
            true => 0.05 * scales.ratio(Measure::MotorTorque),
            false => 60.0 * scales.ratio(Measure::Force),
        }
    }

    /// As an effect of this size (N or N·m).
    pub fn active(&self, size: f64) -> ActiveEffect {
        let mut values = vec![size];
        for (f, [middle, half]) in self.factors.iter().zip(&self.ranges) {
            let variable = Variable::ALL.iter().position(|v| *v == f.variable);
            let shape = Shape::ALL.iter().position(|s| *s == f.shape);
            let [variable, shape] = [variable, shape].map(|at| at.unwrap_or(0) as f64);
            values.extend([variable, shape, f.number, *middle, *half]);
        }
        values.resize(LAW.parameters.len(), -1.0);
        ActiveEffect {
            effect: &LAW,
            values,
        }
    }

    fn is_at_motor(&self) -> bool {
        let current = |f: &Factor| f.variable == Variable::Current;
        self.factors.iter().any(current)
    }
}

/// Whether an axis has the variable.
fn exists(axis: &Axis, variable: Variable) -> bool {
    variable != Variable::Force || axis.mechanism.stiffness().is_some()
}

/// Middle and half of the range of a variable on a motion.
fn range(axis: &Axis, on: &Ranges, variable: Variable) -> [f64; 2] {
    let travel = axis.travel_per_radian();
    // What the motion asks for, and dry friction.
    let friction = axis.friction.law.parameters().coulomb / axis.friction.lever(travel);
    let force = friction + axis.mechanism.load_inertia() * on.acceleration;
    let inertia = axis.mechanism.total_inertia();
    let torque = friction * travel + inertia * on.acceleration / travel;
    match variable {
        Variable::Speed => [0.0, on.speed],
        Variable::Position => {
            let [low, high] = on.position;
            [0.5 * (low + high), 0.5 * (high - low)]
        }
        // Position over this is the motor's angle.
        Variable::Angle => [0.0, travel],
        Variable::Acceleration => [0.0, on.acceleration],
        Variable::Time => [0.5 * on.duration, 0.5 * on.duration],
        Variable::Current => [0.0, torque],
        Variable::Force => [0.0, force],
    }
}

/// The name of every law among effects.
pub(crate) const LAW_NAME: &str = "law";

const fn held(name: &'static str) -> EffectParameter {
    EffectParameter {
        name,
        measure: Measure::Ratio,
        nature: Nature::Held,
        typical: 0.0,
        bounds: [f64::MIN, f64::MAX],
    }
}

/// Any law, by numbers: its size, and of each factor variable, shape, number, middle and
/// half range.
pub(crate) static LAW: Effect = Effect {
    name: LAW_NAME,
    summary: "a law of no library",
    channel: EffectChannel::Torque,
    depends_on: "its variables",
    shown_over: Shown::Time,
    parameters: &[
        EffectParameter {
            name: "size",
            measure: Measure::Force,
            nature: Nature::Size { either_sign: false },
            typical: 60.0,
            bounds: [-1e9, 1e9],
        },
        held("variable"),
        held("shape"),
        held("number"),
        held("middle"),
        held("half"),
        held("variable"),
        held("shape"),
        held("number"),
        held("middle"),
        held("half"),
    ],
    needs: &[],
    install,
};

/// All that a law may look at.
#[derive(Clone, Copy, Default)]
struct Point {
    time: f64,
    position: f64,
    speed: f64,
    acceleration: f64,
    torque: f64,
    force: f64,
}

/// The factors of an effect's values.
#[derive(Clone)]
struct Product(Vec<(Factor, [f64; 2])>);

impl Product {
    fn new(values: &[f64]) -> Self {
        let one = |v: &[f64]| {
            let &[variable, shape, number, middle, half] = v else {
                return None;
            };
            let factor = Factor {
                variable: *Variable::ALL.get(index(variable)?)?,
                shape: *Shape::ALL.get(index(shape)?)?,
                number,
            };
            Some((factor, [middle, half]))
        };
        Self(
            values
                .get(1..)
                .unwrap_or_default()
                .chunks(5)
                .filter_map(one)
                .collect(),
        )
    }

    fn has(&self, variable: Variable) -> bool {
        self.0.iter().any(|(f, _)| f.variable == variable)
    }

    fn at(&self, p: &Point) -> f64 {
        let one = |(f, [middle, half]): &(Factor, [f64; 2])| {
            let x = match f.variable {
                Variable::Speed => p.speed,
                Variable::Position => p.position,
                Variable::Angle => return f.shape.at(in_turn(p.position / half), f.number),
                Variable::Acceleration => p.acceleration,
                Variable::Time => p.time,
                Variable::Current => p.torque,
                Variable::Force => p.force,
            };
            f.shape.at((x - middle) / half, f.number)
        };
        self.0.iter().map(one).product()
    }

    /// Most by which it changes with one variable; shapes are 2 at most near their range.
    fn steepest(&self, variable: Variable) -> f64 {
        let own = self.0.iter().filter(|(f, _)| f.variable == variable);
        own.map(|(f, [_, half])| 2.0 * f.shape.steepest() / half)
            .sum()
    }
}

fn index(value: f64) -> Option<usize> {
    (value >= 0.0).then_some(value as usize)
}

/// A motor's angle as −1 to 1 in its turn.
fn in_turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) / PI - 1.0
}

fn install(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    let size = values.first().copied().unwrap_or(0.0);
    let law = Product::new(values);
    if law.has(Variable::Current) {
        let travel = to.travel_per_radian();
        to.torque(move |angle, torque| {
            let at = Point {
                torque,
                position: angle * travel,
                ..Point::default()
            };
            size * law.at(&at)
        });
        return Ok(());
    }
    let size_of = size.abs();
    let mut steepness = Steepness {
        speed: size_of * law.steepest(Variable::Speed),
        position: size_of * (law.steepest(Variable::Position) + law.steepest(Variable::Angle) / PI),
        ..Steepness::default()
    };
    if law.has(Variable::Acceleration) {
        steepness.speed += size_of * law.steepest(Variable::Acceleration) / LAG;
        to.load_with_memory(steepness, Remembered { size, law });
        return Ok(());
    }
    if law.has(Variable::Force) {
        steepness.transmitted = size_of * law.steepest(Variable::Force);
    }
    to.load_within(steepness, move |t| {
        let at = Point {
            time: t.time,
            position: t.position,
            speed: t.speed,
            force: t.transmitted,
            ..Point::default()
        };
        size * law.at(&at) * t.pressed
    });
    Ok(())
}

/// Time constant of the filter that an acceleration is taken with, s.
const LAG: f64 = 0.01;

/// A law that looks at the acceleration: remembers time, position and the filtered speed.
struct Remembered {
    size: f64,
    law: Product,
}

impl MemoryLaw for Remembered {
    fn size(&self) -> usize {
        3
    }

    fn settle(&self, start: &Start, memory: &mut [f64]) -> f64 {
        memory.copy_from_slice(&[start.time, start.position, start.speed]);
        0.0
    }

    fn step(&self, step: &TableStep, memory: &mut [f64]) -> f64 {
        let share = step.length / LAG;
        memory[0] += step.length;
        memory[1] += step.way;
        memory[2] = (memory[2] + share * step.speed) / (1.0 + share);
        let at = Point {
            time: memory[0],
            position: memory[1],
            speed: step.speed,
            acceleration: (step.speed - memory[2]) / LAG,
            ..Point::default()
        };
        // It comes up over 20 ms, as standing loads do.
        self.size * self.law.at(&at) * (memory[0] / 0.02).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means over −1 to 1, by the midpoint rule.
    #[test]
    fn even_shapes_push_no_way_in_the_mean() {
        let n = 20_000;
        for shape in [Shape::Size, Shape::Square, Shape::Bump] {
            for p in [0.0, 0.4, 1.0] {
                let x = |k: i32| (f64::from(k) + 0.5) / 1e4 - 1.0;
                let mean = (0..n).map(|k| shape.at(x(k), p)).sum::<f64>() / f64::from(n);
                assert!(mean.abs() < 1e-6, "{shape:?} {p} {mean}");
            }
        }
    }

    #[test]
    fn no_shape_is_steeper_than_said() {
        for shape in Shape::ALL {
            for p in [0.0, 0.3, 1.0] {
                for k in -1000..1000 {
                    let x = f64::from(k) * 1e-3;
                    let slope = (shape.at(x + 1e-6, p) - shape.at(x, p)) / 1e-6;
                    assert!(slope.abs() <= 1.001 * shape.steepest(), "{shape:?} {slope}");
                }
            }
        }
    }

    #[test]
    fn a_turn_of_the_motor_is_minus_one_to_one() {
        for turn in [-2.0, 0.0, 5.0] {
            assert!(in_turn(turn * TAU).abs() < 1e-9);
            assert!((in_turn(turn * TAU + 0.5 * PI) - 0.5).abs() < 1e-9);
        }
    }

    /// What a shape alone over a variable may not be, as the library has it.
    #[test]
    fn no_law_is_an_effect_of_the_library() {
        let has = |v: Variable, s: Shape| {
            let mut own = SHAPES.iter().filter(|(variable, _)| *variable == v);
            own.any(|(_, all)| all.contains(&s))
        };
        for (v, s) in [
            (Variable::Speed, Shape::Line),
            (Variable::Speed, Shape::Sign),
            (Variable::Speed, Shape::Size),
            (Variable::Position, Shape::Line),
            (Variable::Time, Shape::Wave),
            (Variable::Angle, Shape::Wave),
            (Variable::Acceleration, Shape::Line),
            (Variable::Current, Shape::Line),
            (Variable::Force, Shape::Line),
        ] {
            assert!(!has(v, s), "{v:?} {s:?}");
        }
    }
}
