//! Laws outside the library, drawn from a grammar.
//!
//! A force on the load, or a torque on the motor, `c · f(a) · g(b)`: a and b are variables of
//! the motion, each from −1 to 1 over it, f and g shapes over them. [`Law::draw`] makes one
//! of a seed, so that laws can be had that nobody seen before. What an effect of the
//! library is by itself is not drawn: what is left out is left out of the table of shapes.

mod effect;
mod grammar;

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Measure, Scales};
use serde::{Deserialize, Serialize};

pub(crate) use effect::{LAW, LAW_NAME};
pub use grammar::{LawShape, LawVariable};
use grammar::{PRODUCTS, SHAPES, Term};

/// One factor of a law: a variable, a shape over it, and the number that shapes it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Of what.
    pub variable: LawVariable,
    /// In which shape.
    pub shape: LawShape,
    /// From 0 to 1.
    pub number: f64,
}

/// A law outside the library.
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
        let singles: Vec<Term> = single.filter(|(v, _)| exists(axis, *v)).collect();
        // Two of three laws have one factor.
        let chosen: Vec<Term> = if at[0] < 2.0 / 3.0 {
            vec![singles[pick(1.5 * at[0], singles.len())]]
        } else {
            PRODUCTS[pick(3.0 * at[0] - 2.0, PRODUCTS.len())].to_vec()
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
    pub fn variables(&self) -> Vec<LawVariable> {
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
            let variable = LawVariable::ALL.iter().position(|v| *v == f.variable);
            let shape = LawShape::ALL.iter().position(|s| *s == f.shape);
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
        let current = |f: &Factor| f.variable == LawVariable::Current;
        self.factors.iter().any(current)
    }
}

/// Whether an axis has the variable.
fn exists(axis: &Axis, variable: LawVariable) -> bool {
    variable != LawVariable::Force || axis.mechanism.stiffness().is_some()
}

/// Middle and half of the range of a variable on a motion.
fn range(axis: &Axis, on: &Ranges, variable: LawVariable) -> [f64; 2] {
    let travel = axis.travel_per_radian();
    // What the motion asks for, and dry friction.
    let friction = axis.friction.law.parameters().coulomb / axis.friction.lever(travel);
    let force = friction + axis.mechanism.load_inertia() * on.acceleration;
    let inertia = axis.mechanism.total_inertia();
    let torque = friction * travel + inertia * on.acceleration / travel;
    match variable {
        LawVariable::Speed => [0.0, on.speed],
        LawVariable::Position => {
            let [low, high] = on.position;
            [0.5 * (low + high), 0.5 * (high - low)]
        }
        // Position over this is the motor's angle.
        LawVariable::Angle => [0.0, travel],
        LawVariable::Acceleration => [0.0, on.acceleration],
        LawVariable::Time => [0.5 * on.duration, 0.5 * on.duration],
        LawVariable::Current => [0.0, torque],
        LawVariable::Force => [0.0, force],
    }
}
