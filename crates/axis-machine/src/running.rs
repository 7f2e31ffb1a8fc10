//! A machine whose references come from outside, period by period.

use std::collections::VecDeque;
use std::sync::Arc;

use axis_sim::{Cycle, LoopState, Start};
use compensator::{Compensator, Correction, Sample};
use trajectories::Setpoint;

use crate::error::MachineError;
use crate::machine::CoupledMachine;
use crate::motion::HALF_WINDOW;
use crate::run::MachineState;

/// What an axis is given for a period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisGiven {
    /// Its reference, held over the period; of a beam that of both drives, from where each begins.
    pub reference: Setpoint,
    /// Force on its load from outside, N, positive against positive motion; of a beam half of it on each end.
    pub load: f64,
    /// What is added to the torque that its controller asks of the motor, N·m; of a beam at both of its drives.
    pub torque: f64,
}

/// Share of a control period within which a point of time is that of a sample: more than rounding makes of times that are added up.
const SAME_POINT: f64 = 1e-3;

/// A constant that is added to the controller's command, in the actuator's unit.
struct Added(f64);

impl Compensator for Added {
    fn reset(&mut self) {}

    fn correct(&mut self, _: &Sample) -> Correction {
        Correction {
            position: 0.0,
            command: self.0,
        }
    }
}

/// A machine that runs period by period under references and forces that somebody else knows: another program, a controller.
///
/// A period is the shortest time of which all control periods are whole parts. Couplings, bases and beams act as in
/// [`CoupledMachine::run`], but for the cross-talk: as what comes is not known, its acceleration is the mean over the last 10 ms, and not
/// over 5 ms to both sides, so that it comes 5 ms late.
#[derive(Clone, Debug)]
pub struct RunningMachine<const D: usize> {
    machine: Arc<CoupledMachine<D>>,
    state: MachineState,
    /// Where each axis began, m: there a squareness moves nothing.
    zeros: [f64; D],
    /// What each drive begins at beside its axis, m.
    offsets: Vec<f64>,
    speeds: VecDeque<[f64; D]>,
    cycles: Vec<Cycle>,
    periods: u64,
    /// Share of the last period that has passed: 1, but between two instants.
    share: f64,
}

impl<const D: usize> RunningMachine<D> {
    /// At standstill where the axes are given (m).
    ///
    /// # Errors
    /// [`MachineError::Setup`] if a load cannot be there.
    pub fn begin(
        machine: Arc<CoupledMachine<D>>,
        positions: [f64; D],
    ) -> Result<Self, MachineError> {
        let (mut loops, mut offsets) = (Vec::new(), Vec::new());
        for (d, drive) in machine.drives().iter().enumerate() {
            // The second end of a beam may have another zero than the first.
            let start = |d: usize| machine.drives()[d].closed_loop.axis().stroke.start;
            let first = machine
                .drives()
                .iter()
                .position(|one| one.axis == drive.axis);
            let offset = start(d) - start(first.unwrap_or(d));
            let at = Start::at(positions[drive.axis] + offset);
            let settled = drive.closed_loop.start(&at);
            loops.push(settled.map_err(|source| MachineError::Setup {
                axis: drive.axis + 1,
                source,
            })?);
            offsets.push(offset);
        }
        let state = MachineState::settled::<D>(loops);
        let count = 2 * ((HALF_WINDOW / machine.period).round() as usize).max(1) + 1;
        Ok(Self {
            zeros: positions,
            offsets,
            speeds: VecDeque::from(vec![[0.0; D]; count]),
            cycles: vec![Cycle::default(); machine.drives().len()],
            periods: 0,
            share: 1.0,
            machine,
            state,
        })
    }

    /// Runs on by one period.
    ///
    /// # Errors
    /// [`MachineError::Stopped`] if a drive stops.
    pub fn advance(&mut self, given: &[AxisGiven; D]) -> Result<(), MachineError> {
        self.go_on(given, 1.0)?;
        self.periods += 1;
        Ok(())
    }

    /// The machine in the period that begins now, after `share` of it (above 0 and up to 1, or the nearest to that): each drive has begun the control cycles
    /// that begin before. The run goes on from `self`, not from the result, which may be between two samples.
    ///
    /// # Errors
    /// As [`RunningMachine::advance`].
    pub fn within(&self, given: &[AxisGiven; D], share: f64) -> Result<Self, MachineError> {
        let share = share.clamp(f64::EPSILON, 1.0);
        let mut there = self.clone();
        there.share = share;
        there.go_on(given, share)?;
        Ok(there)
    }

    fn go_on(&mut self, given: &[AxisGiven; D], share: f64) -> Result<(), MachineError> {
        let machine = self.machine.clone();
        let before = machine.speeds(&self.state);
        let forces = machine.forces(&self.state);
        for (d, drive) in machine.drives().iter().enumerate() {
            let given = &given[drive.axis];
            let ends = machine.drives().iter().filter(|one| one.axis == drive.axis);
            let load = given.load / ends.count() as f64;
            let state = &mut self.state.loops[d];
            state.set_outer_load(load + forces[d].unwrap_or(0.0));
            let reference = Setpoint {
                position: given.reference.position + self.offsets[d],
                ..given.reference
            };
            let references = [&reference; 2];
            let mut added = Added(given.torque / drive.closed_loop.axis().torque_constant());
            let stopped = |why| MachineError::Stopped {
                axis: drive.axis + 1,
                why,
            };
            let cycles = share * drive.parts as f64;
            let whole = (cycles + SAME_POINT).floor();
            for _ in 0..whole as u64 {
                let stepped = (drive.closed_loop).step(state, references, &mut added, |_| ());
                self.cycles[d] = stepped.map_err(stopped)?;
            }
            let part = cycles - whole;
            if part > SAME_POINT {
                let within = (drive.closed_loop).within(state, references, &mut added, part);
                (*state, self.cycles[d]) = within.map_err(stopped)?;
            }
        }
        machine.move_bases(&mut self.state, &before, share * machine.period);
        self.speeds.pop_front();
        self.speeds.push_back(machine.speeds(&self.state));
        Ok(())
    }

    /// Time between two calls of [`RunningMachine::advance`], s.
    pub fn period(&self) -> f64 {
        self.machine.period
    }

    /// Periods that are over.
    pub fn periods(&self) -> u64 {
        self.periods
    }

    /// The machine.
    pub fn machine(&self) -> &CoupledMachine<D> {
        &self.machine
    }

    /// Position of each axis' load as its scale shows it, m; of a beam that at the tool.
    pub fn positions(&self) -> [f64; D] {
        let seen = |d: usize| self.state.loops[d].plant().seen().position - self.offsets[d];
        self.machine.of_coordinates(seen)
    }

    /// Speed of each axis' load, m/s.
    pub fn speeds(&self) -> [f64; D] {
        self.machine.speeds(&self.state)
    }

    /// Position of the tool along each axis, m: that of the load, what the other axes add to it, and the share of a base.
    pub fn tool(&self) -> [f64; D] {
        let positions = self.positions();
        let travelled = std::array::from_fn(|axis| positions[axis] - self.zeros[axis]);
        let over = ((self.speeds.len() - 2) as f64 + self.share) * self.machine.period;
        let (first, last) = (self.speeds[0], self.speeds[self.speeds.len() - 1]);
        let accelerations = std::array::from_fn(|axis| (last[axis] - first[axis]) / over);
        let shift = (self.machine.coupling()).shift(&travelled, &self.zeros, &accelerations);
        let base = self.machine.bases_at_tool(&self.state);
        std::array::from_fn(|axis| positions[axis] + shift[axis] + base[axis])
    }

    /// What each drive did in its last cycle.
    pub fn cycles(&self) -> &[Cycle] {
        &self.cycles
    }

    /// The closed loop of each drive, as [`RunningMachine::machine`] lists its drives.
    pub fn loops(&self) -> &[LoopState] {
        &self.state.loops
    }
}
