//! The rigid machine against a slow, obvious integration of the same equations.

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, Changes, Effect, EffectChannel, EffectVariable};
use axis_sim::friction::FRICTIONS;
use axis_sim::part::{Part, Values, named};
use axis_sim::{Axis, Replay, ReplayError, RunStopped, SetupError, StopReason};
use lugre::Parameters;
use trajectories::{Limits, Motion, SCurve};

use crate::{RIGID, change, number};

/// Friction in N, m/s and m: 20 N on a bristle of 10 µm, damped.
pub const FRICTION: Parameters = Parameters {
    coulomb: 20.0,
    stiction: 25.0,
    stribeck_speed: 5e-3,
    stiffness: 2e6,
    damping: 2e4,
    viscous: 10.0,
};

/// The benchmark's machine with another mass and the same loop gain, so that a
/// friction of 2e4 N·s/m over 50 µs asks for 1 N back per newton at 1 kg.
pub fn machine(mass: f64) -> Axis {
    let mut axis = crate::axis(RIGID);
    let gain = number(&axis.control, "speed_gain") * mass / number(&axis.mechanism, "mass");
    change(&mut axis.control, &[("speed_gain", gain)]);
    change(&mut axis.mechanism, &[("mass", mass)]);
    let mut values = Values::default();
    values.set("coulomb", FRICTION.coulomb);
    values.set("stiction", FRICTION.stiction);
    values.set("stribeck_speed", FRICTION.stribeck_speed);
    values.set("bristle_stiffness", FRICTION.stiffness);
    values.set("bristle_damping", FRICTION.damping);
    values.set("viscous", FRICTION.viscous);
    axis.friction = Part::new(named(FRICTIONS, "lugre").unwrap(), values).unwrap();
    axis
}

/// To and fro over 20 mm: the way there, and back.
fn reference(t: f64) -> f64 {
    let limits = Limits::new(0.1, 1.0, 20.0).unwrap();
    let there = SCurve::plan(0.0, 0.02, &limits).unwrap();
    let back = SCurve::plan(0.02, 0.0, &limits).unwrap();
    let turn = there.duration();
    let motion = if t < turn { &there } else { &back };
    motion.at(if t < turn { t } else { t - turn }).position
}

const PERIOD: f64 = 1e-3;
const CYCLES: usize = 900;

fn replay() -> Replay {
    let channel = |name: &str, f: &dyn Fn(f64) -> f64| {
        let samples = (0..CYCLES).map(|k| f(k as f64 * PERIOD)).collect();
        Channel::new(name, samples).unwrap()
    };
    // Velocities are not used by this controller.
    let log = Log::new(vec![
        channel("t_s", &|t| t),
        channel("position_ref_m", &reference),
        channel("velocity_ref_m_s", &|_| 0.0),
        channel("position_m", &|_| 0.0),
    ])
    .unwrap();
    Replay::new(&log, PERIOD).unwrap()
}

/// Positions at the samples: P-P control, and between them `advance(motion, force, h)` of
/// position and speed in steps of `h`.
pub fn controlled(
    axis: &Axis,
    h: f64,
    mut advance: impl FnMut([f64; 2], f64, f64) -> [f64; 2],
) -> Vec<f64> {
    let [position_gain, speed_gain] =
        ["position_gain", "speed_gain"].map(|key| number(&axis.control, key));
    let [force_gain, limit] =
        ["force_gain", "command_limit"].map(|key| number(&axis.actuator, key));
    let (mut s, mut before, mut seen) = ([0.0; 2], [0.0; 2], Vec::new());
    for k in 0..CYCLES {
        let filtered = [0.5 * (s[0] + before[0]), 0.5 * (before[0] + before[1])];
        let speed = (filtered[0] - filtered[1]) / PERIOD;
        let wanted = position_gain * (reference(k as f64 * PERIOD) - s[0]);
        let command = (speed_gain * (wanted - speed)).clamp(-limit, limit);
        before = [s[0], before[0]];
        seen.push(s[0]);
        let force = force_gain * command;
        for _ in 0..(PERIOD / h).round() as usize {
            s = advance(s, force, h);
        }
    }
    seen
}

/// A step of Runge-Kutta of fourth order on mass and a bristle whose deflection `z` changes by
/// `slip(v, z)`; the friction is that of `FRICTION`.
pub fn runge_kutta(
    mass: f64,
    damping: f64,
    slip: impl Fn(f64, f64) -> f64,
) -> impl FnMut([f64; 2], f64, f64) -> [f64; 2] {
    runge_kutta_with(mass, damping, slip, |v| FRICTION.viscous * v)
}

/// The same with another viscous part.
pub fn runge_kutta_with(
    mass: f64,
    damping: f64,
    slip: impl Fn(f64, f64) -> f64,
    viscous: impl Fn(f64) -> f64,
) -> impl FnMut([f64; 2], f64, f64) -> [f64; 2] {
    let p = FRICTION;
    let mut deflection = 0.0;
    move |[x, v], force, h| {
        let rate = |[_, v, z]: [f64; 3]| {
            let slip = slip(v, z);
            let rub = p.stiffness * z + damping * slip + viscous(v);
            [v, (force - rub) / mass, slip]
        };
        let moved = |s: [f64; 3], r: [f64; 3], h: f64| [0, 1, 2].map(|i| s[i] + h * r[i]);
        let mut s = [x, v, deflection];
        let a = rate(s);
        let b = rate(moved(s, a, 0.5 * h));
        let c = rate(moved(s, b, 0.5 * h));
        let d = rate(moved(s, c, h));
        for (r, part) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            s = moved(s, r, h * part / 6.0);
        }
        deflection = s[2];
        [s[0], s[1]]
    }
}

/// G(v) of `FRICTION`, N.
pub fn level(v: f64) -> f64 {
    let p = FRICTION;
    p.coulomb + (p.stiction - p.coulomb) * (-(v / p.stribeck_speed).powi(2)).exp()
}

/// Greatest distance of the axis' motion from one by another program, m.
pub fn apart(axis: &Axis, truth: &[f64]) -> f64 {
    let trace = replay().run(axis, &[], None).unwrap();
    let seen = trace.channel("position_m").unwrap();
    assert!(truth.iter().copied().fold(0.0, f64::max) > 0.01);
    let apart = seen.iter().zip(truth).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}

#[test]
fn heavy_and_light_masses_move_as_in_the_obvious_integration() {
    // First order: 2.9e-8, 3.9e-7 and 3.6e-6 m of 20 mm with steps of 50 µs, a tenth
    // of that with 5 µs.
    for (mass, tolerance) in [(95.0, 1.5e-7), (2.0, 2e-6), (0.5, 2e-5)] {
        for step in [5e-5, 5e-6] {
            let mut axis = machine(mass);
            axis.simulation.step = step;
            let slip = |v: f64, z: f64| v - FRICTION.stiffness * v.abs() * z / level(v);
            let moves = runge_kutta(mass, FRICTION.damping, slip);
            let apart = apart(&axis, &controlled(&axis, 1e-6, moves));
            println!("{mass} kg: {apart:.2e} m");
            assert!(apart < tolerance * step / 5e-5, "{mass} kg: {apart:e}");
        }
    }
}

/// From 0.1 s on, a load that falls with the speed for ever.
fn runaway(_: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    to.load(|table| {
        let acts = if table.time > 0.1 { 1.0 } else { 0.0 };
        -1e9 * acts * table.speed
    });
    Ok(())
}

static RUNAWAY: Effect = Effect {
    name: "outside",
    summary: "",
    channel: EffectChannel::Torque,
    depends_on: "",
    shown_over: EffectVariable::Time,
    parameters: &[],
    needs: &[],
    install: runaway,
};

#[test]
fn a_load_that_no_motion_goes_with_is_told() {
    let machine = machine(95.0);
    let effect = ActiveEffect {
        effect: &RUNAWAY,
        values: Vec::new(),
    };
    let error = replay().run(&machine, &[effect], None).unwrap_err();
    match error {
        ReplayError::Stopped(RunStopped {
            time,
            reason: StopReason::LoadNotFound,
            at,
        }) => {
            assert!(
                (time - 0.1).abs() < 1e-9 && at.position.abs() < 0.02,
                "{time} {}",
                at.position
            );
        }
        other => panic!("{other}"),
    }
}
