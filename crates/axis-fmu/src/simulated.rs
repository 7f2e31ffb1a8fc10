//! What a unit simulates, whatever its kind.

use std::fmt;

use crate::error::UnitError;
use crate::given::Inputs;
use crate::outputs::Output;

/// A simulation between two communication steps.
pub(crate) trait Simulation: fmt::Debug + Send + Sync {
    /// Control periods since the start.
    fn periods(&self) -> f64;

    /// Runs on by `periods` control periods, not necessarily a whole number; `exact` says whether outputs between two samples show
    /// the machine as it is there.
    fn run_on(&mut self, periods: f64, given: &Inputs, exact: bool) -> Result<(), UnitError>;

    /// What an output shows; no number if there is nothing that it could show.
    fn read(&self, output: &Output) -> f64;

    /// The same once more.
    fn copy(&self) -> Box<dyn Simulation>;
}

/// One that can be copied.
#[derive(Debug)]
pub(crate) struct Simulated(pub Box<dyn Simulation>);

impl Clone for Simulated {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}
