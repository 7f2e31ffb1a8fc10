//! Limits, smooth switching and a watchdog around any compensator.
//!
//! ```text
//! out = g · limited(correction)      g goes from 0 to 1 and back as s² (3 − 2 s), s in proportion
//! to time
//! ```
//!
//! The guard trips, fades the correction out and stays off until it is told otherwise
//! where a correction is no number, where one is at its limit for longer than a while, or
//! where the compensator is surprised by what it observes for as long. The drive's own
//! loops then have the axis alone.
//!
//! What a compensator asks for may jump where it begins anew, or where its limits change. The guard
//! then goes over from what it let through last, in the same time and by the same curve.

use axis_scalar::Scalar;

use crate::error::{require, within};
use crate::{Compensator, CompensatorError, Correction, Sample};

/// What a guard keeps to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct GuardLimits<T = f64> {
    /// Greatest offset of the position, m or rad.
    pub position: T,
    /// Greatest offset of the command, in the actuator's unit.
    pub effort: T,
    /// Greatest surprise, in deviations ([`Compensator::surprise`]).
    pub surprise: T,
    /// Cycles for which a limit may be exceeded before the guard trips.
    pub patience: u32,
    /// Cycles in which the correction is faded in and out; 0 for at once.
    pub fade: u32,
}

impl<T: Scalar> GuardLimits<T> {
    fn check(&self) -> Result<(), CompensatorError> {
        let named = [
            ("position", self.position),
            ("effort", self.effort),
            ("surprise", self.surprise),
        ];
        for (name, limit) in named {
            let inside = limit > T::ZERO && !within(limit, -1.0, 0.0);
            require(inside, name, limit, "above 0")?;
        }
        Ok(())
    }

    /// Each limit rounded to the nearest number of another scalar.
    #[must_use]
    pub fn cast<U: Scalar>(&self) -> GuardLimits<U> {
        let cast = |value: T| U::of(value.to_f64());
        GuardLimits {
            position: cast(self.position),
            effort: cast(self.effort),
            surprise: cast(self.surprise),
            patience: self.patience,
            fade: self.fade,
        }
    }
}

/// Why a guard has tripped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trip {
    /// A correction was not a number.
    NotFinite,
    /// The offset of the position was at its limit for too long.
    Position,
    /// The offset of the command was.
    Effort,
    /// The compensator was surprised for too long.
    Surprise,
}

impl core::fmt::Display for Trip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "the correction was not a number",
            Self::Position => "the offset of the position was at its limit for too long",
            Self::Effort => "the offset of the command was at its limit for too long",
            Self::Surprise => "the axis was away from where the observer expected it for too long",
        })
    }
}

/// What a guard lets through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The correction, or as much of it as is faded in.
    On,
    /// Nothing, or what is not faded out yet: it was switched off.
    Off,
    /// Likewise: it has tripped.
    Tripped(Trip),
}

/// Limits, fading and watchdog. 76 bytes in `f32`, no allocation.
#[derive(Clone, Copy, Debug)]
pub struct Guard<T = f64> {
    limits: GuardLimits<T>,
    status: Status,
    /// Cycles faded in, from 0 to `fade`.
    faded: u32,
    /// Cycles for which each limit was exceeded.
    beyond: [u32; 3],
    last: Correction<T>,
    /// What was let through last, and what is gone over from, in so many cycles more.
    passed: Correction<T>,
    from: Correction<T>,
    blend: u32,
}

impl<T: Scalar> Guard<T> {
    /// What it keeps to.
    pub fn limits(&self) -> &GuardLimits<T> {
        &self.limits
    }

    /// Switched off; [`Guard::switch`] fades in.
    ///
    /// # Errors
    /// [`CompensatorError::Setting`] for a limit that is not above 0.
    pub fn new(limits: GuardLimits<T>) -> Result<Self, CompensatorError> {
        limits.check()?;
        Ok(Self {
            limits,
            status: Status::Off,
            faded: 0,
            beyond: [0; 3],
            last: Correction::default(),
            passed: Correction::default(),
            from: Correction::default(),
            blend: 0,
        })
    }

    /// Other limits from now on, at any moment: what they let through is gone over to.
    ///
    /// # Errors
    /// As [`Guard::new`]; the limits are then those of before.
    pub fn set_limits(&mut self, limits: GuardLimits<T>) -> Result<(), CompensatorError> {
        limits.check()?;
        self.limits = limits;
        self.faded = self.faded.min(limits.fade);
        self.restart();
        Ok(())
    }

    /// The compensator begins anew: from what was let through last the guard goes over to what
    /// it lets through from now on, without a jump.
    pub fn restart(&mut self) {
        self.from = self.passed;
        self.blend = self.limits.fade;
    }

    /// Fades in or out, at any moment. Switching on takes back a trip.
    pub fn switch(&mut self, on: bool) {
        self.status = if on { Status::On } else { Status::Off };
        self.beyond = [0; 3];
    }

    /// What it lets through.
    pub fn status(&self) -> Status {
        self.status
    }

    /// What of a correction goes to the drive in this cycle.
    pub fn pass(&mut self, asked: &Correction<T>, surprise: T) -> Correction<T> {
        let l = self.limits;
        if self.status == Status::On {
            self.watch(asked, surprise);
        }
        // What is faded out after a trip is the last that was a number.
        if asked.position.is_finite() && asked.command.is_finite() {
            self.last = Correction {
                position: asked.position.max(-l.position).min(l.position),
                command: asked.command.max(-l.effort).min(l.effort),
            };
        }
        self.faded = match self.status {
            Status::On => (self.faded + 1).min(l.fade),
            _ => self.faded.saturating_sub(1),
        };
        let share = match (l.fade, self.status) {
            (0, Status::On) => T::ONE,
            (0, _) => T::ZERO,
            _ => T::of(f64::from(self.faded)) / T::of(f64::from(l.fade)),
        };
        // Without slope at either end, and the same bits wherever it is computed.
        let gain = smooth(share);
        let mut out = Correction {
            position: gain * self.last.position,
            command: gain * self.last.command,
        };
        if self.blend > 0 {
            let before = smooth(T::of(f64::from(self.blend)) / T::of(f64::from(l.fade)));
            out = Correction {
                position: out.position + before * (self.from.position - out.position),
                command: out.command + before * (self.from.command - out.command),
            };
            self.blend -= 1;
        }
        self.passed = out;
        out
    }

    fn watch(&mut self, asked: &Correction<T>, surprise: T) {
        let l = self.limits;
        if !(asked.position.is_finite() && asked.command.is_finite()) {
            self.status = Status::Tripped(Trip::NotFinite);
            return;
        }
        let watched = [
            (asked.position.abs(), l.position, Trip::Position),
            (asked.command.abs(), l.effort, Trip::Effort),
            (surprise.abs(), l.surprise, Trip::Surprise),
        ];
        for ((value, limit, trip), beyond) in watched.into_iter().zip(&mut self.beyond) {
            *beyond = if value <= limit { 0 } else { *beyond + 1 };
            if *beyond > l.patience {
                self.status = Status::Tripped(trip);
                return;
            }
        }
    }
}

fn smooth<T: Scalar>(share: T) -> T {
    share * share * (T::of(3.0) - T::TWO * share)
}

/// A compensator behind a guard. It goes on observing while it is off, so that it can be
/// switched on at any moment.
#[derive(Clone, Debug)]
pub struct Guarded<C, T = f64> {
    inner: C,
    guard: Guard<T>,
}

impl<T: Scalar, C: Compensator<T>> Guarded<C, T> {
    /// A compensator behind a guard.
    pub fn new(inner: C, guard: Guard<T>) -> Self {
        Self { inner, guard }
    }

    /// The guard.
    pub fn guard(&self) -> &Guard<T> {
        &self.guard
    }

    /// The guard, to switch it.
    pub fn guard_mut(&mut self) -> &mut Guard<T> {
        &mut self.guard
    }

    /// The compensator.
    pub fn inner(&self) -> &C {
        &self.inner
    }
}

impl<T: Scalar, C: Compensator<T>> Compensator<T> for Guarded<C, T> {
    /// The guard keeps its state: a trip is not taken back by a new motion. It goes over from the
    /// last correction to those of the new motion.
    fn reset(&mut self) {
        self.inner.reset();
        self.guard.restart();
    }

    /// After a correction that is NaN or infinite the compensator begins anew: its state may hold
    /// that for good, and switching on again would trip again.
    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let asked = self.inner.correct(sample);
        let passed = self.guard.pass(&asked, self.inner.surprise());
        if !(asked.position.is_finite() && asked.command.is_finite()) {
            self.reset();
        }
        passed
    }

    fn surprise(&self) -> T {
        self.inner.surprise()
    }
}
