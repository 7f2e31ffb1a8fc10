//! Fitting: known parameters inside their tolerance, effects free.

use axis_sim::{Axis, ReplayError, Trace};

use crate::answers::{LogSet, State};
use crate::estimate::known::known_deviations;
use crate::spectrum::Amplitudes;

/// A fitted model.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Parameters.
    pub state: State,
    /// Its simulations of the logs.
    pub traces: Vec<Trace>,
    /// What they leave.
    pub rest: Amplitudes,
    /// D of the residual, and the known parameters' departures.
    pub deviance: f64,
}

impl Fit {
    /// The one with the lower D.
    pub(crate) fn better(self, other: Self) -> Self {
        if other.deviance < self.deviance {
            other
        } else {
            self
        }
    }
}

/// The fit of a set of logs by a machine.
pub struct Fitter<'a> {
    /// Machine as its file says.
    pub machine: &'a Axis,
    /// Logs.
    pub set: &'a LogSet,
}

impl Fitter<'_> {
    /// The model at a state.
    ///
    /// # Errors
    /// [`ReplayError`] if a simulation does not run.
    pub fn at(&self, state: State) -> Result<Fit, ReplayError> {
        let traces = self.set.simulate(self.machine, &state)?;
        let rest = self.set.amplitudes(&self.set.rest(&traces));
        let deviance = self.set.layout.deviance(&rest) + self.departure(&state);
        Ok(Fit {
            state,
            traces,
            rest,
            deviance,
        })
    }

    /// What the known parameters' departures count in D.
    pub(crate) fn departure(&self, state: &State) -> f64 {
        let pairs = state.shares.iter().zip(known_deviations(self.machine));
        pairs.map(|(s, deviation)| (s / deviation).powi(2)).sum()
    }
}
