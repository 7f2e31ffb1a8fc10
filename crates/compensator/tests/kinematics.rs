//! What the plan makes of free travel and of an error of the kinematics.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use compensator::{
    Cascade, Drive, DriveModel, DriveSection, Kinematics, PlanSettings, Planned, Planner,
    Reference, Standstill, StrokeSections, Target,
};
use lugre::{LuGre, Parameters};
use proptest::prelude::*;

const T: f64 = 1e-4;
const TRAVEL: f64 = 0.01;

/// A stiff rotary axis behind a gear of 100, with friction.
fn model(kinematics: Kinematics) -> DriveModel {
    let section = DriveSection {
        compliance: 0.0,
        rotating: 1e-4,
        ..DriveSection::default()
    };
    DriveModel {
        travel: TRAVEL,
        load_inertia: 2.0,
        friction: LuGre::new(Parameters {
            coulomb: 6.0,
            stiction: 7.0,
            stribeck_speed: 0.04,
            stiffness: 2e4,
            damping: 20.0,
            viscous: 8.0,
        })
        .expect("a law"),
        lever: 1.0,
        along: StrokeSections::new([-2.0, 2.0], |_| section).expect("a stroke"),
        kinematics,
        drive: Drive::Lag {
            gain: 1.0,
            bandwidth: f64::INFINITY,
        },
        delay: 0.0,
        effort_limit: 10.0,
        cascade: Cascade {
            position: 600.0,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: 0.02,
            speed_integral: 0.4,
            from_motor: false,
            signal_path: compensator::SignalPath::default(),
        },
        period: T,
    }
}

/// Half a radian forward and back in a second each, without a jump of the acceleration.
fn reference(k: usize) -> Reference {
    let t = (k as f64 * T).min(2.0);
    let rate = std::f64::consts::TAU;
    let (sign, from, s) = if t < 1.0 {
        (1.0, 0.0, t)
    } else {
        (-1.0, 0.5, t - 1.0)
    };
    let (sin, cos) = (rate * s).sin_cos();
    Reference {
        position: from + sign * 0.5 * (s - sin / rate),
        velocity: sign * 0.5 * (1.0 - cos),
        acceleration: sign * 0.5 * rate * sin,
    }
}

fn plan(kinematics: Kinematics, angle: f64) -> Vec<Planned> {
    let mut planner =
        Planner::new(&model(kinematics), &PlanSettings::default()).expect("a planner");
    let standstill = Standstill {
        motor_angle: angle,
        ..Standstill::default()
    };
    planner.begin(0.0, &standstill);
    let cycles = 0..20_000 + planner.look_ahead();
    cycles
        .filter_map(|k| planner.push(Target::of(reference(k))))
        .collect()
}

/// The load is where the reference is: r (θ − θ₀) + e(θ) − e(θ₀) = x; and the planned speed is
/// that of the planned angle, the torque that of its acceleration and of the force on the load, which
/// has the lever dx/dθ there.
#[test]
fn an_error_of_the_kinematics_is_taken_up_by_the_motor() {
    let kinematics = Kinematics {
        amplitude: 1.45e-4,
        order: 2.0,
        phase: 0.4,
        ..Kinematics::default()
    };
    let start = 0.7;
    let without = plan(Kinematics::default(), start);
    let with = plan(kinematics, start);
    let angle = |p: &Planned| start + p.position / TRAVEL + p.wind_up;
    let (mut largest, mut reacted) = (0.0_f64, 0.0_f64);
    for (k, p) in with.iter().enumerate().skip(1).take(with.len() - 2) {
        let at = angle(p);
        let load = TRAVEL * (at - start) + kinematics.ahead(at) - kinematics.ahead(start);
        // Each of three rounds leaves the share a n/r of what the last has, 2a at first.
        let left = (kinematics.amplitude * kinematics.order / TRAVEL).powi(3);
        assert!((load - p.position).abs() < 2.1 * left * kinematics.amplitude);
        let [before, after] = [&with[k - 1], &with[k + 1]].map(angle);
        let speed = (after - before) / (2.0 * T);
        assert!((speed - p.motor_speed).abs() < 1e-3 * 0.5 / TRAVEL * 0.03);
        let second = (after - 2.0 * at + before) / (T * T) - p.reference.acceleration / TRAVEL;
        let torque = p.torque - without[k].torque;
        let force = (without[k].torque - 1e-4 * p.reference.acceleration / TRAVEL) / TRAVEL;
        let moved = |by: f64| kinematics.ahead(at + by);
        let reaction = (moved(1e-4) - moved(-1e-4)) / 2e-4 * force;
        let off = torque - 1e-4 * second - reaction;
        assert!(off.abs() < 2e-4, "{torque} {second} {reaction}");
        largest = largest.max(torque.abs());
        reacted = reacted.max(reaction.abs());
    }
    assert!(largest > 0.05 && reacted > 2e-3, "{largest} {reacted}");
}

/// Free travel moves the motor by half of it to the side that it pushes from, without a step,
/// and asks for no torque of its own in steady motion.
#[test]
fn free_travel_is_crossed_at_a_reversal() {
    let gap = 1e-4;
    let kinematics = Kinematics {
        free_travel: gap,
        ..Kinematics::default()
    };
    let rows = plan(kinematics, 0.0);
    let at = |t: f64| TRAVEL * rows[(t / T) as usize].wind_up;
    assert!((at(0.5) - 0.5 * gap).abs() < 1e-9, "{}", at(0.5));
    assert!((at(1.5) + 0.5 * gap).abs() < 1e-9, "{}", at(1.5));
    for pair in rows.windows(2) {
        let step = TRAVEL * (pair[1].wind_up - pair[0].wind_up).abs();
        // The whole of it as fast as the Gaussian of 2 ms lets it: gap/(σ √2π) a second.
        assert!(step <= 1.01 * gap * T / (2e-3 * (std::f64::consts::TAU).sqrt()));
    }
}

proptest! {
    /// The side is odd, rises with the torque, and is never more than half the free travel.
    #[test]
    fn the_side_is_smooth_and_bounded(a in -0.5..0.5_f64, b in -0.5..0.5_f64) {
        let kinematics = Kinematics { free_travel: 2.0, ..Kinematics::default() };
        let [at_a, at_b] = [a, b].map(|x| kinematics.side(x));
        prop_assert!((at_a - (100.0 * a).tanh()).abs() < 1e-12);
        prop_assert!((at_a + kinematics.side(-a)).abs() < 1e-12);
        prop_assert!(at_a.abs() <= 1.0);
        prop_assert!((a - b) * (at_a - at_b) >= 0.0);
    }
}
