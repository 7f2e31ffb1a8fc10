//! The drive's controllers, once every 100 µs.

use std::collections::VecDeque;

use crate::parameters::Parameters;

/// What the drive reads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Table, m.
    pub position: f64,
    /// Motor, absolute, rad.
    pub angle: f64,
    /// Motor, rad/s.
    pub speed: f64,
    /// Currents d and q, A.
    pub current: [f64; 2],
}

/// What it asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// q current, A.
    pub current: f64,
    /// Voltages d and q, V.
    pub voltage: [f64; 2],
}

/// A sum that is held, and an output within a limit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proportional {
    pub p: f64,
    pub i: f64,
    pub held: f64,
}

impl Proportional {
    /// Output before any limit, and what the held sum would be.
    pub fn ask(&self, error: f64, period: f64) -> (f64, f64) {
        let held = self.held + self.i * error * period;
        (self.p * error + held, held)
    }

    /// Keeps the sum, unless the output is limited and the error presses further.
    pub fn keep(&mut self, asked: (f64, f64), given: f64, error: f64) {
        if asked.0 == given || error * (asked.0 - given) <= 0.0 {
            self.held = asked.1;
        }
    }
}

/// Position, speed and current controllers of Section 3.3, in a cascade:
///
/// ```text
/// ω_ref = P e + v_ref / r,   i_ref = PI(ω_ref − ω),   u = PI(i_ref − i)
/// ```
#[derive(Clone, Debug)]
pub struct Drive {
    period: f64,
    travel: f64,
    position_gain: f64,
    feedforward: f64,
    current_limit: f64,
    voltage_limit: f64,
    speed: Proportional,
    d: Proportional,
    q: Proportional,
    /// Current references that have not arrived yet, the oldest first.
    late: VecDeque<f64>,
}

impl Drive {
    /// The drive at rest, whose current reference comes `delay` periods late.
    pub fn new(p: &Parameters, delay: usize) -> Self {
        let controller = |p: f64, i: f64| Proportional { p, i, held: 0.0 };
        Self {
            period: p.period,
            travel: p.travel(),
            position_gain: p.position_gain,
            feedforward: p.velocity_feedforward,
            current_limit: p.current_limit,
            voltage_limit: p.dc_link / 3f64.sqrt(),
            speed: controller(p.speed_p, p.speed_i),
            d: controller(p.d_p, p.d_i),
            q: controller(p.q_p, p.q_i),
            late: VecDeque::from(vec![0.0; delay]),
        }
    }

    /// One period: reference position (m) and velocity (m/s), and what is read.
    pub fn step(&mut self, reference: [f64; 2], seen: &Reading) -> Command {
        self.step_pushed(reference, seen, 0.0)
    }

    /// The same with a current (A) added to what the speed controller asks for.
    pub fn step_pushed(&mut self, reference: [f64; 2], seen: &Reading, added: f64) -> Command {
        let error = reference[0] - seen.position;
        let speed = self.position_gain * error + self.feedforward * reference[1] / self.travel;
        let slow = speed - seen.speed;
        let mut asked = self.speed.ask(slow, self.period);
        asked.0 += added;
        let current = asked.0.clamp(-self.current_limit, self.current_limit);
        self.speed.keep(asked, current, slow);

        self.late.push_back(current);
        let arrived = self.late.pop_front().unwrap_or(current);
        let errors = [-seen.current[0], arrived - seen.current[1]];
        let asked = [
            self.d.ask(errors[0], self.period),
            self.q.ask(errors[1], self.period),
        ];
        let length = asked[0].0.hypot(asked[1].0);
        let by = (self.voltage_limit / length.max(f64::MIN_POSITIVE)).min(1.0);
        let voltage = [by * asked[0].0, by * asked[1].0];
        self.d.keep(asked[0], voltage[0], errors[0]);
        self.q.keep(asked[1], voltage[1], errors[1]);
        Command { current, voltage }
    }
}
