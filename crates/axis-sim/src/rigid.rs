//! The other kind of machine: a rigid mass with a force gain under a P–P
//! controller, as the EMPS benchmark has it.
//!
//! A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS",
//! Workshop on Nonlinear System Identification Benchmarks, Eindhoven 2019:
//!
//! ```text
//! M q̈ = g u − F(q̇) − loads
//! u_k = sat( K_v (K_p (q_ref − q) − dq) ) + added_k,   held over a period
//! dq_k = (f_k − f_{k−1}) / T,   f_k = (q_k + q_{k−1}) / 2
//! ```

use axis_log::Mapping;
use feed_dynamics::{DriveError, TableMotion, find_load};
use lugre::LuGre;
use trajectories::Motion;

use crate::axis::Stroke;
use crate::effects::{self, ActiveEffect, Hooks, MachineMut, TableState};

/// A rigid mass with a force gain and a P–P controller. SI units.
#[derive(Clone, Debug)]
pub struct RigidAxis {
    /// Short name.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// Moving mass M, everything that rotates included, kg.
    pub mass: f64,
    /// Force per drive command g, N/V.
    pub force_gain: f64,
    /// Travel per motor turn, m.
    pub lead: f64,
    /// Friction: forces in N, speeds in m/s, bristles in m.
    pub friction: LuGre,
    /// Distance over which the contact gives before it slides, m.
    pub presliding: f64,
    /// K_p, 1/s.
    pub position_gain: f64,
    /// K_v, V·s/m.
    pub speed_gain: f64,
    /// Greatest drive command, V.
    pub command_limit: f64,
    /// Tracking error at which a replay is given up, m; none where it is `None`.
    pub following_error_limit: Option<f64>,
    /// Control period T, s.
    pub period: f64,
    /// Longest internal step, s.
    pub step: f64,
    /// Where the table may be.
    pub stroke: Stroke,
    /// Effects beyond the model above.
    pub effects: Vec<ActiveEffect>,
    /// How far a known parameter may be off, as a share of its value.
    pub tolerance: f64,
    /// How the columns of logs of this axis are called.
    pub log: Mapping,
    /// Hash of every value in SI units.
    pub fingerprint: String,
}

/// Where a replay begins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// m.
    pub position: f64,
    /// m/s.
    pub speed: f64,
}

/// One control period as it is logged.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RigidCycle {
    pub(crate) position: f64,
    pub(crate) command: f64,
}

/// The start of the step at which a run had to be given up, since no load goes
/// with the motion at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Halt {
    /// s.
    pub(crate) time: f64,
    /// m.
    pub(crate) position: f64,
    /// m/s.
    pub(crate) speed: f64,
    /// What was left of the last load tried, N.
    pub(crate) residual: f64,
}

impl RigidAxis {
    /// Table travel per radian of the screw, lead / 2π, m/rad.
    pub fn travel_per_radian(&self) -> f64 {
        self.lead / std::f64::consts::TAU
    }

    /// The axis with its effects' changes made, and their hooks.
    pub(crate) fn with_effects(&self) -> Result<(Self, Hooks), DriveError> {
        let mut axis = self.clone();
        let hooks = effects::install(&self.effects, MachineMut::Rigid(&mut axis))?;
        Ok((axis, hooks))
    }

    /// Follows `motion` for `cycles` periods; `added` is put on top of the
    /// controller's command.
    ///
    /// # Errors
    /// [`Halt`] where no load goes with the motion at the end of a step.
    pub(crate) fn follow(
        &self,
        hooks: &Hooks,
        motion: &impl Motion,
        start: Start,
        cycles: usize,
        added: impl Fn(usize) -> f64,
    ) -> Result<Vec<RigidCycle>, Halt> {
        let unit = self.unit_friction();
        let steps = (self.period / self.step * (1.0 - 1e-9)).ceil().max(1.0);
        let h = self.period / steps;
        let per_radian = self.travel_per_radian();
        let (mut x, mut v) = (start.position, start.speed);
        let (mut z, mut u) = (self.friction.steady_bristle(v), unit.steady_bristle(v));
        let mut load = self.friction.torque(z, v);
        // As if the speed had been the same before.
        let mut before = [x - v * self.period, x - 2.0 * v * self.period];
        let mut log = Vec::with_capacity(cycles);
        for k in 0..cycles {
            let time = k as f64 * self.period;
            let filtered = [0.5 * (x + before[0]), 0.5 * (before[0] + before[1])];
            let seen_speed = (filtered[0] - filtered[1]) / self.period;
            let wanted = self.position_gain * (motion.at(time).position - x);
            let asked = self.speed_gain * (wanted - seen_speed);
            let command = asked.clamp(-self.command_limit, self.command_limit) + added(k);
            log.push(RigidCycle {
                position: x,
                command,
            });
            before = [x, before[0]];
            for i in 0..steps as usize {
                let now = time + (i + 1) as f64 * h;
                let angle = x / per_radian;
                let torque = hooks.torque_at(angle, self.force_gain * command * per_radian);
                let force = torque / per_radian;
                let (x0, v0, z0, u0) = (x, v, z, u);
                let moved = |load: f64| {
                    let speed = v0 + h * (force - load) / self.mass;
                    TableMotion {
                        displacement: 0.5 * h * (v0 + speed),
                        speed,
                    }
                };
                let (end_load, found) = find_load(load, h / self.mass, moved, |table| {
                    let speed = table.speed;
                    let (z1, friction) = self.friction.step_torque(z0, v0, speed, h);
                    z = z1;
                    if !hooks.has_loads() {
                        return friction;
                    }
                    u = unit.step(u0, v0, speed, h);
                    friction
                        + hooks.loads_at(&TableState {
                            time: now,
                            position: x0 + table.displacement,
                            speed,
                            bristle: unit.torque(u, speed),
                            pressed: 1.0,
                        })
                });
                if !found.converged {
                    return Err(Halt {
                        time: now - h,
                        position: x0,
                        speed: v0,
                        residual: found.residual,
                    });
                }
                let end = moved(end_load);
                (load, x, v) = (end_load, x0 + end.displacement, end.speed);
            }
        }
        Ok(log)
    }

    fn unit_friction(&self) -> LuGre {
        let unit = lugre::Parameters {
            coulomb: 1.0,
            stiction: 1.0,
            stribeck_speed: self.friction.parameters().stribeck_speed,
            stiffness: 1.0 / self.presliding,
            damping: 0.0,
            viscous: 0.0,
        };
        LuGre::new(unit).unwrap_or(self.friction)
    }
}
