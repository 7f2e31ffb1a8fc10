//! The Python module `feed_axis`: feed axes simulated, what a model lacks found in logs,
//! and compensated, from Python.
//!
//! # The problem
//! The library speaks Rust: types, slices, results. Python's users have NumPy arrays, data
//! frames, exceptions and Ctrl-C. This crate converts between the two and does nothing else:
//! every equation, and every word of an error, is that of the crate below it.
//!
//! # Modules
//! - `begin`: axes to begin with. `loops`: margins and tuning of an axis' loops. `frf`: frequency responses from logs. `linear`: state space and frequency responses. `controller`: an unknown one, from logs.
//! - `axis`, `moves`, `motion_program`, `motion`, `simulate`, `run`: an axis from a file or a dict, along a motion, to
//!   arrays.
//! - `machine`, `toolpath`, `contour`, `circles`: several axes on one path, and what circular tests show.
//! - `check`: an axis against the data sheets of its parts.
//! - `log`, `discover`, `discovery`: what a model lacks, from files, frames or arrays.
//! - `compensation`, `sample`, `identify`, `learn`, `export`: corrections, cycle by cycle, on whole moves, and for controllers.
//! - `network`, `one_cycle`: training and prediction; samples of one control cycle.
//! - `lugre_law`, `general_lugre`, `beam`, `design`: the parts for themselves.
//! - `arrays`, `dict`: conversion. `value`: equality, copies and pickles. `errors`: exceptions. `html`: tables of notebooks. `long`: long work.
//!
//! # Long work
//! It runs on a thread of its own, without Python's lock; the calling thread looks for
//! signals and tells progress meanwhile (`long`).
//!
//! # Units
//! SI, as in the axis file's channels: the last part of a name is its unit (`position_m`).

mod arrays;
mod axis;
mod beam;
mod begin;
mod check;
mod circles;
mod compensation;
mod contour;
mod controller;
mod design;
mod dict;
mod discover;
mod discovery;
mod errors;
mod export;
mod frf;
mod general_lugre;
mod heat;
mod html;
mod identify;
mod learn;
mod linear;
mod log;
mod long;
mod loops;
mod lugre_law;
mod machine;
mod motion;
mod motion_program;
mod moves;
mod network;
mod one_cycle;
mod run;
mod sample;
mod sampled_motion;
mod simulate;
mod toolpath;
mod value;

use pyo3::prelude::*;

/// Feed axes simulated, what a model lacks found in logs, and compensated.
#[pymodule]
mod _feed_axis {
    #[pymodule_export]
    use crate::axis::PyAxis;
    #[pymodule_export]
    use crate::beam::PyBeam;
    #[pymodule_export]
    use crate::begin::{examples, new};
    #[pymodule_export]
    use crate::circles::{PyCirclesFound, fit_circles};
    #[pymodule_export]
    use crate::compensation::PyCompensator;
    #[pymodule_export]
    use crate::contour::PyContour;
    #[pymodule_export]
    use crate::controller::identify_control;
    #[pymodule_export]
    use crate::design::{halton, latin_hypercube, sobol};
    #[pymodule_export]
    use crate::discover::discover;
    #[pymodule_export]
    use crate::discovery::{Discovery, Effect, Parameter};
    #[pymodule_export]
    use crate::errors::{
        AxisError, FeedAxisError, LogError, LoopError, MachineError, MotionError, NetworkError,
        ParameterError, SearchError, SimulationError, StrategyError,
    };
    #[pymodule_export]
    use crate::general_lugre::PyGeneralLuGre;
    #[pymodule_export]
    use crate::identify::TransferFunctions;
    #[pymodule_export]
    use crate::learn::{MoveCorrection, identify, learn};
    #[pymodule_export]
    use crate::lugre_law::PyLuGre;
    #[pymodule_export]
    use crate::machine::PyMachine;
    #[pymodule_export]
    use crate::motion_program::Program;
    #[pymodule_export]
    use crate::moves::{Move, PySCurve};
    #[pymodule_export]
    use crate::network::PyNetwork;
    #[pymodule_export]
    use crate::one_cycle::Samples;
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::sample::{PyCorrection, PySample};
    #[pymodule_export]
    use crate::toolpath::PyToolpath;

    use pyo3::prelude::*;

    /// The strategies' names, each with a line of words.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let all = pyo3::types::PyDict::new(module.py());
        for (name, words) in crate::compensation::strategies() {
            all.set_item(name, words)?;
        }
        module.add("STRATEGIES", all)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
