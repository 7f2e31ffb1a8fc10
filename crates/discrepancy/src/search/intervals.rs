//! How well a search knows what it found.

use axis_sim::ReplayError;
use nalgebra::DMatrix;

use super::state::Search;
use super::types::Found;
use crate::fit::{Columns, Fit};
use crate::interval::Spread;
use crate::noise::{drawn, spreads};
use crate::spectrum::Amplitudes;

/// How well the parameters of a fit are known.
pub(super) struct Intervals {
    pub(super) columns: Columns,
    covariance: DMatrix<f64>,
    pub(super) noise: Vec<Amplitudes>,
    spreads: Vec<Spread>,
}

impl Search<'_> {
    /// Derivatives, covariance and spread of all parameters at the end.
    pub(super) fn intervals(&self) -> Result<Intervals, ReplayError> {
        let columns = self.own_columns();
        let fitter = self.fitter();
        let covariance = fitter.solve(&self.fit, &columns).covariance;
        let noise = drawn(&fitter, &self.fit)?;
        Ok(Intervals {
            spreads: spreads(&fitter, &self.fit, &columns, &covariance, &noise),
            columns,
            covariance,
            noise,
        })
    }

    pub(super) fn finish(self, base: Fit, intervals: Intervals) -> Found {
        let Intervals {
            columns,
            covariance,
            spreads,
            noise,
        } = intervals;
        Found {
            spreads,
            base,
            columns,
            covariance,
            noise,
            fit: self.fit,
            named: self.named,
            replaced: self.replaced,
            refused: self.refused,
            leftover: self.leftover,
            library: self.library,
            fit_logs: self.fit_logs,
            check_logs: self.check_logs,
        }
    }
}
