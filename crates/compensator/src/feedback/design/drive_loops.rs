//! All that makes the command of what is measured: the feedback, and the drive's own loops
//! that it is led through.
//!
//! The offset of the position makes the speed controller's set point the motor's speed, so that
//! its error is zero. It is not where the drive low-passes that speed or takes another, nor
//! between two executions of a slower position controller; and filters change the command
//! behind the speed controller. The feedback sees what was commanded, and takes what lasts of it
//! back. All of that is linear and repeats after as many control periods as the position
//! controller waits.

use nalgebra::{DMatrix, DVector, RowDVector};
use std::vec::Vec;

use super::{Design, DesignError};
use crate::feedback::{OWN, OWN_RATE};
use crate::model::DriveModel;
use crate::signal_path::{DriveFilter, SignalPath};

/// Most control periods between two executions of the position controller: the loop's response
/// is a matrix of as many rows.
const MOST_EVERY: u32 = 32;

/// Refuses loops that no margins are computed of.
pub(super) fn check(signal_path: &SignalPath) -> Result<(), DesignError> {
    let refused = [
        (
            signal_path.speed_every > 1,
            "its speed controller runs at a lower rate than the control (speed_rate), so that a correction of the command waits for it",
        ),
        (
            signal_path.position_every > MOST_EVERY,
            "its position controller runs less than once in 32 control periods (position_rate), for which no margins are computed",
        ),
        (
            signal_path.other_position,
            "its position controller uses another position than the measured one (feedback = \"blend\", or \"motor\" beside a sensor at the load)",
        ),
    ];
    match refused.into_iter().find(|(found, _)| *found) {
        Some((_, why)) => Err(DesignError::Control(why)),
        None => Ok(()),
    }
}

/// From measurements y to the command u, in greatest commands, in one phase of the drive's loops:
/// ξ(k+1) = A ξ + B y, u = C ξ + D y.
#[derive(Clone, Debug)]
pub(super) struct Commanding {
    pub a: DMatrix<f64>,
    pub b: DMatrix<f64>,
    pub c: RowDVector<f64>,
    pub d: RowDVector<f64>,
}

/// Where each state is: the last estimate, then those of the drive.
struct Places {
    /// u − e of the cycle before, e being what the feedback asked for.
    besides: usize,
    /// What the speed controller's integrator adds, less what the feedback takes off of it; and
    /// the rate of what it takes off.
    held: usize,
    rate: usize,
    /// Set point of the speed.
    set_point: usize,
    /// The position one and two cycles ago.
    positions: [usize; 2],
    /// Two states each: of the speed, of the command.
    filters: [[usize; 2]; 3],
    count: usize,
}

impl Places {
    fn after(estimate: usize) -> Self {
        let at = |i: usize| estimate + i;
        Self {
            besides: at(0),
            held: at(1),
            rate: at(2),
            set_point: at(3),
            positions: [at(4), at(5)],
            filters: [[at(6), at(7)], [at(8), at(9)], [at(10), at(11)]],
            count: at(12),
        }
    }
}

/// The command's law in each control period, until it repeats; states that no measurement moves
/// are left out.
pub(super) fn phases(model: &DriveModel, design: &Design) -> Vec<Commanding> {
    let n = design.linear.size();
    let m = design.linear.c.nrows();
    let places = Places::after(n);
    let size = places.count;
    let one = DMatrix::<f64>::identity(n, n) - &design.l * &design.linear.c;
    let cycle = Cycle {
        model,
        design,
        places,
        kept: one,
    };
    let every = model.cascade.signal_path.position_every.max(1);
    let mut all: Vec<Commanding> = (0..every)
        .map(|phase| {
            let mut law = Commanding {
                a: DMatrix::zeros(size, size),
                b: DMatrix::zeros(size, m),
                c: RowDVector::zeros(size),
                d: RowDVector::zeros(m),
            };
            // Linear: its matrices are what it does with one of each.
            for j in 0..size {
                let mut x = DVector::zeros(size);
                x[j] = 1.0;
                law.c[j] = cycle.run(phase == 0, &mut x, &DVector::zeros(m));
                law.a.set_column(j, &x);
            }
            for j in 0..m {
                let (mut x, mut y) = (DVector::zeros(size), DVector::zeros(m));
                y[j] = 1.0;
                law.d[j] = cycle.run(phase == 0, &mut x, &y);
                law.b.set_column(j, &x);
            }
            law
        })
        .collect();
    let moved = moved(&all);
    for law in &mut all {
        law.a = law.a.select_rows(&moved).select_columns(&moved);
        law.b = law.b.select_rows(&moved);
        law.c = law.c.select_columns(&moved);
    }
    all
}

/// States that measurements move, at once or by way of others, in any phase.
fn moved(all: &[Commanding]) -> Vec<usize> {
    let size = all[0].a.nrows();
    let mut is_moved: Vec<bool> = (0..size)
        .map(|i| all.iter().any(|law| law.b.row(i).iter().any(|b| *b != 0.0)))
        .collect();
    for _ in 0..size {
        for i in 0..size {
            let reached = |law: &Commanding| (0..size).any(|j| is_moved[j] && law.a[(i, j)] != 0.0);
            is_moved[i] = is_moved[i] || all.iter().any(reached);
        }
    }
    (0..size).filter(|i| is_moved[*i]).collect()
}

/// One control period of feedback and drive.
struct Cycle<'a> {
    model: &'a DriveModel,
    design: &'a Design,
    places: Places,
    /// I − L C.
    kept: DMatrix<f64>,
}

impl Cycle<'_> {
    /// Changes the state by a measurement; the command. `executed` is whether the position
    /// controller runs in it.
    fn run(&self, executed: bool, x: &mut DVector<f64>, y: &DVector<f64>) -> f64 {
        let (m, p) = (&self.design.linear, &self.places);
        let n = m.size();
        let (drive, signal_path) = (&self.model.cascade, &self.model.cascade.signal_path);
        let k = self.design.k.transpose();

        // As `Feedback::predict` and `Feedback::correct`, what is left of a drive's command
        // beside the feedback's being one number.
        let before = x.rows(0, n).into_owned();
        let asked = -(&k * &before)[0];
        let expected = &m.a * &before + &m.b * (asked + x[p.besides]);
        x[p.rate] += OWN_RATE * x[p.besides];
        x[p.held] -= x[p.rate] + OWN * x[p.besides];
        let estimate = &self.kept * expected + &self.design.l * y;
        x.rows_mut(0, n).copy_from(&estimate);
        let asked = -(&k * estimate)[0];

        // The drive. The offset of the position has it ask for the speed that was measured.
        let (position, speed) = (y[0], y[1]);
        let mut set_point = speed;
        if signal_path.position_every > 1 {
            if executed {
                x[p.set_point] = speed;
            }
            set_point = x[p.set_point];
        }
        let mut seen = speed;
        if signal_path.speed_of_position {
            let [one, two] = p.positions;
            let over = 2.0 * self.model.period * self.model.travel;
            seen = (position - x[two]) / over;
            (x[two], x[one]) = (x[one], position);
        }
        seen = filtered(signal_path.speed.as_ref(), p.filters[0], x, seen);
        let error = (set_point - seen) / self.model.effort_limit;
        x[p.held] += drive.speed_integral * self.model.period * error;
        let mut command = asked + (drive.speed * error + x[p.held]);
        for (filter, at) in signal_path.command.iter().zip(&p.filters[1..]) {
            command = filtered(filter.as_ref(), *at, x, command);
        }
        x[p.besides] = match signal_path.command == [None, None] {
            true => drive.speed * error + x[p.held],
            false => command - asked,
        };
        command
    }
}

/// A sample through a filter whose memory is part of a state; as it is without one.
fn filtered(filter: Option<&DriveFilter>, at: [usize; 2], x: &mut DVector<f64>, input: f64) -> f64 {
    let Some(filter) = filter else {
        return input;
    };
    let mut memory = at.map(|place| x[place]);
    let output = filter.step(&mut memory, input);
    for (place, value) in at.into_iter().zip(memory) {
        x[place] = value;
    }
    output
}
