//! Motions as callers give them: a move, an S-curve, a program, samples.

use std::sync::Arc;

use axis_pipeline::strategies::SharedMotion;
use axis_sim::Axis;
use axis_sim::mechanism::Freedom;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};

use crate::arrays::samples;
use crate::errors::{MotionError, raise};
use crate::motion_program::Program;
use crate::moves::{Move, PySCurve};
use crate::sampled_motion::sampled_reference;

/// Refuses a motion in the unit of other axes.
fn check(freedom: Freedom, axis: &Axis, class: &str) -> PyResult<()> {
    let [found, valid] = [freedom, axis.freedom()].map(|freedom| match freedom {
        Freedom::Linear => ("in m", "moves along a line", String::new()),
        Freedom::Rotary => ("in rad", "turns", ".turn".to_owned()),
    });
    match freedom == axis.freedom() {
        true => Ok(()),
        false => Err(MotionError::new_err(format!(
            "the motion is {}, and the axis {:?} {}: give {class}{}(...), {}",
            found.0, axis.name, valid.1, valid.2, valid.0
        ))),
    }
}

/// A motion as a caller may give it.
pub(crate) enum AnyMotion<'py> {
    Move(PyRef<'py, Move>),
    SCurve(PyRef<'py, PySCurve>),
    Program(PyRef<'py, Program>),
    /// Positions at instants that lie evenly, or at each control cycle.
    Sampled {
        instants: Option<Vec<f64>>,
        positions: Vec<f64>,
    },
}

impl<'py> FromPyObject<'_, 'py> for AnyMotion<'py> {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(one) = given.extract() {
            return Ok(Self::Move(one));
        }
        if let Ok(curve) = given.extract() {
            return Ok(Self::SCurve(curve));
        }
        if let Ok(program) = given.extract() {
            return Ok(Self::Program(program));
        }
        // An array, a list, a series: what has a length, and is neither words nor a mapping.
        let is_array = given.len().is_ok() && !given.hasattr("keys")?;
        if !is_array || given.is_instance_of::<PyString>() {
            return Err(PyTypeError::new_err(format!(
                "a {} is no motion; valid: a Move, an SCurve, a Program, positions (one each control period), or a tuple (t_s, positions)",
                given.get_type().name()?
            )));
        }
        let pair: Option<(Bound<'py, PyAny>, Bound<'py, PyAny>)> = match given.cast::<PyTuple>() {
            Ok(pair) if pair.len() == 2 => Some(pair.extract()?),
            _ => None,
        };
        match pair.filter(|(instants, _)| instants.len().is_ok()) {
            Some((instants, positions)) => Ok(Self::Sampled {
                instants: Some(samples::<MotionError>(&instants, "t_s")?),
                positions: samples::<MotionError>(&positions, "positions")?,
            }),
            None => Ok(Self::Sampled {
                instants: None,
                positions: samples::<MotionError>(&given, "positions")?,
            }),
        }
    }
}

impl AnyMotion<'_> {
    /// The motion on an axis.
    pub(crate) fn on(&self, axis: &Axis) -> PyResult<SharedMotion> {
        Ok(match self {
            Self::Move(one) => {
                check(one.freedom, axis, "Move")?;
                let planned = axis.plan(&one.spec);
                Arc::new(planned.map_err(raise::<MotionError>)?)
            }
            Self::SCurve(curve) => {
                check(curve.freedom, axis, "SCurve")?;
                Arc::new(curve.curve)
            }
            Self::Program(one) => {
                axis.takes(&one.program).map_err(MotionError::new_err)?;
                Arc::new(one.program.clone())
            }
            Self::Sampled {
                instants,
                positions,
            } => Arc::new(sampled_reference(axis, instants.as_deref(), positions)?),
        })
    }
}
