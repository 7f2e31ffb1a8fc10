//! From a state beyond a limit back within the limits, in least time.
//!
//! An acceleration beyond its limit comes back at full jerk. A velocity beyond its limit, or one that the
//! acceleration carries beyond it, is braked at full jerk, then at the limit of acceleration, until the velocity is
//! the limit's; but never for so long that the opposite limit could no longer be kept. All values are divided by J,
//! as in the parent module.

use super::side::Task;
use crate::Real;

/// A stretch of constant jerk: its sign (−1, 0, 1), duration (s), and acceleration at its end (s).
pub(super) type Stretch<T> = (T, T, T);

/// At most two stretches, none of which lasts longer than needed, that bring the start of a task within its limits.
pub(super) fn brake<T: Real>(task: &Task<T>) -> [Stretch<T>; 2] {
    let mirror = task.mirror();
    let turn = |stretches: [Stretch<T>; 2]| stretches.map(|(jerk, t, a)| (-jerk, t, -a));
    if task.start[1] > task.most {
        down_to_limit(task)
    } else if mirror.start[1] > mirror.most {
        turn(down_to_limit(&mirror))
    } else if too_fast(task) {
        slow_down(task)
    } else if too_fast(&mirror) {
        turn(slow_down(&mirror))
    } else {
        let [_, a] = task.start;
        [(T::ZERO, T::ZERO, a); 2]
    }
}

/// Whether the start itself is within all limits, so that a target may be reached before one is exceeded.
pub(super) fn is_within<T: Real>(task: &Task<T>) -> bool {
    let [v, a] = task.start;
    let noise = task.velocity_noise;
    a <= task.most && -a <= task.brake && v <= task.fast + noise && -v <= task.back + noise
}

/// Whether the velocity is, or unavoidably comes to be, above its limit by more than rounding, and the one backwards
/// is not exceeded unavoidably.
fn too_fast<T: Real>(task: &Task<T>) -> bool {
    let [v, a] = task.start;
    let noise = task.velocity_noise;
    let swing = T::HALF * a * a;
    let returns = a >= T::ZERO || v - swing > -task.back;
    (v > task.fast + noise && returns) || (a > T::ZERO && v + swing > task.fast + noise)
}

/// Time after braking (s) at which the velocity is back within its limits, if the opposite limit has ended the braking
/// before: the jerk must then be a full one against the acceleration until they are.
pub(super) fn return_time<T: Real>(task: &Task<T>) -> T {
    let late = |task: &Task<T>| {
        let [v, a] = task.start;
        let excess = v - task.fast;
        if excess > task.velocity_noise && a < T::ZERO {
            let square = (a * a - T::TWO * excess).max(T::ZERO);
            // The lesser root of v + a t + t²/2 = fast.
            T::TWO * excess / (square.sqrt() - a)
        } else {
            T::ZERO
        }
    };
    late(task).max(late(&task.mirror()))
}

/// From an acceleration above its limit.
fn down_to_limit<T: Real>(task: &Task<T>) -> [Stretch<T>; 2] {
    let [v, a] = task.start;
    let most = task.most;
    if v + T::HALF * a * a > task.fast {
        return slow_down(task);
    }
    let at_limit = v + T::HALF * (a - most) * (a + most);
    // Too fast backwards still: on at the limit until it is not, or until it would come to be too fast forwards.
    let back_in = (-task.back - at_limit) / most;
    let no_longer = (task.fast - at_limit) / most - T::HALF * most;
    let hold = back_in.min(no_longer).max(T::ZERO);
    [(-T::ONE, a - most, most), (T::ZERO, hold, most)]
}

/// Downwards at full jerk, then at the greatest deceleration, until the velocity is at its limit.
fn slow_down<T: Real>(task: &Task<T>) -> [Stretch<T>; 2] {
    let [v, a] = task.start;
    let (brake, top) = (task.brake, v + T::HALF * a * a);
    // Acceleration at which the velocity is the limit's; at which it would come to the one backwards by full jerk.
    let there = (T::TWO * (top - task.fast)).max(T::ZERO).sqrt();
    let no_longer = (top + task.back).max(T::ZERO).sqrt();
    let reached = there.min(no_longer);
    if reached <= brake {
        let time = (a + reached).max(T::ZERO);
        return [(-T::ONE, time, a - time), (T::ZERO, T::ZERO, a - time)];
    }
    let at_limit = top - T::HALF * brake * brake;
    let there = (at_limit - task.fast) / brake;
    let no_longer = (at_limit + task.back) / brake - T::HALF * brake;
    let hold = there.min(no_longer).max(T::ZERO);
    [(-T::ONE, a + brake, -brake), (T::ZERO, hold, -brake)]
}
