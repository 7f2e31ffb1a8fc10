//! A closed loop in control cycles.

use std::collections::VecDeque;
use std::sync::Arc;

use axis_pipeline::strategies::CycleLaw;
use axis_sim::{Axis, ClosedLoop, Cycle, LoopState, Start};
use compensator::{Compensator, Correction, Reference, Sample};
use trajectories::Setpoint;

use crate::error::UnitError;
use crate::given::{Given, Inputs};
use crate::outputs::Output;
use crate::paced::{Cycles, Paced};

/// A closed loop between two samples.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    closed_loop: Arc<ClosedLoop>,
    state: LoopState,
    /// What the drive did last.
    cycle: Cycle,
    law: Option<CycleLaw>,
    /// References that have come and are not followed yet, the oldest first: as many as the
    /// correction looks ahead.
    ahead: VecDeque<Setpoint>,
}

/// What makes a closed loop a compensated one.
#[derive(Clone, Debug)]
pub(crate) struct Corrected<'a> {
    /// At the start of a motion; none where it is switched off.
    pub law: Option<&'a CycleLaw>,
    /// Control periods by which references are followed late.
    pub look_ahead: usize,
}

/// What is added to the controller: the motor's input, and the correction.
struct Added<'a> {
    offset: f64,
    law: Option<&'a mut CycleLaw>,
    newest: Reference,
}

impl Compensator for Added<'_> {
    fn reset(&mut self) {}

    fn correct(&mut self, sample: &Sample) -> Correction {
        let own = Correction {
            position: 0.0,
            command: self.offset,
        };
        match &mut self.law {
            None => own,
            Some(law) => {
                let asked = law.correct(sample, &self.newest);
                Correction {
                    position: asked.position,
                    command: asked.command + self.offset,
                }
            }
        }
    }
}

impl Run {
    /// At rest at the reference. The drive shows what it would sample there.
    pub fn begin(
        axis: &Axis,
        given: &Inputs,
        corrected: Corrected<'_>,
    ) -> Result<Paced<Self>, UnitError> {
        let closed_loop = ClosedLoop::new(axis)?;
        let position = given[0].reference.position;
        let state = closed_loop.start(&Start::at(position))?;
        let rest = Setpoint {
            position,
            ..Setpoint::default()
        };
        let mut run = Self {
            closed_loop: Arc::new(closed_loop),
            state,
            cycle: Cycle::default(),
            law: corrected.law.cloned(),
            ahead: std::iter::repeat_n(rest, corrected.look_ahead).collect(),
        };
        let mut ahead = run.clone();
        ahead.cycle(given)?;
        run.cycle = ahead.cycle;
        Ok(Paced::new(run))
    }

    /// What the motor's input adds to the command, in the actuator's unit.
    fn offset(&self, given: &Given) -> f64 {
        let axis = self.closed_loop.axis();
        given.motor_torque(axis) / axis.torque_constant()
    }
}

impl Cycles for Run {
    type Between = LoopState;

    fn cycle(&mut self, [given, ..]: &Inputs) -> Result<(), UnitError> {
        let [now, next] = followed(&mut self.ahead, &given.reference);
        let mut added = Added {
            offset: self.offset(given),
            law: self.law.as_mut(),
            newest: reference_of(&given.reference),
        };
        self.state.set_outer_load(given.load);
        let (state, references) = (&mut self.state, [&now, &next]);
        self.cycle = (self.closed_loop).step(state, references, &mut added, |_| ())?;
        Ok(())
    }

    fn look(
        &mut self,
        [given, ..]: &Inputs,
        share: f64,
        exact: bool,
    ) -> Result<LoopState, UnitError> {
        let share = if exact { share } else { 0.0 };
        // The cycle is only looked at: what it does to correction and references is undone.
        let (mut law, mut ahead) = (self.law.clone(), self.ahead.clone());
        let [now, next] = followed(&mut ahead, &given.reference);
        let mut added = Added {
            offset: self.offset(given),
            law: law.as_mut(),
            newest: reference_of(&given.reference),
        };
        let mut from = self.state.clone();
        from.set_outer_load(given.load);
        let (state, cycle) = (self.closed_loop).within(&from, [&now, &next], &mut added, share)?;
        self.cycle = cycle;
        Ok(state)
    }

    fn read(&self, between: Option<&LoopState>, output: &Output) -> f64 {
        let shown = between.unwrap_or(&self.state);
        output.source.of_loop(shown, &self.cycle)
    }
}

/// The references of a cycle and of the next, `newest` having come.
fn followed(ahead: &mut VecDeque<Setpoint>, newest: &Setpoint) -> [Setpoint; 2] {
    ahead.push_back(*newest);
    let now = ahead.pop_front().unwrap_or(*newest);
    [now, ahead.front().copied().unwrap_or(*newest)]
}

fn reference_of(setpoint: &Setpoint) -> Reference {
    Reference {
        position: setpoint.position,
        velocity: setpoint.velocity,
        acceleration: setpoint.acceleration,
    }
}
