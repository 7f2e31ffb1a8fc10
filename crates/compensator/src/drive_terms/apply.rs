//! The terms at work, as a drive applies them.

use lugre::Exponential;

use super::DriveTerms;
use crate::{Compensator, Correction, Reference, Sample};

/// Applies [`DriveTerms`] and nothing else, from the reference alone.
///
/// At the start the drive's integrator holds the axis' own loads there: only how they
/// change from then on is added.
#[derive(Clone, Copy, Debug)]
pub struct DriveTermsFeedforward<T = f64> {
    terms: DriveTerms<T>,
    /// Friction level that a reset begins with, N·m.
    carried: T,
    state: State<T>,
}

#[derive(Clone, Copy, Debug)]
struct State<T> {
    /// What was held at the start: load torque (N·m) and wind-up (rad).
    home: Option<[T; 2]>,
    /// Direction, −1, 0 or 1, and the levels before and after it changed last.
    direction: T,
    before: T,
    after: T,
    /// Since then, s.
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
    /// With friction relaxed.
    #[must_use]
    pub fn new(terms: DriveTerms<T>) -> Self {
        Self {
            terms,
            carried: T::ZERO,
            state: State::at(T::ZERO),
        }
    }

    /// The same drive before its next motion: the friction level is kept.
    #[must_use]
    pub fn carried_on(mut self) -> Self {
        self.carried = self.state.after;
        self.reset();
        self
    }

    /// The terms.
    pub fn terms(&self) -> &DriveTerms<T> {
        &self.terms
    }

    /// Torque of friction's level with its pulse, and the level as the wind-up takes it.
    fn friction(&mut self, next: &Reference<T>) -> [T; 2] {
        let (t, s) = (&self.terms, &mut self.state);
        if next.velocity != T::ZERO {
            let direction = T::ONE.copysign(next.velocity);
            if direction != s.direction {
                // A pulse that is not over is cut short: the level counts from then on.
                s.before = if s.since < t.pulse.delay { s.before } else { s.after };
                s.direction = direction;
                s.after = direction * t.coulomb;
                s.since = T::ZERO;
            }
        }
        let since = s.since - t.pulse.delay;
        s.since = (s.since + t.period).min(T::of(1e6));
        if since < T::ZERO {
            return [s.before, s.before];
        }
        let change = s.after - s.before;
        let left = if t.pulse.decay > T::ZERO {
            (-since / t.pulse.decay).exp()
        } else {
            T::ZERO
        };
        let height = if t.coulomb > T::ZERO {
            t.pulse.amplitude / t.coulomb
        } else {
            T::ZERO
        };
        [s.after + height * change * left, s.after - change * left]
    }

    /// What the table makes of a set point: load torque (N·m), wind-up (rad) but for
    /// friction's level, and compliance.
    fn tables(&self, at: &Reference<T>) -> [T; 3] {
        let t = &self.terms;
        let section = t.along.at(at.position);
        let load = t.travel * section.load;
        let viscous = t.viscous * at.velocity / t.travel;
        let torque = t.winding(&section) * at.acceleration + viscous + load;
        [load, section.compliance * torque, section.compliance]
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
        // What no set point says is not acted on.
        if !(finite(now) && finite(next)) {
            return self.state.last;
        }
        let level_before = self.level();
        let [friction, level] = self.friction(next);
        let t = self.terms;
        let [load_now, wind_now, compliance_now] = self.tables(now);
        let [load, wind, compliance] = self.tables(next);
        let wind_now = wind_now + compliance_now * level_before;
        let wind = wind + compliance * level;
        let [home_load, home_wind] = *self.state.home.get_or_insert([load_now, wind_now]);
        let mut position = T::ZERO;
        let own = &t.own;
        if own.position > T::ZERO {
            let fed = (t.velocity_feedforward - own.velocity) * now.velocity / t.travel;
            position += fed / own.position;
            if !own.from_motor { position += (wind - wind_now) / (t.period * own.position); }
        }
        if own.from_motor {
            position += t.travel * (wind_now - home_wind);
        }
        let torque = t.viscous * next.velocity / t.travel + load - home_load + friction;
        let effort = (t.effort_per_acceleration - own.acceleration) * next.acceleration
            + torque / t.torque_constant;
        let iq = effort.max(-t.effort_limit).min(t.effort_limit);
        if position.is_finite() && effort.is_finite() {
            self.state.last = Correction { position, iq };
        }
        self.state.last
    }
}

impl<T: Exponential> DriveTermsFeedforward<T> {
    /// The level as the wind-up took it last.
    fn level(&self) -> T {
        let (t, s) = (&self.terms, &self.state);
        let since = s.since - t.period - t.pulse.delay;
        if since < T::ZERO {
            return s.before;
        }
        let left = if t.pulse.decay > T::ZERO {
            (-since / t.pulse.decay).exp()
        } else {
            T::ZERO
        };
        s.after - (s.after - s.before) * left
    }
}
