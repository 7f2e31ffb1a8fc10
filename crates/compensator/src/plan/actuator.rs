//! The actuator inverted: the command that brings a torque a cycle later.

use foc_pmsm::Dq;
use lugre::Exponential;

use crate::model::{Drive, DriveModel, MOST_DELAY};

/// The command of a cycle, and the torque and currents that follow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Commanded<T> {
    /// In the actuator's unit.
    pub effort: T,
    /// Whether a limit keeps the torque from being reached.
    pub limited: bool,
}

/// The actuator's state along the plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inverse<T> {
    drive: Drive<T>,
    limit: T,
    period: T,
    /// Share of the torque that a lag keeps over a cycle.
    kept: T,
    torque: T,
    /// Currents at the start of the cycle in which the next voltage acts, and in those before:
    /// the newest first.
    past: [Dq<T>; PAST],
    /// Cycles from the sample that the current controllers go by to that, whole and part.
    late: usize,
    late_part: T,
    integral: Dq<T>,
}

/// Currents that are remembered.
const PAST: usize = MOST_DELAY + 2;

impl<T: Exponential> Inverse<T> {
    pub fn new(model: &DriveModel<T>) -> Self {
        let kept = match &model.drive {
            Drive::Lag { bandwidth, .. } => (-*bandwidth * model.period).exp(),
            Drive::FieldOriented { .. } => T::ZERO,
        };
        let whole = model.drive.late().floor();
        Self {
            drive: model.drive,
            limit: model.effort_limit,
            period: model.period,
            kept,
            torque: T::ZERO,
            past: [Dq::ZERO; PAST],
            late: (whole.to_f64() as usize).min(MOST_DELAY),
            late_part: model.drive.late() - whole,
            integral: Dq::ZERO,
        }
    }

    /// Share of the torque that a lag keeps over a cycle.
    pub fn kept(&self) -> T {
        self.kept
    }

    /// Steady with a constant torque (N·m).
    pub fn settle(&mut self, torque: T) {
        self.torque = torque;
        if let Drive::FieldOriented { motor, gear, .. } = &self.drive {
            let q = motor.q_current(torque / *gear);
            let current = Dq { d: T::ZERO, q };
            self.past = [current; PAST];
            self.integral = motor.steady_voltage(current, T::ZERO);
        }
    }

    /// q current along the plan at the start of the coming cycle, A; the command that
    /// would hold the torque if there is none.
    pub fn effort_now(&self) -> T {
        match &self.drive {
            Drive::FieldOriented { .. } => self.past[0].q,
            Drive::Lag { gain, .. } => self.torque / *gain,
        }
    }

    /// Currents as the controllers sampled them.
    fn sampled(&self) -> Dq<T> {
        let newer = self.past[self.late];
        if self.late_part == T::ZERO {
            return newer;
        }
        newer * (T::ONE - self.late_part) + self.past[self.late + 1] * self.late_part
    }

    /// The command of the cycle, at whose end the torque is to be `torque` (N·m),
    /// the motor turning at the mean `speed` (rad/s).
    pub fn towards(&mut self, torque: T, speed: T) -> Commanded<T> {
        match self.drive {
            Drive::Lag { gain, .. } => self.lag(gain, torque),
            Drive::FieldOriented {
                motor,
                gear,
                d,
                q,
                voltage,
                ..
            } => {
                let h = self.period;
                let speed = gear * speed;
                let (sampled, current) = (self.sampled(), self.past[0]);
                let error = -sampled.d;
                self.integral.d += d[1] * h * error;
                let ud = (d[0] * error + self.integral.d).max(-voltage).min(voltage);
                let at = |uq| motor.step(current, Dq { d: ud, q: uq }, speed, h);
                let (free, one) = (at(T::ZERO), at(T::ONE));
                let rise = one - free;
                let per_current = gear
                    * motor.torque(Dq {
                        d: free.d,
                        q: T::ONE,
                    });
                let wanted = (torque / per_current - free.q) / rise.q;
                // As the drive limits it: d first, then what the vector leaves for q, and
                // the command.
                let left = ((voltage - ud) * (voltage + ud)).max(T::ZERO).sqrt();
                let per_error = q[0] + q[1] * h;
                let error = (wanted.max(-left).min(left) - self.integral.q) / per_error;
                let asked = sampled.q + error;
                let effort = asked.max(-self.limit).min(self.limit);
                let error = effort - sampled.q;
                self.integral.q += q[1] * h * error;
                let uq = q[0] * error + self.integral.q;
                let uq = uq.max(-left).min(left);
                let reached = free + rise * uq;
                self.past.copy_within(..=self.late, 1);
                self.past[0] = reached;
                self.torque = gear * motor.torque(reached);
                Commanded {
                    effort,
                    limited: effort != asked || wanted.abs() > left,
                }
            }
        }
    }

    fn lag(&mut self, gain: T, torque: T) -> Commanded<T> {
        // Without a lag the torque acts over the whole cycle: its mean counts.
        let wanted = if self.kept == T::ZERO {
            T::HALF * (self.torque + torque)
        } else {
            (torque - self.kept * self.torque) / (T::ONE - self.kept)
        };
        let asked = wanted / gain;
        let effort = asked.max(-self.limit).min(self.limit);
        let limited = effort != asked;
        self.torque = match (self.kept == T::ZERO, limited) {
            (true, false) => torque,
            (true, true) => gain * effort,
            (false, _) => self.kept * self.torque + (T::ONE - self.kept) * gain * effort,
        };
        Commanded { effort, limited }
    }
}
