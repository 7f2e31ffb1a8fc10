//! `pid`: one controller from the position error to the command.
//!
//! ```text
//! u = sat( K_P e + K_I ∫e + K_D ė ),   the derivative of the error through a low pass
//! ```

use std::sync::Arc;

use compensator::{Cascade, SignalPath};

use super::filter::Filter;
use super::output::Output;
use super::{CascadeGains, Control, Controller, Demand, Situation};
use crate::actuator::{Effort, Surroundings};
use crate::cycle::Measured;
use crate::part::units::{FREQUENCY, PID_DERIVATIVE, PID_INTEGRAL, PID_PROPORTIONAL};
use crate::part::{Known, PartError, PartKind, Role, Values, quantity};

pub(super) static KIND: PartKind<dyn Control> = PartKind {
    name: "pid",
    summary: "PID controller from the position error to the command",
    keys: &[
        quantity("proportional", &PID_PROPORTIONAL, 0.0, 1e12).role(Role::PositionGain),
        quantity("integral", &PID_INTEGRAL, 0.0, 1e15),
        quantity("derivative", &PID_DERIVATIVE, 0.0, 1e12).role(Role::SpeedGain),
        quantity("derivative_lowpass", &FREQUENCY, 1.0, 1e6),
    ],
    known: &[
        Known::exact("proportional"),
        Known::exact("integral"),
        Known::exact("derivative"),
    ],
    build: |v| {
        Ok(Arc::new(Pid {
            proportional: v.number("proportional")?,
            integral: v.number("integral")?,
            derivative: v.number("derivative")?,
            lowpass: v.number("derivative_lowpass")?,
            effort: Effort::of_gain(v.unit("proportional")),
        }))
    },
};

#[derive(Clone, Copy, Debug)]
struct Pid {
    proportional: f64,
    integral: f64,
    derivative: f64,
    lowpass: f64,
    effort: Option<Effort>,
}

impl Control for Pid {
    fn velocity_gain(&self, _: f64) -> Option<f64> {
        None
    }

    /// u = k_p (F ė/r + P e) + k_i P ∫e with k_p = r K_D, P = K_P/(r K_D), k_i = K_I/P, r the travel.
    fn pid(&self, travel: f64, period: f64) -> Option<Cascade> {
        if self.derivative <= 0.0 || self.proportional <= 0.0 {
            return None;
        }
        let position = self.proportional / (travel * self.derivative);
        let lowpass = Filter::low_pass(self.lowpass, period).ok()?;
        Some(Cascade {
            position,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: travel * self.derivative,
            speed_integral: self.integral / position,
            from_motor: false,
            signal_path: SignalPath {
                speed: Some(lowpass.law()),
                ..SignalPath::default()
            },
        })
    }

    fn retuned(&self, values: &Values, gains: &CascadeGains, travel: f64) -> Option<Values> {
        let mut values = values.clone();
        let derivative = gains.speed / travel;
        values.set("derivative", derivative);
        values.set("proportional", gains.position * derivative);
        values.set("integral", gains.speed_integral * gains.position / travel);
        Some(values)
    }

    fn effort(&self) -> Option<Effort> {
        self.effort
    }

    fn integrates(&self) -> bool {
        self.integral > 0.0
    }

    fn start(&self, on: &Surroundings) -> Result<Box<dyn Controller>, PartError> {
        Ok(Box::new(State {
            law: *self,
            on: *on,
            slope: Filter::low_pass(self.lowpass, on.period)?,
            before: None,
            sum: 0.0,
        }))
    }
}

#[derive(Clone, Copy, Debug)]
struct State {
    law: Pid,
    on: Surroundings,
    slope: Filter,
    /// Error of the cycle before.
    before: Option<f64>,
    /// K_I ∫e.
    sum: f64,
}

impl Controller for State {
    fn settle(&mut self, effort: f64, _: &Measured, _: f64) {
        self.before = None;
        self.slope.settle(0.0);
        self.sum = effort;
    }

    fn cycle(&mut self, s: &Situation<'_>) -> Demand {
        let (law, period) = (&self.law, self.on.period);
        let error = s.reference.position - s.measured.position + s.correction.position;
        let slope = (error - self.before.unwrap_or(error)) / period;
        let damping = law.derivative * self.slope.pass(slope);
        self.before = Some(error);
        let sum = self.sum + law.integral * period * error;
        let asked = law.proportional * error + sum + damping + s.correction.command;
        let limited = Output::default().pass(asked, s.limit);
        if !limited.presses(error) {
            self.sum = sum;
        }
        Demand {
            speed_ref: 0.0,
            effort: limited.effort,
            saturated: limited.saturated,
        }
    }

    fn copy(&self) -> Box<dyn Controller> {
        Box::new(*self)
    }
}
