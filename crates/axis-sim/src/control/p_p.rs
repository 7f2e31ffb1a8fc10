//! `p-p`: proportional position and speed controllers, the speed from differences
//! of the position, as the EMPS benchmark has it.
//!
//! ```text
//! u_k  = sat( K_v (K_p (q_ref − q + Δ) − dq) + u_added )
//! dq_k = (f_k − f_{k−1}) / T,   f_k = (q_k + q_{k−1}) / 2
//! ```

use std::sync::Arc;

use compensator::{Cascade, SignalPath};

use super::output::Output;
use super::{CascadeGains, Control, Controller, Demand, Situation};
use crate::actuator::{Effort, Surroundings};
use crate::cycle::Measured;
use crate::part::units::{SPEED_GAIN, VELOCITY_GAIN};
use crate::part::{Known, PartError, PartKind, Role, Values, quantity};

pub(super) static KIND: PartKind<dyn Control> = PartKind {
    name: "p-p",
    summary: "P position and P speed controller, speed from differences of the position",
    keys: &[
        quantity("position_gain", &VELOCITY_GAIN, 1e-3, 1e6).role(Role::PositionGain),
        quantity("speed_gain", &SPEED_GAIN, 1e-6, 1e9).role(Role::SpeedGain),
    ],
    known: &[Known::exact("position_gain"), Known::exact("speed_gain")],
    build: |v| {
        Ok(Arc::new(PP {
            position: v.number("position_gain")?,
            speed: v.number("speed_gain")?,
            effort: Effort::of_gain(v.unit("speed_gain")),
        }))
    },
};

#[derive(Clone, Copy, Debug)]
struct PP {
    /// K_p, 1/s.
    position: f64,
    /// K_v, effort per speed of the load.
    speed: f64,
    effort: Option<Effort>,
}

impl Control for PP {
    fn velocity_gain(&self, _: f64) -> Option<f64> {
        Some(self.position)
    }

    fn cascade(&self, travel: f64, _: f64) -> Option<Cascade> {
        Some(Cascade {
            position: self.position / travel,
            velocity_feedforward: 0.0,
            acceleration_feedforward: 0.0,
            speed: self.speed * travel,
            speed_integral: 0.0,
            from_motor: false,
            signal_path: SignalPath {
                speed_of_position: true,
                ..SignalPath::default()
            },
        })
    }

    fn retuned(&self, values: &Values, gains: &CascadeGains, travel: f64) -> Option<Values> {
        let mut values = values.clone();
        values.set("position_gain", gains.position);
        values.set("speed_gain", gains.speed / travel);
        Some(values)
    }

    fn starts_in_motion(&self) -> bool {
        true
    }

    fn effort(&self) -> Option<Effort> {
        self.effort
    }

    fn start(&self, on: &Surroundings) -> Result<Box<dyn Controller>, PartError> {
        Ok(Box::new(State {
            law: *self,
            on: *on,
            before: [0.0; 2],
        }))
    }
}

#[derive(Clone, Copy, Debug)]
struct State {
    law: PP,
    on: Surroundings,
    /// Positions one and two cycles ago.
    before: [f64; 2],
}

impl Controller for State {
    /// As if the speed had been the same before.
    fn settle(&mut self, _: f64, measured: &Measured, speed: f64) {
        let travelled = speed * self.on.period;
        self.before = [1.0, 2.0].map(|cycles| measured.position - cycles * travelled);
    }

    fn cycle(&mut self, s: &Situation<'_>) -> Demand {
        let x = s.measured.position;
        let filtered = [
            0.5 * (x + self.before[0]),
            0.5 * (self.before[0] + self.before[1]),
        ];
        let seen_speed = (filtered[0] - filtered[1]) / self.on.period;
        let wanted = self.law.position * (s.reference.position - x + s.correction.position);
        let asked = self.law.speed * (wanted - seen_speed) + s.correction.command;
        let limited = Output::default().pass(asked, s.limit);
        self.before = [x, self.before[0]];
        Demand {
            speed_ref: wanted / self.on.travel_per_radian,
            effort: limited.effort,
            saturated: limited.saturated,
        }
    }

    fn copy(&self) -> Box<dyn Controller> {
        Box::new(*self)
    }
}
