//! Stretches of constant jerk, one after the other.

use crate::{Extremes, Real, Setpoint};

/// Two to come within the limits, and the switches of two motions of seven segments each that are mixed.
pub(crate) const PIECES: usize = 16;

/// A stretch of constant jerk, from a known state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Piece<T> {
    begin: T,
    state: Setpoint<T>,
    /// Acceleration at its end, m/s².
    last: T,
}

/// Where the pieces laid so far have led.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Course<T> {
    pieces: [Piece<T>; PIECES],
    count: usize,
    pub now: T,
    pub state: Setpoint<T>,
}

impl<T: Real> Course<T> {
    pub fn new(start: &Setpoint<T>) -> Self {
        let state = Setpoint {
            jerk: T::ZERO,
            ..*start
        };
        Self {
            pieces: [Piece::default(); PIECES],
            count: 0,
            now: T::ZERO,
            state,
        }
    }

    /// Goes on for `time` (s) at `jerk` (m/s³) to the acceleration `last` (m/s²).
    pub fn lay(&mut self, jerk: T, time: T, last: T) {
        if time > T::ZERO && self.count < PIECES {
            let state = Setpoint { jerk, ..self.state };
            self.pieces[self.count] = Piece {
                begin: self.now,
                state,
                last,
            };
            self.count += 1;
            self.now += time;
            self.state = after(&state, time);
        }
        self.state.acceleration = last;
    }

    /// State at `t` from 0 to the end.
    pub fn at(&self, t: T) -> Setpoint<T> {
        let mut piece = &self.pieces[0];
        for next in &self.pieces[..self.count] {
            if t >= next.begin {
                piece = next;
            }
        }
        let mut state = after(&piece.state, t - piece.begin);
        let (first, last) = (piece.state.acceleration, piece.last);
        // The time may exceed its piece by rounding: the limits hold all the same.
        state.acceleration = state.acceleration.max(first.min(last)).min(first.max(last));
        state
    }

    /// The same motion with every position multiplied about its origin, and put to another start.
    pub fn scaled(&self, factor: T, from: T) -> Self {
        let origin = self.pieces[0].state.position;
        let scale = |s: &Setpoint<T>| Setpoint {
            position: from + factor * (s.position - origin),
            velocity: factor * s.velocity,
            acceleration: factor * s.acceleration,
            jerk: factor * s.jerk,
        };
        let mut scaled = *self;
        for piece in &mut scaled.pieces {
            piece.state = scale(&piece.state);
            piece.last = factor * piece.last;
        }
        scaled.state = scale(&self.state);
        scaled
    }

    /// The same motion as seen by one who moves at `-velocity` (m/s) from the same start.
    pub fn drifting(mut self, velocity: T) -> Self {
        let drift = |s: &mut Setpoint<T>, t: T| {
            s.position += velocity * t;
            s.velocity += velocity;
        };
        for piece in &mut self.pieces[..self.count] {
            drift(&mut piece.state, piece.begin);
        }
        drift(&mut self.state, self.now);
        self
    }

    /// How far the pieces go, both ends of each and what lies between.
    pub fn extremes(&self, mut found: Extremes<T>) -> Extremes<T> {
        for (i, piece) in self.pieces[..self.count].iter().enumerate() {
            let next = self.pieces[..self.count].get(i + 1);
            let time = next.map_or(self.now, |next| next.begin) - piece.begin;
            let mut note = |t: T| {
                if t >= T::ZERO && t <= time {
                    let s = after(&piece.state, t);
                    found.position_min = found.position_min.min(s.position);
                    found.position_max = found.position_max.max(s.position);
                    found.velocity = found.velocity.max(s.velocity.abs());
                }
            };
            note(T::ZERO);
            note(time);
            let ends = piece.state.acceleration.abs().max(piece.last.abs());
            found.acceleration = found.acceleration.max(ends);
            let (v, a, j) = (
                piece.state.velocity,
                piece.state.acceleration,
                piece.state.jerk,
            );
            if j != T::ZERO {
                note(-a / j);
            }
            // Where v + a t + j t²/2 = 0: no NaN is noted.
            let far = -(a + (a * a - T::TWO * v * j).sqrt().copysign(a));
            note(far / j);
            note(T::TWO * v / far);
            found.jerk = found.jerk.max(j.abs());
        }
        found
    }
}

/// Rates (of velocity or acceleration) and how long each lasts, s.
pub(crate) type Rates<'a, T> = &'a [(T, T)];

/// Share of the motion that goes `over` too far, beside one that goes `under` too little; half of each if both fit.
pub(crate) fn share<T: Real>(over: T, under: T) -> T {
    let (over, under) = (over.max(T::ZERO), under.max(T::ZERO));
    let span = over + under;
    if span > T::ZERO {
        under / span
    } else {
        T::HALF
    }
}

/// Two motions of the same duration, each a list of rates and the times (s) that they last, in a constant ratio: `share` of
/// the first, the remainder of the second, which counts the other way round. `lay` gets the rates and times that result.
///
/// Where the durations differ by rounding, the shorter one counts.
pub(crate) fn mixed<T: Real>(
    (first, second): (Rates<'_, T>, Rates<'_, T>),
    share: T,
    mut lay: impl FnMut(T, T),
) {
    let ongoing = |&(_, time): &(T, T)| time > T::ZERO;
    let (mut first, mut second) = (
        first.iter().copied().filter(ongoing),
        second.iter().copied().filter(ongoing),
    );
    let (mut one, mut two) = (first.next(), second.next());
    while let (Some((rate, left)), Some((other, other_left))) = (one, two) {
        let time = left.min(other_left);
        lay(share * rate - (T::ONE - share) * other, time);
        let on = |rate, left: T| (left > time).then(|| (rate, left - time));
        one = on(rate, left).or_else(|| first.next());
        two = on(other, other_left).or_else(|| second.next());
    }
}

/// The state after `dt` of constant jerk.
#[inline]
pub(crate) fn after<T: Real>(state: &Setpoint<T>, dt: T) -> Setpoint<T> {
    let (v, a, j) = (state.velocity, state.acceleration, state.jerk);
    Setpoint {
        position: state.position + dt * (v + dt * (T::HALF * a + dt * j * T::of(1.0 / 6.0))),
        velocity: v + dt * (a + T::HALF * dt * j),
        acceleration: a + dt * j,
        jerk: j,
    }
}
