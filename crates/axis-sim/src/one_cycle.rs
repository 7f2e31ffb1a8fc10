//! One control cycle from a given state: the samples of Section 4.2.

use feed_dynamics::{DriveError, ModalStepper, Settled};
use foc_pmsm::{Dq, ServoState};

use crate::Axis;
use crate::plant::{Plant, substeps};
use crate::work::check_period;

/// State at `t_k` and the command that acts until `t_{k+1}`: the inputs of
/// the prediction, in the order of the paper's Table 5. SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CycleInput {
    /// Table position S(k), m from the driven end.
    pub position: f64,
    /// Table speed Ṡ(k), m/s.
    pub speed: f64,
    /// Table acceleration S̈(k), m/s².
    pub acceleration: f64,
    /// Current command I_qr(k), A.
    pub iq_command: f64,
}

/// Longest internal step, s. What a cycle has beyond its linear map is some
/// 1e-11 m; one step of 100 µs would be off by 3e-13 m of it.
const LONGEST_STEP: f64 = 1e-5;

/// Simulates single control cycles of an axis.
///
/// At `t_k` the axis moves rigidly at the given speed and acceleration: all
/// deflections have settled under the inertia and friction forces, the
/// bristles under that speed, and the current is what the torque balance asks
/// for. The current controllers' integrals hold just that current. Then the
/// command acts for one cycle, its voltage held.
#[derive(Clone, Debug)]
pub struct OneCycle {
    plant: Plant<ModalStepper>,
    axis: Axis,
}

impl OneCycle {
    /// Prepares the axis; the nut is coupled through shape functions.
    ///
    /// # Errors
    /// As [`crate::ClosedLoop::new`].
    pub fn new(axis: &Axis) -> Result<Self, DriveError> {
        check_period(axis.period)?;
        let (mut axis, hooks) = axis.with_effects()?;
        axis.simulation.step = axis.simulation.step.min(LONGEST_STEP);
        let step = axis.period / f64::from(substeps(&axis));
        Ok(Self {
            plant: Plant::new(&axis, hooks, ModalStepper::new(&axis.drive, step)?),
            axis,
        })
    }

    /// Length of the cycle, s.
    pub fn period(&self) -> f64 {
        self.axis.period
    }

    /// Table displacement over the cycle, S(k+1) − S(k), m.
    ///
    /// The increment, not the position: a position of 1.5 m resolves only
    /// 2.2e-16 m, which is what the smallest effects amount to.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`] for a position off the screw (where the cycle
    /// carries the table over its end, the nut stays there);
    /// [`DriveError::Parameter`] for a motion that is not finite;
    /// [`DriveError::LoadNotFound`] where no friction goes with the motion.
    pub fn increment(&self, input: &CycleInput) -> Result<f64, DriveError> {
        let drive = &self.axis.drive;
        let mut state = self.plant.in_motion(
            input.position,
            input.speed,
            input.acceleration,
            |motion: &Settled| motion.motor_torque(drive),
        )?;
        let held = state.current;
        let motor_speed = input.speed / self.axis.travel_per_radian();
        let steady = self.axis.motor.steady_voltage(held, motor_speed);
        let mut servo = ServoState::settled(held.q, steady);
        let command = Dq {
            d: 0.0,
            q: input.iq_command,
        };
        let (voltage, _, _) = self
            .axis
            .servo
            .current_loop(&mut servo, command - held, Dq::ZERO);
        self.plant.advance(&mut state, voltage)?;
        Ok(state.seen.displacement)
    }
}
