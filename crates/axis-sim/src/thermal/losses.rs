//! Losses of a motion: from its reference alone, or from the cycles of a simulation.
//!
//! Friction is the steady curve of the axis' friction with its effects ([`Axis::drive_model`]) at
//! the load's speed v; what of it is not viscous is dry. With r the travel per radian,
//!
//! ```text
//! dry power      (F(v) − d v) v          motor's torque for it   r (F(v) − d v)
//! viscous power  d v²                                            r d v
//! the rest of the torque                 reference: J a/r + r F_load(x);   simulation: T less both
//! ```
//!
//! Pre-sliding and what the loop adds at standstill are left out by the reference; on the paper's
//! axis that is below 1 % of the losses (`cargo xtask heat-proof`).

use axis_thermal::{Duty, DutySample, ThermalModel};
use lugre::LuGre;
use trajectories::{Motion, Setpoint};

use crate::axis::Axis;
use crate::cycle::Cycle;
use crate::plan_model::PlanModelError;

/// Most samples of a motion, by which the sampling interval of a long one grows.
const MOST_SAMPLES: f64 = 100_000.0;

/// Shortest sampling interval of a motion, s.
const INTERVAL: f64 = 1e-3;

/// Friction and inertia of an axis as its losses need them.
#[derive(Clone, Copy, Debug)]
pub struct LossModel {
    friction: LuGre,
    /// Load travel per unit of the friction's coordinate.
    lever: f64,
    travel: f64,
    inertia: f64,
}

impl LossModel {
    /// Of an axis with its effects.
    ///
    /// # Errors
    /// [`PlanModelError`] if its effects leave no valid friction.
    pub fn of(axis: &Axis) -> Result<Self, PlanModelError> {
        let model = axis.drive_model()?;
        Ok(Self {
            friction: model.friction,
            lever: model.lever,
            travel: axis.travel_per_radian(),
            inertia: axis.planned_mechanism()?.total_inertia(),
        })
    }

    /// A stretch of `duration` seconds at a position and a speed of the load, the motor giving
    /// `torque` (N·m, N) if that is known, or else what inertia, loads and friction ask for.
    fn sample(&self, duration: f64, x: f64, v: f64, torque: impl Fn(f64) -> f64) -> DutySample {
        let w = v / self.lever;
        let viscous = self.friction.parameters().viscous * w;
        let dry = match w == 0.0 {
            true => 0.0,
            false => self.friction.steady_state(w) - viscous,
        };
        let at_motor = |of: f64| self.travel / self.lever * of;
        let both = at_motor(dry) + at_motor(viscous);
        DutySample {
            duration,
            position: x,
            screw_speed: v / self.travel,
            dry_power: dry * w,
            viscous_power: viscous * w,
            torque: [torque(both), at_motor(dry), at_motor(viscous)],
        }
    }

    /// Adds a motion's losses to `duty`, from its reference alone.
    pub fn add_motion<M: Motion + ?Sized>(&self, duty: &mut Duty, axis: &Axis, motion: &M) {
        self.add_part(duty, axis, motion, [0.0, motion.duration()]);
    }

    /// The same of the motion's part between two times, s.
    pub fn add_part<M: Motion + ?Sized>(
        &self,
        duty: &mut Duty,
        axis: &Axis,
        motion: &M,
        [from, to]: [f64; 2],
    ) {
        let whole = to - from;
        let count = (whole / INTERVAL).ceil().clamp(1.0, MOST_SAMPLES);
        let step = whole / count;
        for k in 0..count as u32 {
            let at = motion.at(from + (f64::from(k) + 0.5) * step);
            duty.push(&self.set_point(axis, step, &at));
        }
    }

    /// A stretch of `duration` seconds at one set point of the reference.
    pub fn set_point(&self, axis: &Axis, duration: f64, at: &Setpoint) -> DutySample {
        let load = axis.load_at(at.position) * self.travel;
        let inertia = self.inertia * at.acceleration / self.travel;
        self.sample(duration, at.position, at.velocity, |_| inertia + load)
    }

    /// Adds a control cycle of `period` seconds as it was simulated.
    pub fn add_cycle(&self, duty: &mut Duty, period: f64, cycle: &Cycle) {
        let rest = |friction: f64| cycle.torque - friction;
        duty.push(&self.sample(period, cycle.position, cycle.load_speed, rest));
    }
}

impl Axis {
    /// Mean losses of a motion that repeats itself, from its reference alone: no loop is simulated.
    ///
    /// # Errors
    /// [`PlanModelError`] as [`LossModel::of`].
    pub fn duty_of<M: Motion + ?Sized>(
        &self,
        model: &ThermalModel,
        motion: &M,
    ) -> Result<Duty, PlanModelError> {
        let mut duty = model.duty();
        LossModel::of(self)?.add_motion(&mut duty, self, motion);
        Ok(duty)
    }
}
