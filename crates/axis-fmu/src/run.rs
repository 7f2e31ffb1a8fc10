//! A run between two communication steps.

use std::sync::Arc;

use axis_sim::{Axis, ClosedLoop, Cycle, LoopState, Start};
use compensator::{Compensator, Correction, Sample};
use trajectories::Setpoint;

use crate::error::UnitError;
use crate::outputs::is_force;

/// A run between two communication steps.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    closed_loop: Arc<ClosedLoop>,
    pub state: LoopState,
    /// What the drive did last.
    pub cycle: Cycle,
    pub cycles: u64,
}

/// What is added to the controller: the motor's input.
struct Offset(f64);

impl Compensator for Offset {
    fn reset(&mut self) {}

    fn correct(&mut self, _: &Sample) -> Correction {
        Correction {
            position: 0.0,
            command: self.0,
        }
    }
}

/// What is given to the loop in a cycle.
pub(crate) struct Given {
    pub reference: Setpoint,
    /// N·m at the motor, or N at a load that is one with it.
    pub motor: f64,
    /// N or N·m.
    pub load: f64,
}

impl Run {
    /// At rest at the reference. The drive shows what it would sample there.
    pub fn begin(axis: &Axis, given: &Given) -> Result<Self, UnitError> {
        let closed_loop = ClosedLoop::new(axis)?;
        let state = closed_loop.start(&Start::at(given.reference.position))?;
        let mut run = Self {
            closed_loop: Arc::new(closed_loop),
            state,
            cycle: Cycle::default(),
            cycles: 0,
        };
        let mut ahead = run.clone();
        ahead.cycle(given)?;
        run.cycle = ahead.cycle;
        Ok(run)
    }

    /// One control cycle.
    pub fn cycle(&mut self, given: &Given) -> Result<(), UnitError> {
        let axis = self.closed_loop.axis();
        let torque = match is_force(axis) {
            true => given.motor * axis.travel_per_radian(),
            false => given.motor,
        };
        let mut offset = Offset(torque / axis.torque_constant());
        let references = [&given.reference; 2];
        self.state.set_outer_load(given.load);
        self.cycle = (self.closed_loop).step(&mut self.state, references, &mut offset, |_| ())?;
        self.cycles += 1;
        Ok(())
    }
}
