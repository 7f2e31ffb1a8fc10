//! The machine between two samples: motor, drive and friction under a held voltage.

use feed_dynamics::{Observation, Settled, TimeStepper};
use foc_pmsm::{Dq, Pmsm};
use lugre::LuGre;

use crate::Axis;

/// The machine, for control cycles of one length.
#[derive(Clone, Debug)]
pub struct Plant<S> {
    stepper: S,
    motor: Pmsm,
    friction: LuGre,
    travel_per_radian: f64,
    substeps: u32,
}

/// The machine's inner state, which no controller sees.
#[derive(Clone, Debug)]
pub struct PlantState<D> {
    drive: D,
    /// Bristle deflection z at the screw, rad.
    bristle: f64,
    /// Currents, A.
    pub(crate) current: Dq,
    /// What the drive shows.
    pub(crate) seen: Observation,
    /// Motor acceleration over the last step, rad/s².
    motor_acceleration: f64,
}

/// Number of equal steps, none longer than asked, that make up a control period.
pub(crate) fn substeps(axis: &Axis) -> u32 {
    // A step that fits to rounding must not be halved.
    let steps = (axis.period / axis.simulation.step * (1.0 - 1e-9)).ceil();
    steps.clamp(1.0, 10_000.0) as u32
}

impl<S: TimeStepper> Plant<S> {
    /// The plant of `axis` on a stepper whose step is the control period
    /// divided by [`substeps`].
    pub(crate) fn new(axis: &Axis, stepper: S) -> Self {
        Self {
            stepper,
            motor: axis.motor,
            friction: axis.friction,
            travel_per_radian: axis.travel_per_radian(),
            substeps: substeps(axis),
        }
    }

    /// Everything at rest and relaxed, the table at `x` (m).
    pub(crate) fn at_rest(&self, x: f64) -> PlantState<S::State> {
        let drive = self.stepper.settled(x, &Settled::default());
        PlantState {
            seen: self.stepper.observe(&drive),
            drive,
            bristle: 0.0,
            current: Dq::ZERO,
            motor_acceleration: 0.0,
        }
    }

    /// Uniformly accelerated motion at the table speed `speed` (m/s) and
    /// `acceleration` (m/s²): deflections settled, bristles at their steady
    /// deflection, current as the torque balance asks.
    pub(crate) fn in_motion(
        &self,
        x: f64,
        speed: f64,
        acceleration: f64,
        torque: impl FnOnce(&Settled) -> f64,
    ) -> PlantState<S::State> {
        let r = self.travel_per_radian;
        let bristle = self.friction.steady_bristle(speed / r);
        let load = self.friction.torque(bristle, speed / r) / r;
        let motion = Settled {
            speed,
            acceleration,
            load,
        };
        let drive = self.stepper.settled(x, &motion);
        PlantState {
            seen: self.stepper.observe(&drive),
            drive,
            bristle,
            current: Dq {
                d: 0.0,
                q: self.motor.q_current(torque(&motion)),
            },
            motor_acceleration: acceleration / r,
        }
    }

    /// One control cycle with the voltage held.
    pub(crate) fn advance(&self, state: &mut PlantState<S::State>, voltage: Dq) {
        let h = self.stepper.step_length();
        let r = self.travel_per_radian;
        for _ in 0..self.substeps {
            // Currents, over the mean motor speed of the step.
            let start = state.seen;
            let mean_speed = start.motor_speed + 0.5 * h * state.motor_acceleration;
            state.current = self.motor.step(state.current, voltage, mean_speed, h);
            let torque = self.motor.torque(state.current);

            // Mechanics; the friction follows the table's speed at the end of the step.
            let (z0, w0) = (state.bristle, start.speed / r);
            let mut z1 = z0;
            self.stepper.step(&mut state.drive, torque, |table| {
                let (z, friction) = self.friction.step_torque(z0, w0, table.speed / r, h);
                z1 = z;
                friction / r
            });
            state.bristle = z1;
            state.seen = self.stepper.observe(&state.drive);
            state.motor_acceleration = (state.seen.motor_speed - start.motor_speed) / h;
        }
    }
}
