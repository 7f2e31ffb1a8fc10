//! States, limits and random cases of transfers, and what every motion between them keeps.

use proptest::prelude::*;
use trajectories::{Motion, Setpoint, Transfer, TransferLimits, VelocityLimits};

pub fn state(position: f64, velocity: f64, acceleration: f64) -> Setpoint {
    Setpoint {
        position,
        velocity,
        acceleration,
        jerk: 0.0,
    }
}

pub fn limits(v: [f64; 2], a: [f64; 2], jerk: f64) -> TransferLimits {
    let change = VelocityLimits::new(a[0], a[1], jerk).unwrap();
    TransferLimits::new(v[0], v[1], change).unwrap()
}

#[derive(Clone, Debug)]
pub struct Case {
    pub start: Setpoint,
    pub target: Setpoint,
    pub limits: TransferLimits,
}

/// Limits, and states that may lie beyond them by half; a quarter of the values is zero or at a limit.
pub fn cases() -> impl Strategy<Value = Case> {
    let share = || prop_oneof![3 => -1.0..1.0_f64, 1 => prop::sample::select(vec![-1.0, 0.0, 1.0])];
    (
        [0.2..3.0_f64, 0.2..3.0],
        [0.5..6.0_f64, 0.5..6.0],
        0.0..3.0_f64,
        [share(), share(), share(), share()],
        -2.0..2.0_f64,
        prop_oneof![3 => Just(1.0), 1 => Just(1.5)],
    )
        .prop_map(|(v, a, jerk, share, distance, beyond)| {
            let jerk = 10.0_f64.powf(jerk);
            let scale = |x: f64, to: [f64; 2]| if x < 0.0 { x * to[0] } else { x * to[1] };
            let [v0, v1] = [scale(share[0], v) * beyond, scale(share[1], v)];
            // Built up from a velocity within its limits.
            let from = if share[3] < 0.0 { v[1] - v1 } else { v[0] + v1 };
            let most = (2.0 * jerk * from.max(0.0)).sqrt();
            let a1 = scale(share[3], a).clamp(-most, most);
            Case {
                start: state(0.3, v0, scale(share[2], a) * beyond),
                target: state(0.3 + distance * distance.abs(), v1, a1),
                limits: limits([-v[0], v[1]], [-a[0], a[1]], jerk),
            }
        })
}

/// Each sample within the limits, and the integral of the ones before by Simpson's rule between the switches of jerk.
pub fn check_motion(motion: &Transfer, case: &Case) -> Result<(), TestCaseError> {
    let Case {
        start,
        target,
        limits,
    } = case;
    let change = limits.change();
    let end = motion.duration();
    let within = motion.within_limits_after();
    prop_assert_eq!(motion.at(-1.0), *start);
    prop_assert_eq!(motion.at(end).position, target.position);
    prop_assert_eq!(motion.at(end).velocity, target.velocity);
    prop_assert_eq!(motion.at(end).acceleration, target.acceleration);
    let (steps, mut before) = (1000, motion.at(0.0));
    let dt = end / f64::from(steps);
    let jerk = change.jerk();
    let size = |s: &Setpoint| 1.0 + s.velocity.abs() + s.acceleration.abs() + jerk;
    for i in 1..=steps {
        let t = (dt * f64::from(i)).min(end);
        let now = motion.at(t);
        if t >= within {
            prop_assert!(now.velocity <= limits.velocity_max(), "{now:?} at {t}");
            prop_assert!(now.velocity >= limits.velocity_min(), "{now:?} at {t}");
            let rounding = 1e-15 * size(&now);
            prop_assert!(now.acceleration <= change.acceleration_max() + rounding);
            prop_assert!(now.acceleration >= change.acceleration_min() - rounding);
        }
        prop_assert!(now.jerk.abs() <= jerk * (1.0 + 1e-15));
        let rise = now.acceleration - before.acceleration;
        prop_assert!(
            rise.abs() <= jerk * dt + 1e-12 * size(&now),
            "{now:?} at {t}"
        );
        // Trapezoids; between two samples the jerk may switch from J to −J, or more than once.
        let gain = 0.5 * dt * (now.acceleration + before.acceleration);
        let off = now.velocity - before.velocity - gain;
        prop_assert!(
            off.abs() <= jerk * dt * dt + 1e-12 * size(&now),
            "{now:?} at {t}"
        );
        let way = 0.5 * dt * (now.velocity + before.velocity);
        let bend = now.acceleration.abs().max(before.acceleration.abs()) + jerk * dt;
        let off = now.position - before.position - way;
        prop_assert!(
            off.abs() <= bend * dt * dt + 1e-12 * (1.0 + end),
            "{now:?} at {t}"
        );
        before = now;
    }
    // Just before its end it is where it is going.
    let last = motion.at(end.next_down());
    let off = (last.position - target.position).abs();
    prop_assert!(
        off <= 1e-11 * (1.0 + end * size(&last).min(10.0)),
        "{off:e}"
    );
    prop_assert!((last.velocity - target.velocity).abs() <= 1e-12 * size(&last));
    prop_assert!(
        (last.acceleration - target.acceleration).abs() <= 1e-12 * size(&last) * (1.0 + end)
    );
    Ok(())
}
