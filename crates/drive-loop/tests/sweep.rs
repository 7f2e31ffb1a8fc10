//! The analysis against a slow sweep of the nonlinear simulated axis: sines on its command, and on its
//! position, while it slides at constant speed. Nothing of the linear model is read.

use std::f64::consts::TAU;

use axis_sim::{Axis, ClosedLoop, Cycle, Start};
use compensator::{Compensator, Correction, Sample};
use drive_loop::{LoopAnalysis, LoopSet};
use nalgebra::Complex;
use trajectories::{Motion, Setpoint};

use crate::support::example;

/// Constant speed.
struct Slide {
    from: f64,
    speed: f64,
    time: f64,
}

impl Motion for Slide {
    fn duration(&self) -> f64 {
        self.time
    }

    fn at(&self, t: f64) -> Setpoint {
        Setpoint {
            position: self.from + self.speed * t,
            velocity: self.speed,
            ..Setpoint::default()
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Place {
    Command,
    Position,
}

/// Sines at whole numbers of Hz, all of one size, their phases by Schroeder.
struct Sines<'a> {
    tones: &'a [f64],
    size: f64,
    place: Place,
    period: f64,
    cycle: f64,
}

impl Sines<'_> {
    fn at(&self, time: f64) -> f64 {
        let n = self.tones.len() as f64;
        let tone = |(k, f): (usize, &f64)| {
            let k = k as f64;
            (TAU * (f * time - 0.5 * k * k / n)).cos()
        };
        self.size * self.tones.iter().enumerate().map(tone).sum::<f64>()
    }
}

impl Compensator for Sines<'_> {
    fn reset(&mut self) {
        self.cycle = 0.0;
    }

    fn correct(&mut self, _: &Sample) -> Correction {
        let value = self.at(self.cycle * self.period);
        self.cycle += 1.0;
        match self.place {
            Place::Command => Correction {
                position: 0.0,
                command: value,
            },
            Place::Position => Correction {
                position: value,
                command: 0.0,
            },
        }
    }
}

/// Time that is waited, and that is looked at: tones have whole periods in it, s.
const SETTLE: f64 = 1.0;
const WINDOW: f64 = 1.0;
/// Step of the simulation, s: in longer ones the force of a voltage that is held comes late.
const STEP: f64 = 2e-5;

/// What is added to a sliding axis.
#[derive(Clone, Copy)]
struct Added {
    speed: f64,
    place: Place,
    size: f64,
    /// Cycles between executions of the controller that reads it.
    every: usize,
}

/// |S| at each tone: what the signal becomes, per what is added to it.
fn swept(axis: &Axis, added: Added, tones: &[f64]) -> Vec<f64> {
    let Added {
        speed,
        place,
        size,
        every,
    } = added;
    let mut fine = axis.clone();
    fine.simulation.step = fine.simulation.step.min(STEP);
    let closed = ClosedLoop::new(&fine).unwrap().without_noise();
    let start = axis.stroke.start;
    let mut state = closed
        .start(&Start {
            speed,
            friction: speed.signum(),
            ..Start::at(start)
        })
        .unwrap();
    let motion = Slide {
        from: start,
        speed,
        time: SETTLE + WINDOW,
    };
    let mut sines = Sines {
        tones,
        size,
        place,
        period: axis.period,
        cycle: 0.0,
    };
    let mut read: Vec<[f64; 2]> = Vec::new();
    let settled = (SETTLE / axis.period).round() as usize;
    let mut count = 0;
    let see = |cycle: &Cycle| {
        if count >= settled && count % every == 0 {
            read.push(match place {
                Place::Command => [cycle.correction.command, cycle.command.effort],
                Place::Position => [cycle.correction.position, cycle.command.speed_ref],
            });
        }
        assert!(!cycle.command.saturated);
        count += 1;
    };
    closed
        .run_from(&mut state, &motion, &mut sines, |_| (), see)
        .completed()
        .unwrap();
    let n = (WINDOW / axis.period / every as f64).round() as usize;
    read.truncate(n);
    let unit = match place {
        Place::Command => 1.0,
        Place::Position => {
            let r = axis.travel_per_radian();
            axis.control.velocity_gain(r).unwrap() / r
        }
    };
    let step = axis.period * every as f64;
    tones
        .iter()
        .map(|f| {
            let mut sums = [Complex::new(0.0, 0.0); 2];
            for (k, values) in read.iter().enumerate() {
                let turn = Complex::from_polar(1.0, -TAU * f * k as f64 * step);
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += turn * *value;
                }
            }
            (sums[1] / sums[0]).norm() / unit
        })
        .collect()
}

/// The greatest |S| by a sweep from 8 to 640 Hz, and finer ones about its peak.
fn greatest(axis: &Axis, speed: f64, place: Place, size: f64, every: usize) -> f64 {
    let spread = |low: f64, high: f64, count: u32| {
        let at = |i: u32| (low * (high / low).powf(f64::from(i) / f64::from(count))).round();
        let mut all: Vec<f64> = (0..=count).map(at).collect();
        all.dedup();
        all
    };
    let added = Added {
        speed,
        place,
        size,
        every,
    };
    let coarse = spread(8.0, 640.0, 24);
    let heights = swept(axis, added, &coarse);
    let most = (0..coarse.len())
        .max_by(|a, b| heights[*a].total_cmp(&heights[*b]))
        .unwrap();
    let fine = spread(coarse[most] / 1.22, coarse[most] * 1.22, 20);
    let heights = swept(axis, added, &fine);
    let most = (0..fine.len())
        .max_by(|a, b| heights[*a].total_cmp(&heights[*b]))
        .unwrap();
    // Resonances of little damping are a few Hz wide.
    let finest: Vec<f64> = (-6..=6)
        .map(|df| (fine[most] + f64::from(df)).max(1.0))
        .collect();
    let heights = swept(axis, added, &finest);
    heights.into_iter().fold(0.0, f64::max)
}

/// A PID controller of the position is one loop.
#[test]
fn the_sensitivity_of_a_pid_controller_is_that_of_a_sweep() {
    let mut axis = example("linear-stage");
    let own = |axis: &Axis| {
        let found = LoopAnalysis::of(axis, &LoopSet::nominal()).unwrap();
        assert_eq!(found.own().command, found.own().position);
        found.own().command
    };
    // The crossover that the file states of its loop.
    let file = own(&axis);
    assert!((file.crossover_hz.unwrap() - 48.0).abs() < 0.5, "{file:?}");
    // With less derivative it has a peak to sweep.
    axis.control
        .change(|values| values.set("derivative", 1100.0))
        .unwrap();
    let said = own(&axis).sensitivity.unwrap();
    let swept = greatest(&axis, 0.03, Place::Command, 0.2, 1);
    assert!((swept - said).abs() < 0.02, "{swept} {said}");
}

/// 0.02 in the maximum sensitivity: asked of the analysis.
#[test]
fn sensitivities_are_those_of_a_sweep_of_the_simulated_axis() {
    let cases = [
        // Speed (slow on screws, whose lightly damped modes move with the load), size of a sine of the command and of the position, cycles of the position controller.
        ("linear-motor", 0.2, 0.02, 1e-7, 1),
        ("rack", 0.3, 0.05, 2e-6, 2),
        ("liu2025", 0.025, 0.02, 2e-7, 1),
        ("screw-datasheet", 0.025, 0.02, 2e-7, 2),
    ];
    for (name, speed, command, position, every) in cases {
        let axis = example(name);
        let set = LoopSet {
            // Where the sweep is looked at, on the average.
            positions: vec![axis.stroke.start + speed * (SETTLE + 0.5 * WINDOW)],
            ..LoopSet::nominal()
        };
        let found = LoopAnalysis::of(&axis, &set).unwrap();
        let own = found.own();
        let at_command = greatest(&axis, speed, Place::Command, command, 1);
        let said = own.command.sensitivity.unwrap();
        assert!(
            (at_command - said).abs() < 0.02,
            "{name}, command: {at_command} {said}"
        );
        let at_position = greatest(&axis, speed, Place::Position, position, every);
        let said = own.position.sensitivity.unwrap();
        assert!(
            (at_position - said).abs() < 0.02,
            "{name}, position: {at_position} {said}"
        );
    }
}
