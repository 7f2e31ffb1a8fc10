//! Moves that are made again after minutes of a duty: the machine warms up, and so does the model.
//!
//! ```text
//! machine   duty ─► heat of the machine ─► friction of its loop, growth of its table ─┐
//! model     duty ─► heat of the axis file ─► growth off the reference, friction ──► plan ─► moves
//! ```
//!
//! Growth is added to the simulated loop by superposition: what it does to lead and compliance is one part in 10⁴.

use std::sync::Arc;

use axis_sim::thermal::LossModel;
use axis_sim::{Axis, ClosedLoop, Measured};
use axis_thermal::{Duty, ThermalModel, ThermalState};
use trajectories::{Motion, Program, Step};

use super::ahead::Unseen;
use super::{HeatAhead, HeatError};
use crate::PipelineError;
use crate::moves::{MoveRun, Moves, NamedMotion};
use crate::strategies::{SharedMotion, Strategy};

/// Time in which a drive has come to where it is led, s.
const SETTLED: f64 = 1.0;

/// Heat of an axis under a duty that repeats itself: friction and growth over time.
pub trait DutyHeat {
    /// Goes on until so many seconds since the begin.
    ///
    /// # Errors
    /// [`HeatError`] if the heat does not settle.
    fn until(&mut self, time: f64) -> Result<(), HeatError>;

    /// Dry and viscous friction now, as multiples of the cold axis'.
    ///
    /// # Errors
    /// [`HeatError`] if the duty tells no friction.
    fn friction(&self) -> Result<[f64; 2], HeatError>;

    /// By how far the table at the position `x` (m) is from where the controller's measuring has it, m; 0 for a load
    /// that turns.
    fn growth(&self, x: f64) -> f64;
}

/// The heat of an axis as its file has it, homed cold.
#[derive(Clone)]
pub struct ModelHeat {
    axis: Axis,
    model: ThermalModel,
    losses: LossModel,
    unseen: Unseen,
    duty: Duty,
    air: f64,
    homed: ThermalState,
    now: ThermalState,
}

impl ModelHeat {
    /// Under a duty of motions one after the other, in air of a constant temperature (°C) that all begins at.
    ///
    /// # Errors
    /// [`HeatError`] if the numbers of `[thermal]` contradict each other.
    pub fn new(axis: &Axis, duty: &[SharedMotion], air: f64) -> Result<Self, HeatError> {
        Self::of(axis, axis.thermal_model()?, duty, air)
    }

    /// The same with another thermal model in the place of the file's.
    ///
    /// # Errors
    /// [`HeatError`] if the axis' effects leave no valid friction.
    pub fn of(
        axis: &Axis,
        model: ThermalModel,
        duty: &[SharedMotion],
        air: f64,
    ) -> Result<Self, HeatError> {
        let losses = LossModel::of(axis)?;
        let mut all = model.duty();
        for motion in duty {
            losses.add_motion(&mut all, axis, &**motion);
        }
        let state = model.at_rest(air);
        Ok(Self {
            duty: all,
            losses,
            unseen: Unseen::of(axis)?,
            axis: axis.clone(),
            air,
            homed: state.clone(),
            now: state,
            model,
        })
    }

    /// What is ahead of a motion that begins now.
    ///
    /// # Errors
    /// [`HeatError`] if the motion leaves the screw, or the heat does not settle.
    pub fn ahead(&self, motion: &dyn Motion) -> Result<HeatAhead, HeatError> {
        let axis = (&self.axis, &self.losses);
        HeatAhead::along(
            axis,
            &self.model,
            [&self.homed, &self.now],
            self.air,
            motion,
        )
    }
}

impl DutyHeat for ModelHeat {
    fn until(&mut self, time: f64) -> Result<(), HeatError> {
        let more = time - self.now.time;
        if more > 0.0 {
            let at_work = self.model.under(&self.duty)?;
            at_work.run(&mut self.now, self.air, more)?;
        }
        Ok(())
    }

    fn friction(&self) -> Result<[f64; 2], HeatError> {
        Ok(self.model.under(&self.duty)?.friction_factors(&self.now))
    }

    fn growth(&self, x: f64) -> f64 {
        self.unseen
            .read(&self.model.growth(&self.homed, &self.now, x))
    }
}

/// The axis with its dry and viscous friction times these factors.
///
/// # Errors
/// [`PipelineError`] if they leave no valid friction.
pub fn warm_axis(axis: &Axis, [dry, viscous]: [f64; 2]) -> Result<Axis, PipelineError> {
    let mut axis = axis.clone();
    let changed = axis.friction.change(|values| {
        for key in [
            "coulomb",
            "stiction",
            "coulomb_backward",
            "stiction_backward",
        ] {
            values.scale(key, dry);
        }
        for key in ["viscous", "viscous_quadratic", "viscous_cubic"] {
            values.scale(key, viscous);
        }
    });
    changed.map_err(axis_sim::SetupError::from)?;
    Ok(axis)
}

/// Moves after minutes of a duty.
pub struct WarmMoves {
    /// Seconds of the duty before each pass, rising.
    after: Vec<f64>,
    loops: Vec<ClosedLoop>,
    /// Growth of the machine's table along each pass.
    grown: Vec<HeatAhead>,
}

impl WarmMoves {
    /// Warms a machine up, whose parts are cold as its file has them, for passes of so many seconds after each of
    /// `after` (s, rising by a pass or more: the duty goes on meanwhile).
    ///
    /// # Errors
    /// [`PipelineError`] if its heat does not settle or its friction vanishes, or a time comes before the pass of the
    /// time before has ended.
    pub fn new(
        machine: &Axis,
        heat: &mut dyn DutyHeat,
        after: &[f64],
        pass: f64,
    ) -> Result<Self, PipelineError> {
        let early = after.windows(2).find(|w| w[1] - w[0] < pass * (1.0 - 1e-9));
        if let Some(&[before, time]) = early {
            return Err(HeatError::PassesOverlap { before, time, pass }.into());
        }
        let mut warm = Self {
            after: after.to_vec(),
            loops: Vec::new(),
            grown: Vec::new(),
        };
        for time in after {
            heat.until(*time)?;
            let before = heat.friction()?;
            let mut grown = HeatAhead::constant(machine, |x| heat.growth(x), before);
            heat.until(time + pass)?;
            let after = heat.friction()?;
            grown.push(pass, |x| heat.growth(x), after);
            warm.grown.push(grown);
            // Friction changes by some thousandths in a pass.
            let mean = [0, 1].map(|i| 0.5 * (before[i] + after[i]));
            warm.loops
                .push(ClosedLoop::new(&warm_axis(machine, mean)?)?);
        }
        Ok(warm)
    }

    /// Makes the moves at each time under a strategy, which predicts heat by `model` or not at all. At each time the
    /// axis begins relaxed, where its friction leaves no wind-up: homed there is homed cold, but for the growth. It
    /// comes to where it is led in a standstill, makes the moves once, from which nothing is learned, and goes on from
    /// move to move, homed where it was.
    ///
    /// # Errors
    /// As [`Moves::make`], and if the model's heat does not settle.
    #[expect(clippy::too_many_arguments, reason = "two of the five are closures")]
    pub fn run(
        &self,
        strategy: &mut dyn Strategy,
        moves: &[NamedMotion],
        mut model: Option<ModelHeat>,
        sense: impl FnMut(&mut Measured),
        each: impl Fn(),
    ) -> Result<Vec<Vec<MoveRun>>, PipelineError> {
        let Some(first) = self.loops.first() else {
            return Ok(Vec::new());
        };
        let mut rig = Moves::new(first, sense);
        let mut all = Vec::new();
        for ((time, closed_loop), grown) in self.after.iter().zip(&self.loops).zip(&self.grown) {
            let mut since = 0.0;
            let mut make = |planned: &NamedMotion, counts: bool| {
                let heat = match &mut model {
                    Some(model) => {
                        model.until(time + since)?;
                        Some(Arc::new(model.ahead(&*planned.motion)?))
                    }
                    None => None,
                };
                let begun = since;
                let off = move |t: f64, x: f64| grown.growth(begun + t, x)[0];
                rig.warmed(closed_loop, Box::new(off), heat);
                if !counts {
                    return rig.try_out(strategy, planned);
                }
                since += planned.motion.duration();
                rig.make(strategy, planned)
            };
            // In the minutes before, the drive has followed the growth: it stands where it is led to, its friction as
            // the moves leave it.
            if let Some(first) = moves.first().filter(|_| *time > 0.0) {
                make(&standstill(first)?, false)?;
                for planned in moves {
                    make(planned, false)?;
                }
            }
            let mut pass = Vec::new();
            for planned in moves {
                pass.push(make(planned, true)?);
                each();
            }
            all.push(pass);
        }
        Ok(all)
    }
}

/// A standstill where a move begins.
fn standstill(before: &NamedMotion) -> Result<NamedMotion, PipelineError> {
    let begin = before.motion.at(0.0).position;
    let rest = Step::Dwell { duration: SETTLED };
    let program = Program::new(begin, vec![rest]);
    let program = program.map_err(|source| PipelineError::Trajectory { index: 0, source })?;
    Ok(NamedMotion {
        name: format!("standstill before {}", before.name),
        motion: Arc::new(program),
        learned: None,
    })
}
