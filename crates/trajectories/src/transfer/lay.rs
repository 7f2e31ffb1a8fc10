//! From what is asked to the pieces of a motion.

use super::TransferLimits;
use super::brake;
use super::side::{Best, Shape, Side, Task};
use crate::constant_jerk::{self, Course};
use crate::{Real, Setpoint};

/// What is asked, divided by the jerk.
pub(super) fn task<T: Real>(
    start: &Setpoint<T>,
    target: &Setpoint<T>,
    limits: &TransferLimits<T>,
) -> Task<T> {
    let change = &limits.change;
    let jerk = change.jerk();
    let from = start.position.abs() + target.position.abs();
    Task {
        start: [start.velocity / jerk, start.acceleration / jerk],
        end: [target.velocity / jerk, target.acceleration / jerk],
        distance: (target.position - start.position) / jerk,
        velocity_noise: T::ZERO,
        distance_noise: T::ZERO,
        most: change.acceleration_max() / jerk,
        brake: -change.acceleration_min() / jerk,
        fast: limits.fast / jerk,
        back: -limits.back / jerk,
    }
    .with_noise(from / jerk)
}

/// Lays the motion of the least time that is not below `wanted` (s); nothing if there is none.
pub(super) fn complete<T: Real>(
    task: &Task<T>,
    course: &mut Course<T>,
    wanted: T,
    jerk: T,
) -> bool {
    let (up, down) = (Side::new(task), Side::new(&task.mirror()));
    if wanted > T::ZERO && mix(&up, &down, wanted, jerk, course) {
        return true;
    }
    let mut best = Best::none(wanted);
    up.search(false, &mut best);
    down.search(true, &mut best);
    let Some(shape) = best.shape else {
        return false;
    };
    let (side, sign) = if best.mirrored {
        (&down, -T::ONE)
    } else {
        (&up, T::ONE)
    };
    for (unit, time, last) in segments(side, &shape) {
        course.lay(sign * unit * jerk, time, sign * last * jerk);
    }
    true
}

/// Lays what brings the start within the limits, and begins the task there.
pub(super) fn bring_back<T: Real>(task: &mut Task<T>, course: &mut Course<T>, jerk: T) {
    let [mut v, mut a] = task.start;
    let mut travel = T::ZERO;
    for (sign, time, last) in brake::brake(task) {
        let unit = Setpoint {
            position: travel,
            velocity: v,
            acceleration: a,
            jerk: sign,
        };
        let next = constant_jerk::after(&unit, time);
        (travel, v, a) = (next.position, next.velocity, last);
        course.lay(sign * jerk, time, last * jerk);
    }
    task.start = [v, a];
    task.distance -= travel;
}

/// Signs of the jerk, durations (s) and accelerations (s) at the end of the segments of a motion.
fn segments<T: Real>(side: &Side<T>, shape: &Shape<T>) -> [(T, T, T); 7] {
    let (one, zero) = (T::ONE, T::ZERO);
    let t = side.times(shape);
    let turn = if shape.cruise > zero { zero } else { shape.b };
    [
        (one, t[0], shape.a),
        (zero, t[1], shape.a),
        (-one, t[2], turn),
        (zero, t[3], turn),
        (-one, t[4], shape.b),
        (zero, t[5], shape.b),
        (one, t[6], side.to),
    ]
}

/// Lays the motion between the farthest and the least far in a given time, if they include what is wanted.
fn mix<T: Real>(up: &Side<T>, down: &Side<T>, total: T, jerk: T, course: &mut Course<T>) -> bool {
    let (Some((far, over, noise)), Some((near, under, near_noise))) =
        (up.farthest(total), down.farthest(total))
    else {
        return false;
    };
    // The mirrored one goes backwards: its excess counts the other way.
    if over < -noise || under < -near_noise {
        return false;
    }
    let share = constant_jerk::share(over, under);
    let unit = |(sign, time, _): (T, T, T)| (sign, time);
    let far = segments(up, &far).map(unit);
    let near = segments(down, &near).map(unit);
    let mut a = course.state.acceleration;
    constant_jerk::mixed((&far, &near), share, |sign, time| {
        a += jerk * sign * time;
        course.lay(jerk * sign, time, a);
    });
    true
}
