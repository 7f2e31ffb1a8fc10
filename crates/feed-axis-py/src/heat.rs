//! Hours of heat: of a duty, a model of them from logs, and growth along a log.

use std::path::PathBuf;

use axis_log::{Log, read_log};
use axis_pipeline::heat::{
    FollowOptions, Following, SlowLog, SlowLogOptions, fit, follow, probe_of, zero_of,
};
use axis_pipeline::strategies::SharedMotion;
use axis_sim::Axis;
use feed_axis::commands::heat::{GivenAs, HeatRun, LONGEST, places};
use feed_axis::commands::heat_fit::Fitted;
use feed_axis::commands::heat_predict::Predicted;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toml::{Table, Value};

use crate::arrays::line;
use crate::axis::PyAxis;
use crate::errors::{AxisError, LogError, MotionError, SimulationError, raise, readable};
use crate::log::{Renamed, columns, each_log};
use crate::long::long;
use crate::loops::plain;
use crate::motion::AnyMotion;

/// A log as it stands: nothing of hours is evened or taken out.
fn slow(given: &Bound<'_, PyAny>, axis: &Axis, name: String) -> PyResult<(String, Log)> {
    if let Ok(path) = given.extract::<PathBuf>() {
        readable(given.py(), &path)?;
        let log = read_log(&path, &axis.log, &[]).map_err(raise::<LogError>)?;
        return Ok((path.display().to_string(), log));
    }
    let channels = columns(given, &name, &Renamed::default())?;
    let log = Log::new(channels).map_err(raise::<LogError>)?;
    Ok((name, log))
}

fn on(axis: &Axis, duties: Option<Vec<AnyMotion<'_>>>) -> PyResult<Vec<SharedMotion>> {
    let duties = duties.unwrap_or_default();
    duties.iter().map(|motion| motion.on(axis)).collect()
}

/// How logs are read.
fn reading<'a>(
    duties: &'a [SharedMotion],
    air: f64,
    probe_against: &str,
    probe_zero: &str,
) -> PyResult<SlowLogOptions<'a>> {
    Ok(SlowLogOptions {
        duties,
        air,
        probe: probe_of(probe_against).map_err(raise::<LogError>)?,
        zero: zero_of(probe_zero).map_err(raise::<LogError>)?,
        ..SlowLogOptions::default()
    })
}

/// How positions are given here.
const AT_M: GivenAs = GivenAs {
    name: "at_m",
    unit: "m",
    metres: 1.0,
};

/// What a command refused, in its words, and what caused it.
fn refused(why: impl std::fmt::Display) -> PyErr {
    SimulationError::new_err(format!("{why:#}"))
}

#[pymethods]
impl PyAxis {
    /// Hours of a duty: temperatures, growth, friction and losses over time.
    #[pyo3(signature = (motion = None, *, duration_s = 3600.0, air_degc = 20.0, at_m = None, losses = "reference"))]
    fn heat<'py>(
        &self,
        py: Python<'py>,
        motion: Option<AnyMotion<'_>>,
        duration_s: f64,
        air_degc: f64,
        at_m: Option<&Bound<'py, PyAny>>,
        losses: &str,
    ) -> PyResult<Bound<'py, PyAny>> {
        if !(duration_s > 0.0 && duration_s <= LONGEST) {
            return Err(SimulationError::new_err(format!(
                "duration_s is {duration_s}; valid: above 0 s, at most {LONGEST} (115 days)"
            )));
        }
        let is_simulated = match losses {
            "reference" => false,
            "simulation" => true,
            other => {
                return Err(SimulationError::new_err(format!(
                    "losses is {other:?}; valid: \"reference\" or \"simulation\""
                )));
            }
        };
        let at = at_m.map(|at| line::<SimulationError>(at, "at_m"));
        let at: Vec<f64> = at.transpose()?.unwrap_or_default();
        let places = places(&self.axis, &at, AT_M).map_err(refused)?;
        let motion: SharedMotion = match motion {
            Some(motion) => motion.on(&self.axis)?,
            None => {
                let first = self.axis.trajectories.get(..1).unwrap_or_default();
                if first.is_empty() {
                    let words =
                        "the axis has no [[trajectory]]; give a motion that ends where it begins";
                    return Err(MotionError::new_err(words));
                }
                let program = self.axis.there_and_back(first, 1.0);
                std::sync::Arc::new(program.map_err(raise::<MotionError>)?)
            }
        };
        let axis = self.axis.clone();
        let heated = long(py, None, move |_| {
            let run = HeatRun {
                motion: &*motion,
                name: "a motion without end".to_owned(),
                duration: duration_s,
                air: air_degc,
                places,
                is_simulated,
            };
            run.on(&axis).map_err(refused)
        })?;
        plain(py, &heated)
    }

    /// Fits the thermal model to logs of hours: the axis with it, and how well it predicts what was held out.
    #[pyo3(signature = (logs, *, duties = None, air_degc = 20.0, held_out = 0.25, probe_against = "bearing", probe_zero = "begin"))]
    fn fit_heat<'py>(
        &self,
        py: Python<'py>,
        logs: &Bound<'py, PyAny>,
        duties: Option<Vec<AnyMotion<'_>>>,
        air_degc: f64,
        held_out: f64,
        probe_against: &str,
        probe_zero: &str,
    ) -> PyResult<(Self, Bound<'py, PyAny>)> {
        let duties = on(&self.axis, duties)?;
        // Refused before anything is read.
        reading(&[], air_degc, probe_against, probe_zero)?;
        let named =
            |(i, log): (usize, Bound<'py, PyAny>)| slow(&log, &self.axis, format!("log {}", i + 1));
        let logs: Vec<(String, Log)> = each_log(logs)?
            .into_iter()
            .enumerate()
            .map(named)
            .collect::<PyResult<_>>()?;
        let axis = self.axis.clone();
        let (against, zero) = (probe_against.to_owned(), probe_zero.to_owned());
        let fitted = long(py, None, move |_| {
            let reading = reading(&duties, air_degc, &against, &zero)?;
            let read = |(name, log): &(String, Log)| {
                let slow = SlowLog::new(&axis, log, &reading);
                slow.map_err(|error| LogError::new_err(format!("{name}: {error}")))
            };
            let slow: Vec<SlowLog<'_>> = logs.iter().map(read).collect::<PyResult<_>>()?;
            let found = fit(&axis, &slow, held_out).map_err(raise::<LogError>)?;
            let names = logs.iter().map(|(name, _)| name.clone()).collect();
            Ok(Fitted::of(&axis, names, 100.0 * held_out, &found))
        })?;
        let mut table: Table = self.text.parse().map_err(raise::<AxisError>)?;
        let thermal = table
            .entry("thermal")
            .or_insert_with(|| Value::Table(Table::new()));
        if let Some(thermal) = thermal.as_table_mut() {
            for (key, value) in fitted.keys() {
                thermal.insert(key.to_owned(), Value::Float(value));
            }
        }
        let axis = Self::parsed("<fitted axis>", table.to_string())?;
        Ok((axis, plain(py, &fitted)?))
    }

    /// Growth along a log of hours, from its reference alone.
    #[pyo3(signature = (log, *, duties = None, air_degc = 20.0, at_m = None, homed_s = 0.0, probe_each_s = None, probe_against = "bearing", probe_zero = "begin"))]
    fn predict_growth<'py>(
        &self,
        py: Python<'py>,
        log: &Bound<'py, PyAny>,
        duties: Option<Vec<AnyMotion<'_>>>,
        air_degc: f64,
        at_m: Option<&Bound<'py, PyAny>>,
        homed_s: f64,
        probe_each_s: Option<f64>,
        probe_against: &str,
        probe_zero: &str,
    ) -> PyResult<Bound<'py, PyDict>> {
        let duties = on(&self.axis, duties)?;
        let at = at_m.map(|at| line::<LogError>(at, "at_m")).transpose()?;
        let at = match at.unwrap_or_default() {
            none if none.is_empty() => none,
            at => {
                let within = places(&self.axis, &at, AT_M);
                within.map_err(|why| LogError::new_err(format!("{why:#}")))?
            }
        };
        let (name, log) = slow(log, &self.axis, "the log".to_owned())?;
        reading(&[], air_degc, probe_against, probe_zero)?;
        let axis = self.axis.clone();
        let (against, zero) = (probe_against.to_owned(), probe_zero.to_owned());
        let how = FollowOptions {
            homed: homed_s,
            probe_each: probe_each_s,
            places: at,
            ..FollowOptions::default()
        };
        let (found, figures) = long(py, None, move |_| {
            let reading = reading(&duties, air_degc, &against, &zero)?;
            let slow = SlowLog::new(&axis, &log, &reading);
            let slow = slow.map_err(|error| LogError::new_err(format!("{name}: {error}")))?;
            let model = axis.thermal_model().map_err(raise::<AxisError>)?;
            let found = follow(model, &slow, &how).map_err(raise::<LogError>)?;
            let figures = Predicted::of(&axis, name, &how, &found);
            Ok((found, figures))
        })?;
        arrays_of(py, &found, plain(py, &figures)?)
    }
}

/// The rows as arrays.
fn arrays_of<'py>(
    py: Python<'py>,
    found: &Following,
    figures: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let rows = &found.rows;
    let column = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..rows.len()).map(of).collect() };
    all.set_item("t_s", column(&|k| rows[k].time).into_pyarray(py))?;
    if rows.iter().all(|row| row.at_reference.is_some()) {
        let grown = column(&|k| rows[k].at_reference.unwrap_or(0.0));
        all.set_item("growth_m", grown.into_pyarray(py))?;
    }
    let places = rows.first().map_or(0, |row| row.growth.len());
    let growth: Vec<Vec<f64>> = (0..places)
        .map(|i| column(&|k| rows[k].growth[i]))
        .collect();
    let growth: Vec<_> = growth.into_iter().map(|one| one.into_pyarray(py)).collect();
    all.set_item("growth_at_m", growth)?;
    for (i, name) in ["dry_factor", "viscous_factor"].into_iter().enumerate() {
        all.set_item(name, column(&|k| rows[k].friction[i]).into_pyarray(py))?;
    }
    all.set_item("figures", figures)?;
    Ok(all)
}
