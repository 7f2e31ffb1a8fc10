//! A control kind with some of its values free.

use axis_sim::Axis;
use axis_sim::actuator::Surroundings;
use axis_sim::control::{Control, Situation};
use axis_sim::part::{Part, PartError, PartKind, Values};
use compensator::Correction;

use super::seen::Seen;

/// A value that is estimated.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    /// Its key; that of the delay is [`DELAY`].
    pub key: &'static str,
    /// Where the estimate begins, in SI units.
    pub start: f64,
    /// What a large change of it is.
    pub scale: f64,
    /// The least and the greatest value that is accepted.
    pub room: [f64; 2],
}

/// Key of the delay of the logged command behind the logged sensors, s. No control has it.
pub const DELAY: &str = "delay";

/// Share of an edge within which a value is at it: far inside the rounding of what is written.
const EDGE: f64 = 1e-6;

impl Free {
    /// The same between the limits of its key as well: an axis file takes nothing beyond them.
    pub fn within(self, [least, most]: [f64; 2]) -> Self {
        let start = self.start.clamp(least, most);
        let room = match start == self.start {
            true => [self.room[0].max(least), self.room[1].min(most)],
            false => [least, most],
        };
        Self {
            start,
            room,
            scale: self.scale.min(most - least),
            ..self
        }
    }

    /// Whether a value is at an edge of what is accepted: the logs ask for more than that. A value of 0
    /// if there cannot be less is nothing of it, and no edge.
    pub fn is_at_edge(&self, value: f64) -> bool {
        let near = |edge: &f64| *edge != 0.0 && (value - edge).abs() <= EDGE * edge.abs();
        self.room.iter().any(near)
    }

    /// The delay, on a control of this period (s).
    pub fn delay(period: f64) -> Self {
        Self {
            key: DELAY,
            start: 0.0,
            scale: period,
            room: [-10.0 * period, 50.0 * period],
        }
    }
}

/// A control kind with some of its values free.
#[derive(Clone, Debug)]
pub struct Law {
    pub kind: &'static PartKind<dyn Control>,
    /// All values; the free ones at their start.
    pub values: Values,
    /// The free ones, the delay last.
    pub free: Vec<Free>,
    /// Whether a constant of the command is free: an integrator's state at the start.
    pub has_constant: bool,
    /// Corner of the high pass of both commands, rad/s; 0 for none. Noise of the log comes
    /// through K_p + K_i/s into the command û: as white noise behind s/(s + K_i/K_p).
    pub washout: f64,
}

impl Law {
    /// The free values where they begin.
    pub fn start(&self) -> Vec<f64> {
        self.free.iter().map(|free| free.start).collect()
    }

    /// It without a high pass.
    pub fn plain(&self) -> Self {
        Self {
            washout: 0.0,
            ..self.clone()
        }
    }

    /// The control at these values of what is free.
    pub fn control(&self, at: &[f64]) -> Result<Part<dyn Control>, PartError> {
        let mut values = self.values.clone();
        for (free, value) in self.free.iter().zip(at) {
            if free.key != DELAY {
                values.set(free.key, *value);
            }
        }
        Part::new(self.kind, values)
    }

    /// What it commands in every control cycle of a log, shown what the log shows; none
    /// if the values make no control.
    pub fn command(&self, axis: &Axis, at: &[f64], seen: &Seen) -> Option<Vec<f64>> {
        let on = Surroundings {
            period: axis.period,
            travel_per_radian: axis.travel_per_radian(),
        };
        let mut controller = self.control(at).ok()?.start(&on).ok()?;
        controller.settle(*seen.command.first()?, seen.measured.first()?, seen.speed);
        let shown = seen.reference.iter().zip(&seen.measured).zip(&seen.added);
        let cycle = |((reference, measured), added): ((_, _), &f64)| {
            let correction = Correction {
                position: 0.0,
                command: *added,
            };
            let situation = Situation {
                reference,
                measured,
                correction: &correction,
                limit: axis.actuator.limit(),
            };
            controller.cycle(&situation).effort
        };
        let command: Vec<f64> = shown.map(cycle).collect();
        command.iter().all(|u| u.is_finite()).then_some(command)
    }
}
