//! A closed loop between two communication steps.

use std::collections::VecDeque;
use std::sync::Arc;

use axis_pipeline::strategies::CycleLaw;
use axis_sim::{Axis, ClosedLoop, Cycle, LoopState, Start};
use compensator::{Compensator, Correction, Reference, Sample};
use trajectories::Setpoint;

use crate::error::UnitError;
use crate::outputs::is_force;

/// Share of the control period within which a point of time is that of a sample: more than
/// rounding makes of times that are added up.
pub(crate) const SAME_POINT: f64 = 1e-3;

/// A run between two communication steps.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    closed_loop: Arc<ClosedLoop>,
    pub state: LoopState,
    /// What the drive did last.
    pub cycle: Cycle,
    /// Control cycles that are over.
    pub cycles: u64,
    /// Share of the control period that has passed of the next one; off by rounding.
    pub past: f64,
    /// Of a cycle that has begun: what its sample took, and the state where it is looked at between
    /// samples.
    begun: Option<(Given, Option<LoopState>)>,
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

/// What is given to the loop in a cycle.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    /// Of a plant, its position is where it begins.
    pub reference: Setpoint,
    /// N·m at the motor, or N at a load that is one with it.
    pub motor: f64,
    /// Current of the motor beside that, A.
    pub current: f64,
    /// N or N·m.
    pub load: f64,
}

impl Given {
    /// As bits, for a history.
    pub fn bits(&self) -> [u64; 6] {
        let reference = &self.reference;
        [
            reference.position,
            reference.velocity,
            reference.acceleration,
            self.motor,
            self.current,
            self.load,
        ]
        .map(f64::to_bits)
    }

    /// Of such bits.
    pub fn of_bits(bits: [u64; 6]) -> Self {
        let [position, velocity, acceleration, motor, current, load] = bits.map(f64::from_bits);
        Self {
            reference: Setpoint {
                position,
                velocity,
                acceleration,
                jerk: 0.0,
            },
            motor,
            current,
            load,
        }
    }
}

/// Torque that the inputs ask of the motor, N·m.
pub(crate) fn motor_torque(axis: &Axis, given: &Given) -> f64 {
    let own = match is_force(axis) {
        true => given.motor * axis.travel_per_radian(),
        false => given.motor,
    };
    own + given.current * axis.torque_constant()
}

impl Run {
    /// At rest at the reference. The drive shows what it would sample there.
    pub fn begin(axis: &Axis, given: &Given, corrected: Corrected<'_>) -> Result<Self, UnitError> {
        let closed_loop = ClosedLoop::new(axis)?;
        let state = closed_loop.start(&Start::at(given.reference.position))?;
        let rest = Setpoint {
            position: given.reference.position,
            ..Setpoint::default()
        };
        let mut run = Self {
            closed_loop: Arc::new(closed_loop),
            state,
            cycle: Cycle::default(),
            cycles: 0,
            past: 0.0,
            begun: None,
            law: corrected.law.cloned(),
            ahead: std::iter::repeat_n(rest, corrected.look_ahead).collect(),
        };
        let mut ahead = run.clone();
        ahead.cycle(given)?;
        run.cycle = ahead.cycle;
        Ok(run)
    }

    /// The machine as outputs show it.
    pub fn shown(&self) -> &LoopState {
        let between = self.begun.as_ref().and_then(|(_, state)| state.as_ref());
        between.unwrap_or(&self.state)
    }

    /// Runs on by `periods` control periods, not necessarily a whole number. Each control cycle
    /// takes the inputs at its beginning and holds them: one that began in an earlier step has
    /// those of then. In a cycle that is not over at the end the machine is shown as of its
    /// beginning, or as it is there where that is asked for (`exact`).
    pub fn run_on(&mut self, periods: f64, given: &Given, exact: bool) -> Result<(), UnitError> {
        let target = self.past + periods;
        let whole = (target + SAME_POINT).floor();
        for _ in 0..whole as u64 {
            match self.begun.take() {
                Some((begun, _)) => self.cycle(&begun)?,
                None => self.cycle(given)?,
            }
        }
        self.past = target - whole;
        if self.past > SAME_POINT {
            let given = self.begun.take().map_or(given.clone(), |(begun, _)| begun);
            let share = if exact { self.past } else { 0.0 };
            // The cycle is only looked at: what it does to correction and references is undone.
            let (mut law, mut ahead) = (self.law.clone(), self.ahead.clone());
            let [now, next] = followed(&mut ahead, &given.reference);
            let mut added = Added {
                offset: self.offset(&given),
                law: law.as_mut(),
                newest: reference_of(&given.reference),
            };
            let mut from = self.state.clone();
            from.set_outer_load(given.load);
            let (state, cycle) =
                (self.closed_loop).within(&from, [&now, &next], &mut added, share)?;
            self.cycle = cycle;
            self.begun = Some((given, exact.then_some(state)));
        }
        Ok(())
    }

    /// One control cycle.
    fn cycle(&mut self, given: &Given) -> Result<(), UnitError> {
        let [now, next] = followed(&mut self.ahead, &given.reference);
        let mut added = Added {
            offset: self.offset(given),
            law: self.law.as_mut(),
            newest: reference_of(&given.reference),
        };
        self.state.set_outer_load(given.load);
        let (state, references) = (&mut self.state, [&now, &next]);
        self.cycle = (self.closed_loop).step(state, references, &mut added, |_| ())?;
        self.cycles += 1;
        Ok(())
    }

    /// What the motor's input adds to the command, in the actuator's unit.
    fn offset(&self, given: &Given) -> f64 {
        let axis = self.closed_loop.axis();
        motor_torque(axis, given) / axis.torque_constant()
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
