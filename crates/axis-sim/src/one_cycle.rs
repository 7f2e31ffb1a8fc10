//! One control cycle from a given state: the samples of Section 4.2.

use crate::error::SetupError;
use crate::plant::Start;
use crate::{Axis, ClosedLoop};

/// State at `t_k` and the command that acts until `t_{k+1}`: the inputs of
/// the prediction, in the order of the paper's Table 5. SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CycleInput {
    /// Position of the load S(k), m or rad.
    pub position: f64,
    /// Its speed Ṡ(k), m/s or rad/s.
    pub speed: f64,
    /// Its acceleration S̈(k), m/s² or rad/s².
    pub acceleration: f64,
    /// The actuator's command: I_qr(k), A, of a motor whose current is controlled.
    pub command: f64,
}

/// Longest internal step, s. What a cycle has beyond its linear map is some
/// 1e-11 m; one step of 100 µs would be off by 3e-13 m of it.
const LONGEST_STEP: f64 = 1e-5;

/// A time at which everything that comes up has come up, s.
const SETTLED: f64 = 1.0;

/// Simulates single control cycles of an axis.
///
/// At `t_k` the axis moves rigidly at the given speed and acceleration: all
/// deflections have settled under the inertia and friction forces, the
/// bristles under that speed, and the actuator gives what the torque balance asks
/// for, its own controllers settled at just that. Then the command acts for one cycle.
#[derive(Clone, Debug)]
pub struct OneCycle {
    closed_loop: ClosedLoop,
}

impl OneCycle {
    /// Prepares the axis, in its mechanism's fast way.
    ///
    /// # Errors
    /// As [`ClosedLoop::new`].
    pub fn new(axis: &Axis) -> Result<Self, SetupError> {
        let mut axis = axis.clone();
        axis.simulation.method = crate::mechanism::SolutionMethod::Fast;
        axis.simulation.step = axis.simulation.step.min(LONGEST_STEP);
        Ok(Self {
            closed_loop: ClosedLoop::new(&axis)?,
        })
    }

    /// Length of the cycle, s.
    pub fn period(&self) -> f64 {
        self.closed_loop.axis().period
    }

    /// Displacement of the load over the cycle, S(k+1) − S(k), m or rad.
    ///
    /// The increment, not the position: a position of 1.5 m resolves only
    /// 2.2e-16 m, which is what the smallest effects amount to.
    ///
    /// # Errors
    /// [`SetupError::Drive`] with `OffScrew` for a position off the screw (where the
    /// cycle carries the load over its end, the transmission stays there), with
    /// `Parameter` for a motion that is not finite; [`SetupError::Cycle`] if no
    /// friction goes with the motion.
    pub fn increment(&self, input: &CycleInput) -> Result<f64, SetupError> {
        let start = Start {
            position: input.position,
            speed: input.speed,
            acceleration: input.acceleration,
            time: SETTLED,
            friction: 0.0,
            held: false,
        };
        self.closed_loop.one_cycle(&start, input.command)
    }
}
