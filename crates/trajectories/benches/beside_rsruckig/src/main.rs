//! Plans per second of this crate and of rsruckig 3.0.1, on the same random states in one process.
//!
//!     cargo run --release --manifest-path crates/trajectories/benches/beside_rsruckig/Cargo.toml
//!
//! Prints the least time of 15 passes of each, alternating, and the sum of all durations, which both must agree on.

use std::hint::black_box;
use std::time::Instant;

use rsruckig::prelude::*;
use trajectories::{Axes, AxisTask, Motion, Setpoint, Transfer, TransferLimits, VelocityLimits};

const COUNT: usize = 60_000;
const PASSES: usize = 15;

/// Random states within random limits: a half ends at standstill, a quarter with an acceleration.
fn tasks() -> Vec<AxisTask> {
    let mut seed = 1_u64;
    let mut draw = move |low: f64, high: f64| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut tasks = Vec::new();
    while tasks.len() < COUNT {
        let (fast, back) = (draw(0.2, 3.0), -draw(0.2, 3.0));
        let (most, least) = (draw(0.5, 6.0), -draw(0.5, 6.0));
        let jerk = 10_f64.powf(draw(0.0, 3.0));
        let mut state = |position, share| Setpoint {
            position,
            velocity: if share < 0.5 { 0.0 } else { draw(back, fast) },
            acceleration: if share < 0.75 { 0.0 } else { draw(least, most) },
            jerk: 0.0,
        };
        let start = state(0.0, 1.0);
        let mut target = state(0.0, 1.0);
        let share = draw(0.0, 1.0);
        target.position = draw(-5.0, 5.0);
        if share < 0.5 {
            target.velocity = 0.0;
        }
        if share < 0.75 {
            target.acceleration = 0.0;
        }
        let swing = |s: &Setpoint| s.acceleration * s.acceleration.abs() / (2.0 * jerk);
        let (after, before) = (
            start.velocity + swing(&start),
            target.velocity - swing(&target),
        );
        if [after, before].iter().all(|v| (back..fast).contains(v)) {
            let change = VelocityLimits::new(least, most, jerk).expect("valid");
            let limits = TransferLimits::new(back, fast, change).expect("valid");
            tasks.push(AxisTask {
                start,
                target,
                limits,
            });
        }
    }
    tasks
}

fn inputs<const N: usize>(tasks: &[AxisTask]) -> Vec<InputParameter<N>> {
    let of_axes = |axes: &[AxisTask]| {
        let mut input = InputParameter::<N>::new(None);
        let (mut back, mut least) = (input.max_velocity.clone(), input.max_velocity.clone());
        for (i, task) in axes.iter().enumerate() {
            let change = task.limits.change();
            input.current_velocity[i] = task.start.velocity;
            input.current_acceleration[i] = task.start.acceleration;
            input.target_position[i] = task.target.position;
            input.target_velocity[i] = task.target.velocity;
            input.target_acceleration[i] = task.target.acceleration;
            input.max_velocity[i] = task.limits.velocity_max();
            input.max_acceleration[i] = change.acceleration_max();
            input.max_jerk[i] = change.jerk();
            back[i] = task.limits.velocity_min();
            least[i] = change.acceleration_min();
        }
        input.min_velocity = Some(back);
        input.min_acceleration = Some(least);
        input
    };
    tasks.chunks_exact(N).map(of_axes).collect()
}

fn compare(what: &str, count: usize, both: [&mut dyn FnMut() -> f64; 2]) {
    let mut best = [f64::INFINITY; 2];
    let mut sums = [0.0; 2];
    let [ours, theirs] = both;
    for _ in 0..PASSES {
        for (i, plan) in [&mut *ours, &mut *theirs].into_iter().enumerate() {
            let begin = Instant::now();
            sums[i] = plan();
            best[i] = best[i].min(begin.elapsed().as_secs_f64());
        }
    }
    for (name, best, sum) in [
        ("this crate", best[0], sums[0]),
        ("rsruckig", best[1], sums[1]),
    ] {
        println!(
            "{what}, {name}: {:.0} ns, {:.0} plans per second; durations add up to {sum:.6} s",
            best * 1e9 / count as f64,
            count as f64 / best
        );
    }
}

fn of_rsruckig<const N: usize>(inputs: &[InputParameter<N>]) -> impl FnMut() -> f64 + '_ {
    let mut planner = Ruckig::<N, IgnoreErrorHandler>::new(None, 0.01);
    let mut trajectory = Trajectory::<N>::new(None);
    move || {
        let mut sum = 0.0;
        for input in inputs {
            planner
                .calculate(black_box(input), &mut trajectory)
                .expect("solved");
            sum += trajectory.get_duration();
        }
        sum
    }
}

fn main() {
    let tasks = tasks();
    let threes: Vec<[AxisTask; 3]> = tasks.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    let mut ours = || {
        let plan = |t: &AxisTask| Transfer::plan(black_box(&t.start), &t.target, &t.limits);
        tasks
            .iter()
            .map(|t| plan(t).expect("valid").duration())
            .sum()
    };
    compare(
        "one axis",
        COUNT,
        [&mut ours, &mut of_rsruckig(&inputs::<1>(&tasks))],
    );
    let mut ours = || {
        let plan = |t: &[AxisTask; 3]| Axes::together(black_box(t));
        threes
            .iter()
            .map(|t| plan(t).expect("valid").duration())
            .sum()
    };
    compare(
        "three axes",
        threes.len(),
        [&mut ours, &mut of_rsruckig(&inputs::<3>(&tasks))],
    );
}
