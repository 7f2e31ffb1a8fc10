//! The closed loop of an axis: one page for every kind of part.

mod limits;
mod sampling;
mod start;

use std::sync::Arc;

use compensator::{Compensator, Correction, Reference, Sample};
use trajectories::{Motion, Setpoint};

use self::limits::{reason_of, reason_of_drive};
use self::sampling::Sampling;
use crate::actuator::Actuating;
use crate::axis::Axis;
use crate::control::{Controller, Situation, absent};
use crate::cycle::{Command, Cycle, Measured, Outcome, StopReason};
use crate::effects::Hooks;
use crate::error::SetupError;
use crate::mechanism::SolutionMethod;
use crate::part::PartError;
use crate::plant::{AdvanceError, Assembly, Plant, Running, Start};
use crate::sensor::Sensing;
use crate::work::{MOST_STEPS, check_period, cycles_of, substeps};

/// Greatest internal step of a run that stands for a machine ([`ClosedLoop::exact`]), s.
pub const MACHINE_STEP: f64 = 2e-5;

/// The closed loop of an axis, prepared once for any number of runs.
#[derive(Clone, Debug)]
pub struct ClosedLoop {
    axis: Axis,
    hooks: Hooks,
    plant: Arc<dyn Plant>,
    sampling: Sampling,
    /// Seed of the sensors' noise, where they have some.
    noise: Option<u64>,
    /// What is added to the command in each cycle from the start of a motion.
    excitation: Option<Arc<[f64]>>,
}

/// A run between two cycles: everything that the next one depends on.
///
/// A copy is a snapshot. What a run has left (bristles, integrators, currents)
/// is what the next motion of the same axis begins with.
#[derive(Debug)]
pub struct LoopState {
    plant: Box<dyn Running>,
    actuator: Box<dyn Actuating>,
    controller: Box<dyn Controller>,
    load_sensor: Option<Box<dyn Sensing>>,
    motor_sensor: Option<Box<dyn Sensing>>,
    /// Motor angle that its sensor showed when the drive last took a speed from it, that speed,
    /// and the control periods until it takes the next.
    last_angle: f64,
    derived_speed: f64,
    speed_due: u32,
    /// Position where the motor's angle would be 0, wound up as at the start: an axis
    /// without a sensor at the load is homed where it stands.
    home: f64,
    last_effort: f64,
    cycles: u64,
}

impl Clone for LoopState {
    fn clone(&self) -> Self {
        let copy = |sensor: &Option<Box<dyn Sensing>>| sensor.as_ref().map(|s| s.copy());
        Self {
            plant: self.plant.copy(),
            actuator: self.actuator.copy(),
            controller: self.controller.copy(),
            load_sensor: copy(&self.load_sensor),
            motor_sensor: copy(&self.motor_sensor),
            ..*self
        }
    }
}

impl LoopState {
    /// Machine, as it is now.
    pub fn plant(&self) -> &dyn Running {
        &*self.plant
    }

    /// Actuator, as it is now.
    pub fn actuator(&self) -> &dyn Actuating {
        &*self.actuator
    }

    /// Lets a force from outside act on the load from the next cycle on, N or N·m, positive
    /// against positive motion, beside friction and loads: constant until it is set again, 0
    /// at the start.
    pub fn set_outer_load(&mut self, force: f64) {
        self.plant.set_outer_load(force);
    }

    /// The same state at time 0, for the next motion.
    #[must_use]
    pub fn at_rest(mut self) -> Self {
        self.cycles = 0;
        self
    }
}

impl ClosedLoop {
    /// Prepares the axis as its file says.
    ///
    /// # Errors
    /// [`SetupError`] if parts do not fit together, an effect carries a
    /// parameter out of its range, or the control period is outside 1 µs to 10 ms.
    pub fn new(axis: &Axis) -> Result<Self, SetupError> {
        Self::disturbed(axis, |_| ())
    }

    /// Prepares the axis by its mechanism's exact method, whatever the file says, in
    /// steps of at most `step` seconds.
    ///
    /// # Errors
    /// As [`ClosedLoop::new`].
    pub fn exact(axis: &Axis, step: f64) -> Result<Self, SetupError> {
        let mut axis = axis.clone();
        axis.simulation.method = SolutionMethod::Exact;
        axis.simulation.step = axis.simulation.step.min(step);
        Self::new(&axis)
    }

    /// The loop with another seed of the sensors' noise; it is 0 otherwise.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.noise = Some(seed);
        self
    }

    /// The loop with sensors that have neither noise nor steps: what a log is compared
    /// with, as both of them differ from run to run.
    #[must_use]
    pub fn without_noise(mut self) -> Self {
        self.noise = None;
        self
    }

    /// The loop with an excitation: a value for each cycle from the start of a motion, in the unit
    /// of the actuator's command, 0 after the last. It is added to the command of the speed
    /// controller, before its filters and its limit, and stands in [`Cycle::excitation`].
    #[must_use]
    pub fn with_excitation(mut self, samples: Vec<f64>) -> Self {
        self.excitation = Some(samples.into());
        self
    }

    /// As [`ClosedLoop::new`], with hooks beside those of the effects.
    pub(crate) fn disturbed(
        axis: &Axis,
        disturb: impl FnOnce(&mut Hooks),
    ) -> Result<Self, SetupError> {
        check_period(axis.period)?;
        if !axis.has_control() {
            return Err(PartError::together(absent::WHAT, absent::VALID).into());
        }
        let (axis, mut hooks) = axis.with_effects()?;
        disturb(&mut hooks);
        let substeps = substeps(axis.period, axis.simulation.step);
        let assembly = Assembly {
            friction: axis.friction.share().as_ref().clone(),
            loads: axis.loads.iter().map(|load| load.share()).collect(),
            hooks: hooks.clone(),
            backlash: axis.mechanism.backlash(),
            substeps,
        };
        let step = axis.period / f64::from(substeps);
        let method = axis.simulation.method;
        let plant = axis.mechanism.plant(method, step, assembly)?;
        // Refused here, so that no run can be.
        axis.actuator.runs_at(axis.period)?;
        axis.actuator.start(&axis.surroundings())?;
        axis.control.start(&axis.surroundings())?;
        Ok(Self {
            sampling: Sampling {
                travel: axis.travel_per_radian(),
                has_motor_encoder: axis.mechanism.has_motor_encoder(),
                derives_speed: axis.derives_speed(),
                speed_every: axis.control.speed_every(axis.period),
            },
            plant,
            axis,
            hooks,
            noise: Some(0),
            excitation: None,
        })
    }

    /// The axis, its effects' changes of parameters made.
    pub fn axis(&self) -> &Axis {
        &self.axis
    }

    /// Sampling instants of a run along `motion`, those at its start and its
    /// end included: as many cycles as [`ClosedLoop::run`] shows where it comes
    /// to its end.
    pub fn cycles(&self, motion: &(impl Motion + ?Sized)) -> u64 {
        cycles_of(motion.duration(), self.axis.period) as u64
    }

    /// Internal steps of such a run: what its computing time is proportional
    /// to. Above [`MOST_STEPS`] it is refused ([`StopReason::TooLong`]).
    pub fn steps(&self, motion: &(impl Motion + ?Sized)) -> f64 {
        let cycles = cycles_of(motion.duration(), self.axis.period);
        cycles * f64::from(substeps(self.axis.period, self.axis.simulation.step))
    }

    /// Time by which the load's channel is late in logs, s.
    pub(crate) fn clock_offset(&self) -> f64 {
        self.hooks.clock_offset
    }

    /// By how much a log shows the reference late, s.
    pub(crate) fn reference_delay(&self) -> f64 {
        self.hooks.reference_delay
    }

    /// One control cycle: sample, correct, control, and let the machine run on until the
    /// next sample. `reference` is the set point now, `next` the one a cycle ahead.
    ///
    /// The caller owns time: a co-simulation, a second axis or a real-time loop calls
    /// this once a control period.
    ///
    /// # Errors
    /// [`crate::RunStopped`] if the run must be given up; `state` is then of no use.
    pub fn step(
        &self,
        state: &mut LoopState,
        [reference, next]: [&Setpoint; 2],
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
    ) -> Result<Cycle, crate::RunStopped> {
        let mut cycle = Cycle::default();
        self.decide(state, [reference, next], compensator, sense, &mut cycle)?;
        self.advance(state, &cycle)?;
        Ok(cycle)
    }

    /// The cycle that begins at `state`, and the state in it after `share` of the control period (0
    /// to 1), under the command that [`ClosedLoop::step`] gives there. The run goes on from
    /// `state`, not from the result, which is between two samples.
    ///
    /// # Errors
    /// As [`ClosedLoop::step`].
    pub fn within(
        &self,
        state: &LoopState,
        references: [&Setpoint; 2],
        compensator: &mut (impl Compensator + ?Sized),
        share: f64,
    ) -> Result<(LoopState, Cycle), crate::RunStopped> {
        let (mut state, mut cycle) = (state.clone(), Cycle::default());
        self.decide(&mut state, references, compensator, |_| (), &mut cycle)?;
        if share > 0.0 {
            let ran = state.plant.advance_part(share, &mut *state.actuator);
            ran.map_err(|error| self.not_advanced(&state, &cycle, &error))?;
        }
        Ok((state, cycle))
    }

    /// Sample, correct and control; what comes of it is `cycle`, whatever it was before.
    #[expect(
        clippy::too_many_arguments,
        reason = "what a cycle reads and what it writes are borrowed apart, on the hot path"
    )]
    fn decide(
        &self,
        state: &mut LoopState,
        [reference, next]: [&Setpoint; 2],
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
        cycle: &mut Cycle,
    ) -> Result<(), crate::RunStopped> {
        // Sample.
        let measured = self.measure(state, sense);
        let seen = *state.plant.seen();
        let current = state.actuator.electrical().current;

        // Correct.
        let correction = compensator.correct(&Sample {
            reference: reference_of(reference),
            next_reference: reference_of(next),
            position: measured.position,
            motor_angle: measured.motor_angle,
            motor_speed: measured.motor_speed,
            iq: measured.current.q,
            last_command: state.last_effort,
        });

        // Control: position and speed, then the actuator's own.
        let samples = self.excitation.as_deref().unwrap_or_default();
        let excitation = samples.get(state.cycles as usize).copied().unwrap_or(0.0);
        let demand = state.controller.cycle(&Situation {
            reference,
            measured: &measured,
            correction: &Correction {
                command: correction.command + excitation,
                ..correction
            },
            limit: state.actuator.available().min(self.axis.actuator.limit()),
        });
        state.actuator.command(demand.effort, &measured);
        let electrical = state.actuator.electrical();

        *cycle = Cycle {
            time: state.cycles as f64 * self.axis.period,
            reference: *reference,
            position: seen.position,
            load_speed: seen.speed,
            motor_angle: seen.motor_angle,
            motor_speed: seen.motor_speed,
            current,
            torque: seen.torque,
            measured,
            command: Command {
                speed_ref: demand.speed_ref,
                effort: demand.effort,
                voltage: electrical.voltage,
                saturated: demand.saturated || electrical.saturated,
            },
            correction,
            excitation,
        };
        match self.stop_reason(cycle) {
            Some(reason) => Err(self.stopped(reason, cycle)),
            None => Ok(()),
        }
    }

    /// Lets the machine run on, the actuator's command held.
    fn advance(&self, state: &mut LoopState, cycle: &Cycle) -> Result<(), crate::RunStopped> {
        let ran = state.plant.advance(&mut *state.actuator);
        ran.map_err(|error| self.not_advanced(state, cycle, &error))?;
        state.cycles += 1;
        state.last_effort = cycle.command.effort;
        Ok(())
    }

    /// The end of a run whose machine could not go on in `cycle`.
    fn not_advanced(
        &self,
        state: &LoopState,
        cycle: &Cycle,
        error: &AdvanceError,
    ) -> crate::RunStopped {
        let seen = state.plant.seen();
        let at = Cycle {
            time: seen.time,
            position: seen.position,
            motor_speed: seen.motor_speed,
            torque: seen.torque,
            current: state.actuator.electrical().current,
            ..*cycle
        };
        self.stopped(reason_of(error, &at), &at)
    }

    /// Follows `motion` from rest at its start, and shows every cycle at a
    /// sampling instant from 0 to the motion's end to `observe`.
    pub fn run(
        &self,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        observe: impl FnMut(&Cycle),
    ) -> Outcome {
        self.run_sensed(motion, compensator, |_| (), observe)
    }

    /// As [`ClosedLoop::run`], with other sensors: `sense` is shown what those of the axis
    /// read in each cycle (the motor's true speed, where that is derived from its angle
    /// afterwards), and makes of it what the drive gets to read (noise, quantisation).
    pub fn run_sensed(
        &self,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
        observe: impl FnMut(&Cycle),
    ) -> Outcome {
        let reference = motion.at(0.0);
        match self.start(&Start::at(reference.position)) {
            Ok(mut state) => self.run_from(&mut state, motion, compensator, sense, observe),
            Err(error) => {
                let at = Cycle {
                    position: reference.position,
                    reference,
                    ..Cycle::default()
                };
                let reason = match &error {
                    SetupError::Drive(error) => reason_of_drive(error, &at),
                    _ => StopReason::NotFinite,
                };
                self.given_up(reason, &at)
            }
        }
    }

    /// As [`ClosedLoop::run_sensed`], from the state that the axis was left in, and
    /// leaves it in the state at the motion's end.
    #[expect(clippy::too_many_arguments, reason = "as `run_sensed`, with the state")]
    pub fn run_from(
        &self,
        state: &mut LoopState,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        mut sense: impl FnMut(&mut Measured),
        mut observe: impl FnMut(&Cycle),
    ) -> Outcome {
        let period = self.axis.period;
        let mut reference = motion.at(0.0);
        let steps = self.steps(motion);
        if steps > MOST_STEPS {
            let at = Cycle {
                position: state.plant.seen().position,
                reference,
                ..Cycle::default()
            };
            return self.given_up(StopReason::TooLong(steps), &at);
        }
        compensator.reset();
        let mut cycle = Cycle::default();
        for k in 0..self.cycles(motion) {
            let next = motion.at((k + 1) as f64 * period);
            let now = &mut cycle;
            let decided = self.decide(state, [&reference, &next], compensator, &mut sense, now);
            let advanced = decided.and_then(|()| {
                observe(&cycle);
                self.advance(state, &cycle)
            });
            if let Err(stopped) = advanced {
                return Outcome::Stopped {
                    time: stopped.time,
                    reason: stopped.reason,
                    at: stopped.at,
                };
            }
            reference = next;
        }
        Outcome::Completed
    }
}

fn reference_of(setpoint: &Setpoint) -> Reference {
    Reference {
        position: setpoint.position,
        velocity: setpoint.velocity,
        acceleration: setpoint.acceleration,
    }
}
