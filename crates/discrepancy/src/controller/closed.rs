//! Closed-loop output error: the gains by replay of the reference, beside the machine's own
//! parameters inside their tolerances.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Effect, Scales};

use super::{ControllerError, ControllerEstimate, Gain, Logs};
use crate::answers::{LogSet, State};
use crate::estimate::fit::Fitter;

/// Gains as the closed loop has them.
#[derive(Clone, Debug)]
pub struct ClosedLoopGains {
    /// Gains; their intervals hold where the machine lacks nothing but what its tolerances
    /// allow.
    pub gains: Vec<Gain>,
    /// Time by which the command comes late to the machine, s, which the controller's
    /// equation cannot see: the effect `control-delay`. None on a machine that cannot have it.
    pub command_delay: Option<Gain>,
    /// Fall of minus twice the log-likelihood from the estimate that it began with.
    pub fall: f64,
}

/// By how much a gain may leave the estimate that is begun with, as a share.
const REACH: f64 = 0.5;

/// The gains of an estimate by closed-loop output error (Gautier, Janot, Vandanjon, IEEE
/// Trans. Control Syst. Technol. 21 (2013) 428–444, doi:10.1109/TCST.2012.2185697): position
/// and command of the replayed loop against the logs'. It rests on the machine's model,
/// which the estimate does not: where both disagree, the model lacks something.
///
/// # Errors
/// [`ControllerError::Replay`] if the loop does not run with these gains.
pub fn closed_loop(
    machine: &Axis,
    estimate: &ControllerEstimate,
    fit: &Logs,
) -> Result<ClosedLoopGains, ControllerError> {
    let mut axis = machine.clone();
    axis.control = estimate.control.clone();
    for gain in estimate.gains.iter().filter(|gain| gain.value != 0.0) {
        axis.tolerances.by_name.insert(gain.key, REACH);
    }
    let set = LogSet::new(fit.to_vec(), &axis)?;
    let fitter = Fitter {
        machine: &axis,
        set: &set,
    };
    let delay = Effect::named("control-delay").filter(|delay| delay.applies_to(&axis).is_ok());
    let mut state = State::initial(&axis);
    state.effects.extend(delay.map(|effect| ActiveEffect {
        effect,
        values: effect.null(&Scales::of(&axis)),
    }));
    let begun = fitter.at(state)?;
    let before = begun.deviance;
    let columns = fitter.known_columns(&begun);
    let (found, mut columns) = fitter.calibrated(begun, columns);
    columns.extend(fitter.effect_columns(&found, 0));
    let covariance = fitter.solve(&found, &columns).covariance;
    let at = |key, place: usize, value: f64, unit: f64| {
        let half = 1.96 * covariance[(place, place)].max(0.0).sqrt() * unit.abs();
        Gain {
            key,
            value,
            ci95: [value - half, value + half],
        }
    };
    let known = axis.known();
    let one = |gain: &Gain| {
        let place = known.iter().position(|name| *name == gain.key)?;
        let value = gain.value * (1.0 + found.state.shares[place]);
        Some(at(gain.key, place, value, gain.value))
    };
    let late = found
        .state
        .effects
        .first()
        .and_then(|late| late.values.first());
    Ok(ClosedLoopGains {
        gains: estimate.gains.iter().filter_map(one).collect(),
        command_delay: late.map(|time| at("control-delay", known.len(), *time, 1.0)),
        fall: before - found.deviance,
    })
}
