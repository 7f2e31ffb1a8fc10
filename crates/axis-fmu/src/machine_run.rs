//! A machine in control cycles, those of all its drives in lockstep.

use std::sync::Arc;

use axis_machine::{AxisGiven, CoupledMachine, MachineError, RunningMachine};
use axis_sim::Cycle;

use crate::error::UnitError;
use crate::given::{Given, Inputs};
use crate::outputs::{Output, Source};
use crate::paced::{Cycles, Paced};

/// A machine between two instants of all its drives.
#[derive(Clone, Debug)]
pub(crate) struct MachineRun<const D: usize> {
    machine: RunningMachine<D>,
    /// What each drive did last.
    cycles: Vec<Cycle>,
}

impl<const D: usize> MachineRun<D> {
    /// At rest at the references. Drives show what they would sample there.
    pub fn begin(
        machine: Arc<CoupledMachine<D>>,
        given: &Inputs,
    ) -> Result<Paced<Self>, UnitError> {
        let positions = std::array::from_fn(|axis| given[axis].reference.position);
        let machine = RunningMachine::begin(machine, positions).map_err(set_up)?;
        let mut run = Self {
            cycles: Vec::new(),
            machine,
        };
        // In half a cycle of the fastest drive each has begun its first.
        let drives = run.machine.machine().drives().iter();
        let fastest = drives.map(|drive| drive.closed_loop.axis().period);
        let half = 0.5 * fastest.fold(f64::INFINITY, f64::min);
        let share = half / run.machine.period();
        run.look(given, share, true)?;
        Ok(Paced::new(run))
    }

    fn given(&self, given: &Inputs) -> [AxisGiven; D] {
        let drives = self.machine.machine().drives();
        std::array::from_fn(|axis| {
            let first = drives.iter().find(|drive| drive.axis == axis);
            let torque = |given: &Given| {
                first.map_or(0.0, |drive| given.motor_torque(drive.closed_loop.axis()))
            };
            AxisGiven {
                reference: given[axis].reference,
                load: given[axis].load,
                torque: torque(&given[axis]),
            }
        })
    }
}

impl<const D: usize> Cycles for MachineRun<D> {
    type Between = RunningMachine<D>;

    fn cycle(&mut self, given: &Inputs) -> Result<(), UnitError> {
        let given = self.given(given);
        self.machine.advance(&given).map_err(stopped)?;
        self.cycles.clear();
        self.cycles.extend(self.machine.cycles());
        Ok(())
    }

    fn look(
        &mut self,
        given: &Inputs,
        share: f64,
        _: bool,
    ) -> Result<RunningMachine<D>, UnitError> {
        let given = self.given(given);
        let there = self.machine.within(&given, share).map_err(stopped)?;
        self.cycles = there.cycles().to_vec();
        Ok(there)
    }

    fn read(&self, between: Option<&RunningMachine<D>>, output: &Output) -> f64 {
        let shown = between.unwrap_or(&self.machine);
        if let Source::Tool = output.source {
            return shown.tool().get(output.of).copied().unwrap_or(f64::NAN);
        }
        let drive = shown.loops().get(output.of).zip(self.cycles.get(output.of));
        drive.map_or(f64::NAN, |(state, cycle)| {
            output.source.of_loop(state, cycle)
        })
    }
}

fn stopped(error: MachineError) -> UnitError {
    UnitError::MachineStopped(Box::new(error))
}

fn set_up(error: MachineError) -> UnitError {
    UnitError::Machine(Box::new(error))
}
