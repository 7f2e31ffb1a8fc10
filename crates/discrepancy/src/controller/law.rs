//! A control kind with some of its values free.

use axis_sim::Axis;
use axis_sim::actuator::Surroundings;
use axis_sim::control::{Control, Situation};
use axis_sim::part::{Part, PartError, PartKind, Values};
use compensator::Correction;

use super::seen::Seen;

/// A control kind with some of its values free.
#[derive(Clone, Debug)]
pub struct Law {
    pub kind: &'static PartKind<dyn Control>,
    /// All values; the free ones at their start.
    pub values: Values,
    /// Keys of the free ones, none below 0.
    pub free: Vec<&'static str>,
    /// Whether a constant of the command is free: an integrator's state at the start.
    pub has_constant: bool,
}

impl Law {
    /// The control at these values of what is free; more values than that are passed over.
    pub fn control(&self, at: &[f64]) -> Result<Part<dyn Control>, PartError> {
        let mut values = self.values.clone();
        for (key, value) in self.free.iter().zip(at) {
            values.set(key, *value);
        }
        Part::new(self.kind, values)
    }

    /// What it commands in every control cycle of a log, shown what the log shows; none
    /// where the values make no control.
    pub fn command(&self, axis: &Axis, at: &[f64], seen: &Seen) -> Option<Vec<f64>> {
        let on = Surroundings {
            period: axis.period,
            travel_per_radian: axis.travel_per_radian(),
            effort_limit: axis.actuator.limit(),
        };
        let mut controller = self.control(at).ok()?.start(&on).ok()?;
        controller.settle(*seen.command.first()?, seen.measured.first()?, seen.speed);
        let cycle = |((reference, measured), added)| {
            let correction = Correction {
                position: 0.0,
                iq: added,
            };
            let demand = controller.cycle(&Situation {
                reference,
                measured,
                correction: &correction,
            });
            demand.effort
        };
        let shown = seen
            .reference
            .iter()
            .zip(&seen.measured)
            .zip(seen.added.iter().copied());
        let command: Vec<f64> = shown.map(cycle).collect();
        command.iter().all(|u| u.is_finite()).then_some(command)
    }
}
