//! What a unit simulates, by its kind.

use axis_sim::Axis;

use crate::error::UnitError;
use crate::kind::UnitKind;
use crate::outputs::Source;
use crate::plant::PlantRun;
use crate::run::{Corrected, Given, Run};

/// A simulation between two communication steps.
#[derive(Clone, Debug)]
pub(crate) enum Simulated {
    ClosedLoop(Box<Run>),
    Plant(PlantRun),
}

impl Simulated {
    /// At rest where the inputs say.
    pub fn begin(
        kind: UnitKind,
        axis: &Axis,
        given: &Given,
        corrected: Corrected<'_>,
    ) -> Result<Self, UnitError> {
        Ok(match kind {
            UnitKind::ClosedLoop | UnitKind::Compensated => {
                Self::ClosedLoop(Box::new(Run::begin(axis, given, corrected)?))
            }
            UnitKind::Plant => Self::Plant(PlantRun::begin(axis, given)?),
        })
    }

    /// Control periods since the start.
    pub fn periods(&self) -> f64 {
        match self {
            Self::ClosedLoop(run) => run.cycles as f64 + run.past,
            Self::Plant(run) => run.periods(),
        }
    }

    /// Runs on by `periods` control periods; `exact` is of a closed loop alone.
    pub fn run_on(&mut self, periods: f64, given: &Given, exact: bool) -> Result<(), UnitError> {
        match self {
            Self::ClosedLoop(run) => run.run_on(periods, given, exact),
            Self::Plant(run) => run.run_on(periods, given),
        }
    }

    /// What an output shows; no number if there is no drive that it could show.
    pub fn read(&self, source: Source) -> f64 {
        match (self, source) {
            (Self::ClosedLoop(run), Source::Machine(read, times)) => {
                times * read(run.shown().plant().seen())
            }
            (Self::ClosedLoop(run), Source::Current(read)) => read(run.shown()),
            (Self::ClosedLoop(run), Source::Drive(read)) => read(&run.cycle),
            (Self::Plant(run), Source::Machine(read, times)) => times * read(run.seen()),
            (Self::Plant(_), Source::Current(_) | Source::Drive(_)) => f64::NAN,
        }
    }
}
