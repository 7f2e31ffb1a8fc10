//! A duty from a motion, simulated in closed loop.

use compensator::NoCompensation;
use trajectories::{Motion, Program, Step, TrajectoryError};

use super::{AxisDuty, CheckError};
use crate::axis::{Axis, MoveSpec};
use crate::closed_loop::ClosedLoop;

impl Axis {
    /// Moves of this axis' file one after the other, each from the stroke's start there and back, with a standstill of
    /// `dwell` seconds after each move and each return.
    ///
    /// # Errors
    /// [`TrajectoryError`] without a move, or of a standstill that is none.
    pub fn there_and_back(
        &self,
        moves: &[MoveSpec],
        dwell: f64,
    ) -> Result<Program, TrajectoryError> {
        let start = self.stroke.start;
        let steps = moves.iter().flat_map(|spec| {
            let to = |to: f64| Step::Move {
                to,
                limits: spec.limits,
            };
            let rest = (dwell != 0.0).then_some(Step::Dwell { duration: dwell });
            let there = [Some(to(start + spec.displacement)), rest];
            there.into_iter().chain([Some(to(start)), rest]).flatten()
        });
        Program::new(start, steps.collect())
    }

    /// What a motion asks of this axis, simulated once in closed loop.
    ///
    /// # Errors
    /// [`CheckError`] if the axis makes no loop, or the run did not come to its end.
    pub fn duty_of_motion<M: Motion + ?Sized>(&self, motion: &M) -> Result<AxisDuty, CheckError> {
        let mut duty = AxisDuty::of(self)?;
        let mut added = Ok(());
        let closed_loop = ClosedLoop::new(self)?;
        let outcome = closed_loop.run(motion, &mut NoCompensation, |cycle| {
            if added.is_ok() {
                added = duty.add_cycle(cycle);
            }
        });
        outcome.completed()?;
        added.map(|()| duty)
    }
}
