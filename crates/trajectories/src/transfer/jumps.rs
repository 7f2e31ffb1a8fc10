//! Transfers whose acceleration may jump: velocities are trapezoids.

use super::{Transfer, TransferLimits};
use crate::constant_jerk::{self, Course};
use crate::error::unrepresentable;
use crate::{Real, Setpoint, TrajectoryError};

/// One direction: the greatest displacement. All in SI units.
struct Side<T> {
    from: T,
    to: T,
    most: T,
    brake: T,
    fast: T,
    distance: T,
    noise: T,
}

/// Time to the peak, at it, and from it, s, and the peak, m/s.
#[derive(Clone, Copy)]
struct Shape<T> {
    times: [T; 3],
    peak: T,
}

impl<T: Real> Side<T> {
    fn mirror(&self) -> Self {
        Self {
            from: -self.from,
            to: -self.to,
            most: self.brake,
            brake: self.most,
            distance: -self.distance,
            ..*self
        }
    }

    fn shape(&self, peak: T, cruise: T) -> Shape<T> {
        let times = [
            (peak - self.from) / self.most,
            cruise,
            (peak - self.to) / self.brake,
        ];
        Shape { times, peak }
    }

    fn miss(&self, shape: &Shape<T>) -> T {
        let [first, cruise, last] = shape.times;
        T::HALF * (first * (self.from + shape.peak) + last * (self.to + shape.peak))
            + cruise * shape.peak
            - self.distance
    }

    fn noise(&self, shape: &Shape<T>) -> T {
        let total = shape.times[0] + shape.times[1] + shape.times[2];
        let speed = self.from.abs() + self.to.abs() + shape.peak.abs();
        self.noise + T::of(8.0) * T::EPSILON * speed * total
    }

    /// The least duration not below `at_least` in which the greatest displacement is that wanted.
    fn search(&self, at_least: T, mut offer: impl FnMut(T, Shape<T>)) {
        let least = self.from.max(self.to);
        let mut try_one = |shape: Shape<T>| {
            let total = shape.times[0] + shape.times[1] + shape.times[2];
            if total >= at_least {
                offer(total, shape);
            }
        };
        // (p² − v₀²)/2A + (p² − v₁²)/2B = d
        let (a, b) = (self.most, self.brake);
        let square =
            (T::TWO * self.distance + self.from * (self.from / a) + self.to * (self.to / b))
                / (T::ONE / a + T::ONE / b);
        let straight = self.shape(least, T::ZERO);
        if self.miss(&straight).abs() <= self.noise(&straight) {
            try_one(straight);
        }
        let root = square.sqrt();
        for peak in [-root, root] {
            if peak >= least && peak <= self.fast {
                try_one(self.shape(peak, T::ZERO));
            }
        }
        let full = self.shape(self.fast, T::ZERO);
        let miss = self.miss(&full);
        if miss <= self.noise(&full) {
            try_one(self.shape(self.fast, (-miss).max(T::ZERO) / self.fast));
        }
    }

    /// The greatest displacement in `total` s.
    fn farthest(&self, total: T) -> Option<Shape<T>> {
        let (a, b) = (self.most, self.brake);
        // (p − v₀)/A + (p − v₁)/B = T
        let peak = (total + self.from / a + self.to / b) / (T::ONE / a + T::ONE / b);
        let least = self.from.max(self.to);
        let slack = T::of(16.0) * T::EPSILON * (least.abs() + a.max(b) * total);
        if peak < least - slack {
            return None;
        }
        if peak <= self.fast {
            return Some(self.shape(peak.max(least), T::ZERO));
        }
        let full = self.shape(self.fast, T::ZERO);
        Some(self.shape(self.fast, total - full.times[0] - full.times[2]))
    }
}

pub(super) fn plan<T: Real>(
    start: &Setpoint<T>,
    target: &Setpoint<T>,
    limits: &TransferLimits<T>,
    duration: T,
) -> Result<Transfer<T>, TrajectoryError> {
    let change = limits.change();
    let (most, brake) = (change.acceleration_max(), -change.acceleration_min());
    let mut course = Course::new(start);
    // An acceleration that may jump says nothing of what follows.
    course.state.acceleration = T::ZERO;
    let v = start.velocity;
    let kept = v.max(limits.velocity_min()).min(limits.velocity_max());
    let rate = if kept > v { most } else { -brake };
    run(&mut course, rate, (kept - v) / rate);
    course.state.velocity = kept;
    let within = course.now;

    let size = start.position.abs() + target.position.abs();
    let up = Side {
        from: kept,
        to: target.velocity,
        most,
        brake,
        fast: limits.velocity_max(),
        distance: target.position - course.state.position,
        noise: T::of(4.0) * T::EPSILON * size,
    };
    let down = Side {
        fast: -limits.velocity_min(),
        ..up.mirror()
    };
    let wanted = (duration - within).max(T::ZERO);
    if wanted > T::ZERO && mix(&up, &down, wanted, &mut course) {
        return Transfer::finish(course, (start, target), limits, within);
    }
    let mut best: Option<(T, Shape<T>, T)> = None;
    for (sign, side) in [(T::ONE, &up), (-T::ONE, &down)] {
        side.search(wanted, |total, shape| {
            if best.is_none_or(|(least, ..)| total < least) {
                best = Some((total, shape, sign));
            }
        });
    }
    let Some((_, shape, sign)) = best else {
        return Err(unrepresentable::<T>("the duration of the transfer"));
    };
    let side = if sign > T::ZERO { &up } else { &down };
    for (rate, time) in rates(side, &shape) {
        run(&mut course, sign * rate, time);
    }
    Transfer::finish(course, (start, target), limits, within)
}

fn rates<T: Real>(side: &Side<T>, shape: &Shape<T>) -> [(T, T); 3] {
    let [first, cruise, last] = shape.times;
    [(side.most, first), (T::ZERO, cruise), (-side.brake, last)]
}

/// Goes on at an acceleration.
fn run<T: Real>(course: &mut Course<T>, acceleration: T, time: T) {
    course.state.acceleration = acceleration;
    course.lay(T::ZERO, time, acceleration);
}

/// As the parent's, of accelerations.
fn mix<T: Real>(up: &Side<T>, down: &Side<T>, total: T, course: &mut Course<T>) -> bool {
    let (Some(far), Some(near)) = (up.farthest(total), down.farthest(total)) else {
        return false;
    };
    let (over, under) = (up.miss(&far), down.miss(&near));
    if over < -up.noise(&far) || under < -down.noise(&near) {
        return false;
    }
    let share = constant_jerk::share(over, under);
    let (far, near) = (rates(up, &far), rates(down, &near));
    constant_jerk::mixed((&far, &near), share, |rate, time| run(course, rate, time));
    true
}
