//! The electromechanical coupling model of Section 3.3 as one loop.

use compensator::{Compensator, Reference, Sample};
use feed_dynamics::{DriveError, ImplicitStepper, ModalStepper, NutCoupling, TimeStepper};
use foc_pmsm::{Command, ServoState};
use trajectories::{Motion, Setpoint};

use crate::Axis;
use crate::cycle::{Cycle, Measured, Outcome, StopReason};
use crate::effects::Hooks;
use crate::late_control::{DelayLine, control};
use crate::plant::{Plant, substeps};
use crate::work::{MOST_STEPS, check_period, cycles_of};

/// Longest internal step with a nut coupling, s, where `asked` is asked for.
pub(crate) fn longest_step(coupling: NutCoupling, asked: f64) -> f64 {
    match coupling {
        NutCoupling::ShapeFunctions => asked,
        NutCoupling::MovingNode => asked.min(1e-5),
    }
}

/// The closed loop of an axis, prepared once for any number of runs.
#[derive(Clone, Debug)]
pub struct ClosedLoop {
    axis: Axis,
    hooks: Hooks,
    plant: AnyPlant,
}

#[derive(Clone, Debug)]
enum AnyPlant {
    Modal(Plant<ModalStepper>),
    Implicit(Plant<ImplicitStepper>),
}

impl ClosedLoop {
    /// Prepares the axis as its file says: shape functions run on the modal
    /// stepper, the moving node on the implicit one with steps of at most 10 µs.
    ///
    /// # Errors
    /// [`DriveError`] where the mechanics cannot be set up, an effect carries a
    /// parameter out of its range, or the control period is outside 1 µs to 10 ms.
    pub fn new(axis: &Axis) -> Result<Self, DriveError> {
        check_period(axis.period)?;
        match axis.coupling {
            NutCoupling::ShapeFunctions => {
                let (axis, hooks) = axis.with_effects()?;
                let step = axis.period / f64::from(substeps(&axis));
                let stepper = ModalStepper::new(&axis.drive, step)?;
                Ok(Self {
                    plant: AnyPlant::Modal(Plant::new(&axis, hooks.clone(), stepper)),
                    axis,
                    hooks,
                })
            }
            NutCoupling::MovingNode => {
                let mut axis = axis.clone();
                axis.simulation.step = longest_step(axis.coupling, axis.simulation.step);
                Self::implicit(&axis)
            }
        }
    }

    /// Prepares the axis on the implicit stepper, whatever the coupling: the
    /// obvious way, to check the fast one against.
    ///
    /// # Errors
    /// As [`ClosedLoop::new`].
    pub fn implicit(axis: &Axis) -> Result<Self, DriveError> {
        check_period(axis.period)?;
        let (axis, hooks) = axis.with_effects()?;
        let step = axis.period / f64::from(substeps(&axis));
        let stepper = ImplicitStepper::new(&axis.drive, axis.coupling, step)?;
        Ok(Self {
            plant: AnyPlant::Implicit(Plant::new(&axis, hooks.clone(), stepper)),
            axis,
            hooks,
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
        cycles * f64::from(substeps(&self.axis))
    }

    /// Adds hooks to the plant.
    pub(crate) fn add(&mut self, change: impl FnOnce(&mut Hooks)) {
        match &mut self.plant {
            AnyPlant::Modal(plant) => change(plant.hooks()),
            AnyPlant::Implicit(plant) => change(plant.hooks()),
        }
    }

    /// Time by which the table's channel is late in logs, s.
    pub(crate) fn clock_offset(&self) -> f64 {
        self.hooks.clock_offset
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

    /// As [`ClosedLoop::run`], with sensors: `sense` is shown what perfect ones
    /// would read in each cycle, and makes of it what the controller and the
    /// log get to see (noise, quantisation).
    pub fn run_sensed(
        &self,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        sense: impl FnMut(&mut Measured),
        observe: impl FnMut(&Cycle),
    ) -> Outcome {
        match &self.plant {
            AnyPlant::Modal(plant) => self.run_on(plant, motion, compensator, sense, observe),
            AnyPlant::Implicit(plant) => self.run_on(plant, motion, compensator, sense, observe),
        }
    }

    fn run_on<S: TimeStepper>(
        &self,
        plant: &Plant<S>,
        motion: &(impl Motion + ?Sized),
        compensator: &mut (impl Compensator + ?Sized),
        mut sense: impl FnMut(&mut Measured),
        mut observe: impl FnMut(&Cycle),
    ) -> Outcome {
        let axis = &self.axis;
        let period = axis.period;
        let speed_feedforward = axis.velocity_feedforward / axis.travel_per_radian();

        let mut reference = motion.at(0.0);
        let origin = reference.position;
        let steps = self.steps(motion);
        if steps > MOST_STEPS {
            let at = Cycle {
                position: origin,
                reference,
                ..Cycle::default()
            };
            return stopped(StopReason::TooLong(steps), &at);
        }
        let mut state = match plant.at_rest(origin) {
            Ok(state) => state,
            Err(error) => {
                let at = Cycle {
                    position: origin,
                    reference,
                    ..Cycle::default()
                };
                return stopped(reason_of(&error, &at), &at);
            }
        };
        let mut servo = ServoState::default();
        let mut last_command = Command::default();
        let mut delay = DelayLine::new(self.hooks.delay / period);
        compensator.reset();

        for k in 0..self.cycles(motion) {
            // Sample.
            let time = k as f64 * period;
            let next_reference = motion.at((k + 1) as f64 * period);
            let seen = state.seen;
            let position = state.position();
            let mut measured = self.hooks.sensors.show(Measured {
                position,
                motor_angle: seen.motor_angle,
                motor_speed: seen.motor_speed,
                current: state.current,
            });
            sense(&mut measured);

            // Correct.
            let correction = compensator.correct(&Sample {
                reference: reference_of(&reference),
                next_reference: reference_of(&next_reference),
                position: measured.position,
                motor_speed: measured.motor_speed,
                iq: measured.current.q,
                iq_command: last_command.iq_ref,
            });

            // Control: position, speed and current loops (Fig. 5).
            let command = control(
                &axis.servo,
                &mut servo,
                &mut delay,
                &foc_pmsm::Measurement {
                    position: measured.position,
                    motor_speed: measured.motor_speed,
                    current: measured.current,
                },
                &foc_pmsm::Reference {
                    position: reference.position,
                    motor_speed: speed_feedforward * reference.velocity,
                },
                &correction,
            );

            // Record.
            let cycle = Cycle {
                time,
                reference,
                position,
                table_speed: seen.speed,
                motor_angle: seen.motor_angle,
                motor_speed: seen.motor_speed,
                current: state.current,
                measured,
                command,
                correction,
            };
            if let Some(reason) = self.stop_reason(&cycle) {
                return stopped(reason, &cycle);
            }
            observe(&cycle);

            // Let the machine run on, the voltage held (averaged SVPWM).
            if let Err(error) = plant.advance(&mut state, command.voltage) {
                let at = Cycle {
                    time: state.time(),
                    reference: motion.at(state.time()),
                    position: state.position(),
                    motor_speed: state.seen.motor_speed,
                    current: state.current,
                    ..Cycle::default()
                };
                return stopped(reason_of(&error, &at), &at);
            }
            reference = next_reference;
            last_command = command;
        }
        Outcome::Completed
    }

    fn stop_reason(&self, cycle: &Cycle) -> Option<StopReason> {
        let stroke = &self.axis.stroke;
        let current = cycle.current.d + cycle.current.q + cycle.command.iq_ref;
        let state = cycle.position + cycle.motor_speed + current;
        if !state.is_finite() {
            Some(StopReason::NotFinite)
        } else if cycle.error().abs() > self.axis.following_error_limit {
            Some(StopReason::FollowingError(self.axis.following_error_limit))
        } else if !(stroke.minimum..=stroke.maximum).contains(&cycle.position)
            || self.axis.drive.check_position(cycle.position).is_err()
        {
            Some(StopReason::LeftStroke)
        } else {
            None
        }
    }
}

/// A run that is given up in the state that `at` shows.
fn stopped(reason: StopReason, at: &Cycle) -> Outcome {
    Outcome::Stopped {
        time: at.time,
        reason,
        position: at.position,
        error: at.error(),
        motor_speed: at.motor_speed,
        iq: at.current.q,
    }
}

/// Why a run cannot go on after `error`, which has left it in the state `at`.
fn reason_of(error: &DriveError, at: &Cycle) -> StopReason {
    let state = at.position + at.motor_speed + at.current.d + at.current.q;
    match error {
        DriveError::LoadNotFound { residual, .. } if (state + residual).is_finite() => {
            StopReason::LoadNotFound
        }
        DriveError::OffScrew { .. } if state.is_finite() => StopReason::LeftStroke,
        _ => StopReason::NotFinite,
    }
}

fn reference_of(setpoint: &Setpoint) -> Reference {
    Reference {
        position: setpoint.position,
        velocity: setpoint.velocity,
        acceleration: setpoint.acceleration,
    }
}
