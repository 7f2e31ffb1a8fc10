//! Control cycles between two communication steps of any length.

use std::fmt;

use crate::error::UnitError;
use crate::given::Inputs;
use crate::outputs::Output;
use crate::simulated::Simulation;

/// Share of the control period within which a point of time is that of a sample: more than
/// rounding makes of times that are added up.
pub(crate) const SAME_POINT: f64 = 1e-3;

/// A simulation in control cycles, each of which takes the inputs at its beginning and holds them.
pub(crate) trait Cycles: Clone + fmt::Debug + Send + Sync + 'static {
    /// The machine between two samples.
    type Between: Clone + fmt::Debug + Send + Sync;

    /// One cycle.
    fn cycle(&mut self, given: &Inputs) -> Result<(), UnitError>;

    /// Looks into the cycle that begins now, at `share` of it: what the drive samples is shown from then on, all else is left as it is.
    /// Where the machine is asked for (`exact`), it is the one there.
    fn look(&mut self, given: &Inputs, share: f64, exact: bool)
    -> Result<Self::Between, UnitError>;

    /// What an output shows, the machine where it is looked at between two samples.
    fn read(&self, between: Option<&Self::Between>, output: &Output) -> f64;
}

/// Such a simulation between two communication steps.
#[derive(Clone, Debug)]
pub(crate) struct Paced<C: Cycles> {
    cycles: C,
    /// Control cycles that are over.
    over: u64,
    /// Share of the control period that has passed of the next one; off by rounding.
    past: f64,
    /// Of a cycle that has begun: what its sample took, and the machine where it is looked at between
    /// samples.
    begun: Option<(Inputs, Option<C::Between>)>,
}

impl<C: Cycles> Paced<C> {
    /// At the start.
    pub fn new(cycles: C) -> Self {
        Self {
            cycles,
            over: 0,
            past: 0.0,
            begun: None,
        }
    }
}

impl<C: Cycles> Simulation for Paced<C> {
    fn periods(&self) -> f64 {
        self.over as f64 + self.past
    }

    /// Each control cycle takes the inputs at its beginning and holds them: one that began in an
    /// earlier step has those of then. In a cycle that is not over at the end the machine is shown as
    /// of its beginning, or as it is there where that is asked for (`exact`).
    fn run_on(&mut self, periods: f64, given: &Inputs, exact: bool) -> Result<(), UnitError> {
        let target = self.past + periods;
        let whole = (target + SAME_POINT).floor();
        for _ in 0..whole as u64 {
            match self.begun.take() {
                Some((begun, _)) => self.cycles.cycle(&begun)?,
                None => self.cycles.cycle(given)?,
            }
            self.over += 1;
        }
        self.past = target - whole;
        if self.past > SAME_POINT {
            let given = self.begun.take().map_or(*given, |(begun, _)| begun);
            let between = self.cycles.look(&given, self.past, exact)?;
            self.begun = Some((given, exact.then_some(between)));
        }
        Ok(())
    }

    fn read(&self, output: &Output) -> f64 {
        let between = self
            .begun
            .as_ref()
            .and_then(|(_, between)| between.as_ref());
        self.cycles.read(between, output)
    }

    fn copy(&self) -> Box<dyn Simulation> {
        Box::new(self.clone())
    }
}
