//! What an effect costs on the motion of the check logs: tracking error, force, current.

use axis_sim::effects::Measure;
use axis_sim::{Axis, ReplayError, needed_position, position_shown, reference_in};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::units::channel_unit;
use crate::answers::Rest;
use crate::answers::effort::efforts;
use crate::answers::{ANGLE, LogSet, Prepared, State};

/// Root mean square and greatest size of a signal, in its SI unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Size {
    /// Root mean square.
    pub rms: f64,
    /// Greatest magnitude.
    pub peak: f64,
}

impl Size {
    /// Of these values; 0 of none.
    pub fn of(values: &[f64]) -> Self {
        let squares: f64 = values.iter().map(|v| v * v).sum();
        Self {
            rms: (squares / values.len().max(1) as f64).sqrt(),
            peak: values.iter().fold(0.0, |most, v| most.max(v.abs())),
        }
    }
}

/// Tracking error, reference minus position, on check motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrackingCost {
    /// SI unit: m or rad.
    pub unit: String,
    /// As the logs show it.
    pub measured: Size,
    /// Of the model with what was named.
    pub with: Size,
    /// Of the same model without it.
    pub without: Size,
}

/// What the drive gives because of an effect, on check motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EffortCost {
    /// Channel of logs that shows what the drive gives.
    pub channel: String,
    /// SI unit of the channel.
    pub unit: String,
    /// All that the drive gives, as the logs show it.
    pub measured: Size,
    /// Model with the effect minus model without it.
    pub taken: Size,
    /// Unit of the force on the load: N, or N*m of a load that turns.
    pub force_unit: String,
    /// `taken` as a force on the load: times torque constant over travel per radian.
    pub force: Size,
}

/// What an effect, or all of them together, costs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    /// `None` if no position is compared, as in a torque balance.
    pub tracking: Option<TrackingCost>,
    /// `None` if no channel shows what the drive gives.
    pub effort: Option<EffortCost>,
}

/// Place of the channel that shows what the drive gives, and force on the load per unit of
/// it: N or N·m.
pub(super) fn effort(machine: &Axis, set: &LogSet) -> Option<(usize, f64)> {
    let place = |name: &str| set.channels.iter().position(|channel| *channel == name);
    let at = efforts().find_map(place)?;
    let per_torque = 1.0 / machine.travel_per_radian();
    let force = match set.channels[at] {
        "torque_n_m" => per_torque,
        "force_n" => 1.0,
        _ => machine.torque_constant() * per_torque,
    };
    Some((at, force))
}

/// The cost of what makes the difference between two residuals of the check logs.
pub(super) fn cost(machine: &Axis, set: &LogSet, without: &Rest, with: &Rest) -> Cost {
    Cost {
        tracking: tracking(machine, set, without, with),
        effort: effort(machine, set).map(|at| effort_cost(machine, set, at, without, with)),
    }
}

/// What all that was named costs together; `each` is what each costs alone.
pub(super) fn whole_cost(
    machine: &Axis,
    set: &LogSet,
    full: &State,
    after: &Rest,
    each: &[(String, Cost)],
) -> Result<Cost, ReplayError> {
    match each {
        [] => Ok(cost(machine, set, after, after)),
        [(_, only)] if full.effects.len() == 1 => Ok(only.clone()),
        _ => {
            let bare = State {
                shares: full.shares.clone(),
                effects: Vec::new(),
            };
            let without = set.rest(&set.simulate(machine, &bare)?);
            Ok(cost(machine, set, &without, after))
        }
    }
}

fn tracking(machine: &Axis, set: &LogSet, without: &Rest, with: &Rest) -> Option<TrackingCost> {
    let place = |name: &str| set.channels.iter().position(|channel| *channel == name);
    // Without a sensor at the load the motor's angle shows where that is.
    let own = place(machine.position_channel()).map(|at| (at, 1.0));
    let motor = || place(ANGLE).filter(|_| needed_position(machine).is_none());
    let (at, lever) = own.or_else(|| Some((motor()?, machine.travel_per_radian())))?;
    let name = set.channels[at];
    // The model's position is the measured one less the residual.
    let errors = |rest: Option<&Rest>| -> Option<Vec<f64>> {
        let mut all = Vec::new();
        for (l, log) in set.logs.iter().enumerate() {
            let reference = reference_in(&log.log).ok()?;
            let position = position_shown(&log.log, machine).ok()?;
            let shown = shown(log, &[name, machine.reference_channel()]);
            let error = |k: usize| {
                let left = rest.map_or(0.0, |rest| lever * rest[l][at][k]);
                reference[k] - position[k] + left
            };
            all.extend((0..log.measured[at].len()).filter(|&k| shown[k]).map(error));
        }
        Some(all)
    };
    Some(TrackingCost {
        unit: Measure::Displacement.unit(machine.freedom()).to_owned(),
        measured: Size::of(&errors(None)?),
        with: Size::of(&errors(Some(with))?),
        without: Size::of(&errors(Some(without))?),
    })
}

fn effort_cost(
    machine: &Axis,
    set: &LogSet,
    (at, force): (usize, f64),
    without: &Rest,
    with: &Rest,
) -> EffortCost {
    let (mut measured, mut taken) = (Vec::new(), Vec::new());
    for (l, log) in set.logs.iter().enumerate() {
        let shown = shown(log, &[set.channels[at]]);
        for k in (0..log.measured[at].len()).filter(|&k| shown[k]) {
            measured.push(log.measured[at][k]);
            taken.push(without[l][at][k] - with[l][at][k]);
        }
    }
    let taken = Size::of(&taken);
    EffortCost {
        channel: set.channels[at].to_owned(),
        unit: channel_unit(set.channels[at]).to_owned(),
        measured: Size::of(&measured),
        taken,
        force_unit: Measure::Force.unit(machine.freedom()).to_owned(),
        force: Size {
            rms: force.abs() * taken.rms,
            peak: force.abs() * taken.peak,
        },
    }
}

/// Whether each sample of a log was measured in all of these channels.
fn shown(log: &Prepared, channels: &[&str]) -> Vec<bool> {
    let mut shown = vec![true; log.log.len()];
    for channel in channels {
        for instants in log.log.missing(channel) {
            shown[instants.clone()].fill(false);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::Size;

    #[test]
    fn a_sine_has_a_peak_of_root_two_of_its_root_mean_square() {
        let turn = std::f64::consts::TAU / 1000.0;
        let sine: Vec<f64> = (0..1000)
            .map(|k| 3.0 * (turn * f64::from(k)).sin())
            .collect();
        let size = Size::of(&sine);
        assert!((size.peak / size.rms - std::f64::consts::SQRT_2).abs() < 1e-5);
        assert_eq!(Size::of(&[]), Size::default());
    }
}
