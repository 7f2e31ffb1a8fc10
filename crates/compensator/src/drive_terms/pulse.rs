//! The pulse after a change of direction, fitted to a friction law.

use lugre::{Exponential, LuGre};

use crate::model::DriveModel;

/// Torque after a change of direction, as quadrant error compensation has it: the old level
/// is held for a while, then the new one comes with a pulse on top that decays.
///
/// ```text
/// T_r(t) = T_before                            t < delay
///        = T_after + a (T_after − T_before)/T_C e^(−(t − delay)/decay)
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulse<T = f64> {
    /// Time from the change of direction to the pulse, s.
    pub delay: T,
    /// Its height a after a start with relaxed friction, N·m at the motor; a reversal
    /// changes the level by twice as much and takes twice this height.
    pub amplitude: T,
    /// Time in which it falls to 37 %, s.
    pub decay: T,
}

/// The motion that the pulse is fitted to: a start from rest, or what follows a reversal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<T = f64> {
    /// Acceleration from the first instant on, m/s²; 0 where the jerk is limited.
    pub acceleration: T,
    /// Jerk, m/s³.
    pub jerk: T,
}

/// Cycles of the start, at most.
const MOST_CYCLES: usize = 20_000;

/// The pulse nearest to the friction along `start`, in least squares of the torque.
pub(super) fn fit<T: Exponential>(model: &DriveModel<T>, start: &Start<T>) -> Pulse<T> {
    let friction = Along {
        law: model.friction,
        start: *start,
        lever: model.lever,
        ratio: model.travel / model.lever,
        step: model.period,
    };
    let Some(end) = friction.settles() else {
        return Pulse::default();
    };
    let mut best = (T::INFINITY, Pulse::default());
    // Coarse, then around the best so far with a third of the reach, in shares of the time
    // in which friction settles.
    let mut centre = [T::of(0.25), T::of(0.25)];
    let mut reach = T::of(0.25);
    for _ in 0..6 {
        for i in -3..=3 {
            for j in -3..=3 {
                let at = |c: T, k: i32| (c + reach * T::of(f64::from(k) / 3.0)).max(T::of(1e-3));
                let shares = [at(centre[0], i), at(centre[1], j)];
                let tried = friction.miss(end, shares[0] * end, shares[1] * end);
                if tried.0 < best.0 {
                    best = tried;
                }
            }
        }
        centre = [best.1.delay / end, best.1.decay / end];
        reach = reach / T::of(2.5);
    }
    best.1
}

/// Friction along a start, without its viscous part, at the motor.
struct Along<T> {
    law: LuGre<T>,
    start: Start<T>,
    lever: T,
    ratio: T,
    step: T,
}

impl<T: Exponential> Along<T> {
    /// Calls back with time and torque of each cycle until that says stop.
    fn run(&self, mut each: impl FnMut(T, T) -> bool) {
        let (mut bristle, mut before) = (T::ZERO, T::ZERO);
        let viscous = self.law.parameters().viscous;
        for k in 1..=MOST_CYCLES {
            let t = T::of(k as f64) * self.step;
            let velocity = t * (self.start.acceleration + T::HALF * self.start.jerk * t);
            let speed = velocity / self.lever;
            let (next, torque) = self.law.step_torque(bristle, before, speed, self.step);
            (bristle, before) = (next, speed);
            if !each(t, self.ratio * (torque - viscous * speed)) {
                return;
            }
        }
    }

    /// When friction has come to within 2 % of its Coulomb level for good.
    fn settles(&self) -> Option<T> {
        let level = self.ratio * self.law.parameters().coulomb;
        let (mut last, mut end) = (T::ZERO, T::ZERO);
        self.run(|t, torque| {
            if (torque - level).abs() > T::of(0.02) * level {
                last = t;
            }
            end = t;
            // Long enough after the last deviation.
            end < T::TWO * last + T::of(20.0) * self.step
        });
        (last > T::ZERO && level > T::ZERO).then_some(last)
    }

    /// Squared deviation of the best pulse with that delay and decay, and that pulse.
    fn miss(&self, end: T, delay: T, decay: T) -> (T, Pulse<T>) {
        let level = self.ratio * self.law.parameters().coulomb;
        // Of the torque d without the level, and the pulse p: Σd², Σdp, Σp².
        let [mut dd, mut dp, mut pp] = [T::ZERO; 3];
        self.run(|t, torque| {
            if t < delay {
                dd += torque * torque;
            } else {
                let (d, p) = (torque - level, (-(t - delay) / decay).exp());
                dd += d * d;
                dp += d * p;
                pp += p * p;
            }
            t < T::TWO * end
        });
        let amplitude = if pp > T::ZERO { dp / pp } else { T::ZERO };
        let pulse = Pulse {
            delay,
            amplitude,
            decay,
        };
        (dd - amplitude * dp, pulse)
    }
}
