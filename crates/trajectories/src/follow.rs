//! A target that may change in every cycle of a controller.

use crate::error::{duration, position};
use crate::{Motion, Real, Setpoint, TrajectoryError, Transfer, TransferLimits};

/// Follows a target that may change in every cycle, each time by the [`Transfer`] of least time from where it is.
///
/// It allocates nothing. A target that stays the same is planned for once; one that changes, once per change; one that moves
/// ([`track`](Self::track)), in every cycle.
///
/// ```
/// use trajectories::{Follow, Limits, Setpoint};
///
/// let limits = Limits::<f64>::new(1.0, 5.0, 100.0)?.into(); // m/s, m/s², m/s³
/// let mut follow = Follow::new(Setpoint::at_rest(0.0), limits, 1e-3)?; // s
/// for cycle in 0..1000 {
///     let target = Setpoint::at_rest(if cycle < 300 { 0.2 } else { 0.1 }); // m
///     let now = follow.step(&target)?;
///     assert!(now.velocity.abs() <= 1.0);
/// }
/// assert_eq!(follow.state().position, 0.1);
/// assert_eq!(follow.remaining(), 0.0);
/// # Ok::<(), trajectories::TrajectoryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow<T = f64> {
    limits: TransferLimits<T>,
    cycle: T,
    state: Setpoint<T>,
    plan: Option<Plan<T>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Plan<T> {
    transfer: Transfer<T>,
    /// What it was planned for; none if that moves.
    to: Option<Setpoint<T>>,
    cycles: u32,
}

impl<T: Real> Follow<T> {
    /// From `start`, with a setpoint every `cycle` (s).
    ///
    /// # Errors
    /// [`TrajectoryError::Invalid`] for a cycle that is not above zero, or is above [`maximum::DURATION`](crate::maximum::DURATION).
    pub fn new(
        start: Setpoint<T>,
        limits: TransferLimits<T>,
        cycle: T,
    ) -> Result<Self, TrajectoryError> {
        Ok(Self {
            limits,
            cycle: duration(cycle)?,
            state: start,
            plan: None,
        })
    }

    /// The setpoint one cycle on, under way to `target`.
    ///
    /// The target is where it is: one that moves on is met by [`track`](Self::track).
    ///
    /// # Errors
    /// As [`Transfer::plan`]. A refused target changes nothing: the last one that was not refused can be gone on to.
    pub fn step(&mut self, target: &Setpoint<T>) -> Result<Setpoint<T>, TrajectoryError> {
        let wanted = Setpoint {
            jerk: T::ZERO,
            ..*target
        };
        let plan = match self.plan {
            Some(plan) if plan.to == Some(wanted) && plan.cycles < u32::MAX => plan,
            _ => Plan {
                transfer: Transfer::plan(&self.state, &wanted, &self.limits)?,
                to: Some(wanted),
                cycles: 0,
            },
        };
        self.advance(plan)
    }

    /// The setpoint one cycle on, under way to meet a target that is at its position now, and moves on with its velocity.
    ///
    /// # Errors
    /// As [`Transfer::meet`]. A refused target changes nothing.
    pub fn track(&mut self, target: &Setpoint<T>) -> Result<Setpoint<T>, TrajectoryError> {
        self.advance(Plan {
            transfer: Transfer::meet(&self.state, target, &self.limits)?,
            to: None,
            cycles: 0,
        })
    }

    fn advance(&mut self, mut plan: Plan<T>) -> Result<Setpoint<T>, TrajectoryError> {
        plan.cycles += 1;
        let state = plan.transfer.at(T::count(plan.cycles) * self.cycle);
        position("position", state.position)?;
        self.plan = Some(plan);
        self.state = state;
        Ok(state)
    }

    /// The setpoint of the last step, or the start.
    #[inline]
    pub const fn state(&self) -> Setpoint<T> {
        self.state
    }

    /// Time until the target of the last step is reached, s.
    pub fn remaining(&self) -> T {
        self.plan.map_or(T::ZERO, |plan| {
            let gone = T::count(plan.cycles) * self.cycle;
            (plan.transfer.duration() - gone).max(T::ZERO)
        })
    }

    /// What is being carried out, for its [`extremes`](Transfer::extremes) for instance; none before the first step.
    pub fn transfer(&self) -> Option<&Transfer<T>> {
        self.plan.as_ref().map(|plan| &plan.transfer)
    }

    /// Sets other limits from the next step on; a state beyond them is brought back.
    pub fn set_limits(&mut self, limits: TransferLimits<T>) {
        self.limits = limits;
        self.plan = None;
    }

    /// Goes on from another state, for instance one that was measured.
    pub fn restart(&mut self, state: Setpoint<T>) {
        self.state = state;
        self.plan = None;
    }
}
