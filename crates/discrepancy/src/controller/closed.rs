//! Closed-loop output error: the gains by replay of the reference, beside the machine's own
//! parameters inside their tolerances.

use axis_sim::Axis;

use super::{ControllerError, Estimate, Gain, Logs};
use crate::fit::Fitter;
use crate::model::{LogSet, State};

/// Gains as the closed loop has them.
#[derive(Clone, Debug)]
pub struct ClosedLoopGains {
    /// Gains; their intervals hold where the machine lacks nothing but what its tolerances
    /// allow.
    pub gains: Vec<Gain>,
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
/// [`ControllerError::Replay`] where the loop does not run with these gains.
pub fn closed_loop(
    machine: &Axis,
    estimate: &Estimate,
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
    let begun = fitter.at(State::initial(&axis))?;
    let before = begun.deviance;
    let columns = fitter.known_columns(&begun);
    let (found, columns) = fitter.calibrated(begun, columns);
    let covariance = fitter.solve(&found, &columns).covariance;
    let one = |gain: &Gain| {
        let at = axis.known().iter().position(|name| *name == gain.key)?;
        let half = 1.96 * covariance[(at, at)].max(0.0).sqrt() * gain.value;
        let value = gain.value * (1.0 + found.state.shares[at]);
        Some(Gain {
            key: gain.key,
            value,
            ci95: [value - half, value + half],
        })
    };
    Ok(ClosedLoopGains {
        gains: estimate.gains.iter().filter_map(one).collect(),
        fall: before - found.deviance,
    })
}
