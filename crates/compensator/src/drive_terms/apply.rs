//! The terms at work, as a drive applies them.

use lugre::Exponential;

use super::DriveTerms;
use crate::{Compensator, Correction, Reference, Sample};

/// Applies [`DriveTerms`] and nothing else, from the reference alone: its difference to a
/// [`crate::Plan`] is what the export into a drive loses.
///
/// At the start the drive's integrator holds the axis' own loads there: only how they
/// change from then on is added. A sample whose reference is not finite repeats the
/// correction before it.
#[derive(Clone, Copy, Debug)]
pub struct DriveTermsFeedforward<T = f64> {
    terms: DriveTerms<T>,
    /// Friction level that a reset begins with, N·m.
    carried: T,
    /// Wind-up with which the position loop was homed before an earlier motion, rad.
    homed: Option<T>,
    state: State<T>,
}

#[derive(Clone, Copy, Debug)]
struct State<T> {
    /// Load torque that is held at the start (N·m), and wind-up with which the position loop
    /// was homed (rad).
    home: Option<[T; 2]>,
    /// −1 or 1; 0 before the first motion.
    direction: T,
    /// Friction level before and after the direction changed last, N·m.
    before: T,
    after: T,
    /// Time since then, s.
    since: T,
    last: Correction<T>,
}

impl<T: Exponential> State<T> {
    fn at(level: T) -> Self {
        Self {
            home: None,
            direction: T::ZERO,
            before: level,
            after: level,
            since: T::ZERO,
            last: Correction::default(),
        }
    }
}

impl<T: Exponential> DriveTermsFeedforward<T> {
    /// A drive at rest, friction relaxed.
    #[must_use]
    pub fn new(terms: DriveTerms<T>) -> Self {
        Self {
            terms,
            carried: T::ZERO,
            homed: None,
            state: State::at(T::ZERO),
        }
    }

    /// The same drive at rest before its next motion: it keeps its friction level, and where
    /// its position loop was homed.
    #[must_use]
    pub fn carried_on(mut self) -> Self {
        self.carried = self.state.after;
        self.homed = self.homed.or(self.state.home.map(|[_, wound]| wound));
        self.reset();
        self
    }

    /// The terms.
    pub fn terms(&self) -> &DriveTerms<T> {
        &self.terms
    }

    /// Torque of friction, N·m, and its level as the wind-up takes it.
    fn friction(&self) -> [T; 2] {
        let (t, s) = (&self.terms, &self.state);
        let since = s.since - t.pulse.delay;
        if since < T::ZERO {
            return [s.before; 2];
        }
        if t.pulse.decay <= T::ZERO || t.coulomb <= T::ZERO {
            return [s.after; 2];
        }
        let left = (s.after - s.before) * (-since / t.pulse.decay).exp();
        let height = t.pulse.amplitude / t.coulomb;
        [s.after + height * left, s.after - left]
    }

    /// A change of direction, by the reference; the level holds on at rest.
    fn turn(&mut self, velocity: T) {
        if velocity == T::ZERO {
            return;
        }
        let direction = T::ONE.copysign(velocity);
        if direction != self.state.direction {
            let [_, level] = self.friction();
            self.state.before = level;
            self.state.after = direction * self.terms.coulomb;
            self.state.direction = direction;
            self.state.since = T::ZERO;
        }
    }

    /// Load torque (N·m) and wind-up (rad) at a set point with a friction level.
    fn tables(&self, at: &Reference<T>, level: T) -> [T; 2] {
        let t = &self.terms;
        let section = t.along.at(at.position);
        let load = t.travel * section.load;
        let viscous = t.viscous * at.velocity / t.travel;
        let torque = t.winding(&section) * at.acceleration + viscous + load + level;
        [load, section.compliance * torque]
    }

    fn cycle(&mut self, now: &Reference<T>, next: &Reference<T>) -> Correction<T> {
        let [_, level] = self.friction();
        let [load_now, wound_now] = self.tables(now, level);
        self.turn(next.velocity);
        // Not for ever: beyond, nothing changes, and a sum would stop to grow.
        self.state.since = (self.state.since + self.terms.period).min(T::of(1e6));
        let [friction, level] = self.friction();
        let [load, wound] = self.tables(next, level);
        let here = [load_now, self.homed.unwrap_or(wound_now)];
        let [home_load, home_wound] = *self.state.home.get_or_insert(here);
        let (t, own) = (&self.terms, &self.terms.own);
        let mut position = T::ZERO;
        if own.position > T::ZERO {
            let share = t.velocity_feedforward - own.velocity;
            position += share * now.velocity / (t.travel * own.position);
            if !own.from_motor {
                position += (wound - wound_now) / (t.period * own.position);
            }
        }
        if own.from_motor {
            position += t.travel * (wound_now - home_wound);
        }
        let torque = t.viscous * next.velocity / t.travel + load - home_load + friction;
        let effort = (t.effort_per_acceleration - own.acceleration) * next.acceleration
            + torque / t.torque_constant;
        Correction {
            position,
            command: effort,
        }
    }
}

impl<T: Exponential> Compensator<T> for DriveTermsFeedforward<T> {
    fn reset(&mut self) {
        self.state = State::at(self.carried);
    }

    fn correct(&mut self, sample: &Sample<T>) -> Correction<T> {
        let [now, next] = [&sample.reference, &sample.next_reference];
        let finite = |r: &Reference<T>| {
            r.position.is_finite() && r.velocity.is_finite() && r.acceleration.is_finite()
        };
        if finite(now) && finite(next) {
            let before = self.state;
            let made = self.cycle(now, next);
            if made.position.is_finite() && made.command.is_finite() {
                let limit = self.terms.effort_limit;
                self.state.last = Correction {
                    position: made.position,
                    command: made.command.max(-limit).min(limit),
                };
            } else {
                // Beyond the scalar's range: as if it had not come.
                self.state = before;
            }
        }
        self.state.last
    }
}
