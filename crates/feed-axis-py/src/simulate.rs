//! An axis along a motion.

use axis_sim::{ClosedLoop, Cycle, Measured};
use axis_sim::{MACHINE_STEP, NoiseLevels};
use compensator::{Compensator, NoCompensation};
use pyo3::prelude::*;

use crate::arrays;
use crate::axis::PyAxis;
use crate::errors::{SimulationError, raise};
use crate::long::{Hook, long};
use crate::motion::AnyMotion;
use crate::run::{Columns, Run};

/// Cycles from one look at the hook to the next.
const LOOK_EVERY: u64 = 512;

#[pymethods]
impl PyAxis {
    /// Follows a motion in closed loop.
    ///
    /// `compensation` is a Compensator, or a function that is called with each cycle's Sample
    /// and gives a Correction. `noise` is that of every sensor beside the axis file's own, in
    /// multiples of good ones. With `exact` the axis is simulated the slow, exact way, to stand
    /// for a machine. `excitation` is added to the command, a value for each cycle.
    /// `progress(what, done, total)` is called every 50 ms or so.
    #[pyo3(signature = (motion, *, compensation = None, noise = 0.0, exact = false, seed = 1, excitation = None, progress = None))]
    fn simulate(
        &self,
        py: Python<'_>,
        motion: AnyMotion<'_>,
        compensation: Option<crate::compensation::Given<'_>>,
        #[pyo3(from_py_with = arrays::noise)] noise: f64,
        exact: bool,
        #[pyo3(from_py_with = arrays::seed)] seed: u64,
        excitation: Option<&Bound<'_, PyAny>>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Run> {
        let motion = motion.on(&self.axis)?;
        let added = excitation.map(samples_added).transpose()?;
        let law = compensation.map(|given| given.recipe()).transpose()?;
        let axis = self.axis.clone();
        let columns = long(py, progress, move |hook| {
            let closed_loop = match exact {
                true => ClosedLoop::exact(&axis, MACHINE_STEP),
                false => ClosedLoop::new(&axis),
            };
            let mut closed_loop = closed_loop.map_err(raise::<SimulationError>)?;
            let mut law: Box<dyn Compensator> = match law {
                Some(law) => law.make(&motion)?,
                None => Box::new(NoCompensation),
            };
            let mut sensors = NoiseLevels::good(&axis).scaled(noise).sensors(seed);
            let sense = |seen: &mut Measured| {
                if noise > 0.0 {
                    sensors(seen);
                }
            };
            let total = closed_loop.cycles(&*motion);
            let is_excited = added.is_some();
            if let Some(added) = added {
                fits(&added, total)?;
                closed_loop = closed_loop.with_excitation(added);
            }
            // A motion that is refused as too long must not take its memory first.
            let mut columns = Columns::of(&axis, total.min(1 << 22) as usize, is_excited);
            let mut seen = 0;
            let observe = |cycle: &Cycle| {
                columns.push(cycle);
                seen += 1;
                tell(hook, seen, total);
            };
            let outcome = closed_loop.run_sensed(&*motion, &mut *law, sense, observe);
            outcome.completed().map_err(raise::<SimulationError>)?;
            Ok(columns)
        })?;
        Run::new(py, &self.axis, columns)
    }
}

/// What is to be added to the command, cycle by cycle.
fn samples_added(given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let samples = arrays::samples::<SimulationError>(given, "excitation")?;
    match samples.iter().position(|x| !x.is_finite()) {
        Some(k) => Err(SimulationError::new_err(format!(
            "excitation[{k}] is {}; valid: finite numbers, in the unit of the axis' command",
            samples[k]
        ))),
        None => Ok(samples),
    }
}

/// Refuses an excitation that is longer than its run.
fn fits(added: &[f64], cycles: u64) -> PyResult<()> {
    match added.len() as u64 <= cycles {
        true => Ok(()),
        false => Err(SimulationError::new_err(format!(
            "excitation has {} values and the motion {cycles} control cycles; valid: at most one for each cycle",
            added.len()
        ))),
    }
}

fn tell(hook: &Hook, seen: u64, total: u64) {
    if seen.is_multiple_of(LOOK_EVERY) || seen == total {
        hook.done("simulate", seen, total);
    }
}
