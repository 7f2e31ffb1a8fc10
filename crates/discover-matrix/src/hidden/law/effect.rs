//! A law as an effect: its numbers, and how it acts.

use std::f64::consts::{PI, TAU};

use axis_sim::effects::{
    Changes, Effect, EffectChannel, EffectParameter, EffectVariable as Shown, Measure, MemoryLaw,
    Nature, Steepness, TableStep,
};
use axis_sim::{SetupError, Start};

use super::Factor;
use super::grammar::{LawShape, LawVariable};

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
    summary: "a law outside the library",
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
                variable: *LawVariable::ALL.get(index(variable)?)?,
                shape: *LawShape::ALL.get(index(shape)?)?,
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

    fn has(&self, variable: LawVariable) -> bool {
        self.0.iter().any(|(f, _)| f.variable == variable)
    }

    fn at(&self, p: &Point) -> f64 {
        let one = |(f, [middle, half]): &(Factor, [f64; 2])| {
            let x = match f.variable {
                LawVariable::Speed => p.speed,
                LawVariable::Position => p.position,
                LawVariable::Angle => return f.shape.at(in_turn(p.position / half), f.number),
                LawVariable::Acceleration => p.acceleration,
                LawVariable::Time => p.time,
                LawVariable::Current => p.torque,
                LawVariable::Force => p.force,
            };
            f.shape.at((x - middle) / half, f.number)
        };
        self.0.iter().map(one).product()
    }

    /// Most by which it changes with one variable; shapes are 2 at most near their range.
    fn steepest(&self, variable: LawVariable) -> f64 {
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
    if law.has(LawVariable::Current) {
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
        speed: size_of * law.steepest(LawVariable::Speed),
        position: size_of
            * (law.steepest(LawVariable::Position) + law.steepest(LawVariable::Angle) / PI),
        ..Steepness::default()
    };
    if law.has(LawVariable::Acceleration) {
        steepness.speed += size_of * law.steepest(LawVariable::Acceleration) / LAG;
        to.load_with_memory(steepness, Remembered { size, law });
        return Ok(());
    }
    if law.has(LawVariable::Force) {
        steepness.transmitted = size_of * law.steepest(LawVariable::Force);
    }
    to.load_within(steepness, move |t| {
        let at = Point {
            time: t.time,
            position: t.position,
            speed: t.speed,
            force: t.transmitted,
            ..Point::default()
        };
        size * law.at(&at) * t.loaded
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
        memory[1] += step.travel;
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

    #[test]
    fn a_turn_of_the_motor_is_minus_one_to_one() {
        for turn in [-2.0, 0.0, 5.0] {
            assert!(in_turn(turn * TAU).abs() < 1e-9);
            assert!((in_turn(turn * TAU + 0.5 * PI) - 0.5).abs() < 1e-9);
        }
    }
}
