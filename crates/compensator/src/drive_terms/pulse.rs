//! The pulse after a change of direction, fitted to a friction law.

use axis_scalar::Scalar;
use lugre::LuGre;

use crate::CompensatorError;
use crate::error::{require, within};
use crate::model::DriveModel;

/// Torque after a change of direction, as quadrant error compensation has it: the old level
/// is held for a while, then the new one comes with a pulse on top that decays.
///
/// ```text
/// T_r(t) = T_before                                                  t < delay
///        = T_after + a (T_after − T_before)/T_C e^(−(t − delay)/decay)
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ReversalPulse<T = f64> {
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
pub struct ReversalStart {
    /// Acceleration from the first instant on, m/s²; 0 if the jerk is limited.
    pub acceleration: f64,
    /// Jerk, m/s³; 0 if the acceleration is constant.
    pub jerk: f64,
}

impl ReversalStart {
    pub(super) fn check(&self) -> Result<(), CompensatorError> {
        for (name, value) in [("acceleration", self.acceleration), ("jerk", self.jerk)] {
            require(within(value, 0.0, 1e9), name, value, "from 0 to 1e9")?;
        }
        let moves = self.acceleration + self.jerk >= 1e-9;
        let valid = "at least 1e-9 if the acceleration is 0";
        require(moves, "jerk", self.jerk, valid).map(|_| ())
    }

    /// Time in which it has gone a way.
    fn time(&self, way: f64) -> f64 {
        let even = Scalar::sqrt(2.0 * way / self.acceleration.max(f64::MIN_POSITIVE));
        let rising = Scalar::cbrt(6.0 * way / self.jerk.max(f64::MIN_POSITIVE));
        even.min(rising)
    }
}

/// Cycles of the start, at most.
const MOST_CYCLES: u32 = 20_000;

/// The pulse that leaves the least squares of the error along `start`, behind the drive's
/// loops around a rigid axis of `inertia` on a transmission of `compliance`. None, all its
/// values 0, where friction comes up at once or not at all.
pub(super) fn fit(
    model: &DriveModel,
    start: &ReversalStart,
    [inertia, compliance]: [f64; 2],
) -> ReversalPulse {
    let servo = Servo::new(model, inertia);
    // Fine enough for friction and for the speed loop, whatever the control period.
    let scale = start.time(model.lever * model.friction.bristle_limit());
    let step = model.period.max(scale / 400.0).min(servo.longest_step());
    let friction = Start {
        law: model.friction,
        start: *start,
        lever: model.lever,
        ratio: model.travel / model.lever,
        step,
        compliance,
        servo,
    };
    let Some(end) = friction.settles() else {
        return ReversalPulse::default();
    };
    let mut best = (f64::INFINITY, ReversalPulse::default());
    // In shares of the time in which friction settles: coarse, then ever closer around
    // the best so far.
    let (mut centre, mut reach) = ([0.25; 2], 0.25);
    for _ in 0..6 {
        for i in -3..=3 {
            for j in -3..=3 {
                let at = |c: f64, k: i32| (c + reach * f64::from(k) / 3.0).max(1e-3);
                let [delay, decay] = [at(centre[0], i), at(centre[1], j)].map(|x| x * end);
                let tried = friction.miss(end, delay, decay);
                if tried.0 < best.0 {
                    best = tried;
                }
            }
        }
        centre = [best.1.delay / end, best.1.decay / end];
        reach /= 2.5;
    }
    best.1
}

/// Friction along a start, without its viscous part, at the motor.
struct Start {
    law: LuGre,
    start: ReversalStart,
    lever: f64,
    ratio: f64,
    step: f64,
    compliance: f64,
    servo: Servo,
}

impl Start {
    /// Calls back with time and torque of each cycle until that says stop.
    fn run(&self, mut each: impl FnMut(f64, f64) -> bool) {
        let (mut bristle, mut before) = (0.0, 0.0);
        let viscous = self.law.parameters().viscous;
        for k in 1..=MOST_CYCLES {
            let t = f64::from(k) * self.step;
            let velocity = t * (self.start.acceleration + 0.5 * self.start.jerk * t);
            let speed = velocity / self.lever;
            let (next, torque) = self.law.step_torque(bristle, before, speed, self.step);
            (bristle, before) = (next, speed);
            if !each(t, self.ratio * (torque - viscous * speed)) {
                return;
            }
        }
    }

    /// When friction has come to within 2 % of its Coulomb level for good.
    fn settles(&self) -> Option<f64> {
        let level = self.ratio * self.law.parameters().coulomb;
        let (mut last, mut end) = (0.0, 0.0);
        self.run(|t, torque| {
            if (torque - level).abs() > 0.02 * level {
                last = t;
            }
            end = t;
            // Long enough after the last deviation.
            end < 2.0 * last + 20.0 * self.step
        });
        (last > 0.0 && level > 0.0).then_some(last)
    }

    /// Squared error of the best pulse with that delay and decay, and that pulse.
    fn miss(&self, end: f64, delay: f64, decay: f64) -> (f64, ReversalPulse) {
        let level = self.ratio * self.law.parameters().coulomb;
        let [mut left, mut taken] = [self.servo, self.servo];
        // Of the error d that the level alone leaves, and what a pulse of height 1 takes
        // away, p: Σd², Σdp, Σp².
        let [mut dd, mut dp, mut pp] = [0.0; 3];
        self.run(|t, torque| {
            let (step, pulse) = match t < delay {
                true => (0.0, 0.0),
                false => (level, Scalar::exp(-(t - delay) / decay)),
            };
            // The level winds the transmission up, which the drive is told of; what else
            // friction does to it, it is not.
            let known = self.compliance * (step - level * pulse);
            let lead = self.compliance * level * pulse / decay;
            let wound = self.compliance * torque;
            let d = left.error(torque - step, [wound, known, lead], self.step);
            let p = taken.error(pulse, [0.0; 3], self.step);
            dd += d * d;
            dp += d * p;
            pp += p * p;
            t < 2.0 * end
        });
        let amplitude = if pp > 0.0 { dp / pp } else { 0.0 };
        let pulse = ReversalPulse {
            delay,
            amplitude,
            decay,
        };
        (dd - amplitude * dp, pulse)
    }
}

/// The drive's loops around a rigid axis at rest.
#[derive(Clone, Copy)]
struct Servo {
    /// Per radian, second and cycle: position, speed and integral gain over the inertia.
    gains: [f64; 3],
    inertia: f64,
    from_motor: bool,
    angle: f64,
    speed: f64,
    integral: f64,
}

impl Servo {
    fn new(model: &DriveModel, inertia: f64) -> Self {
        let (c, k) = (&model.cascade, model.torque_constant());
        Self {
            gains: [model.travel * c.position, k * c.speed, k * c.speed_integral],
            inertia,
            from_motor: c.from_motor,
            angle: 0.0,
            speed: 0.0,
            integral: 0.0,
        }
    }

    /// Longest step with which the speed loop is followed well.
    fn longest_step(&self) -> f64 {
        let [_, speed, _] = self.gains;
        0.2 * self.inertia / speed.max(f64::MIN_POSITIVE)
    }

    /// The load's angle after a cycle under a torque that nothing feeds forward, the
    /// transmission `wound` up, of which the drive is told `known` and its rate `lead`; the
    /// torque itself where no loop would hold the axis.
    fn error(&mut self, torque: f64, [wound, known, lead]: [f64; 3], step: f64) -> f64 {
        let [position, speed, integral] = self.gains;
        if position * speed == 0.0 {
            return torque;
        }
        let shown = match self.from_motor {
            true => self.angle - known,
            false => self.angle - wound - lead / position,
        };
        let wanted = -position * shown - self.speed;
        self.integral += integral * step * wanted;
        self.speed += step / self.inertia * (speed * wanted + self.integral - torque);
        self.angle += step * self.speed;
        self.angle - wound
    }
}
