//! Compensators: cycle by cycle, and on simulated moves.

use std::sync::{Arc, Mutex, PoisonError};

use axis_pipeline::learning::StoredCorrection;
use axis_pipeline::strategies::{
    Build, NextMove, Predictors, STRATEGIES, SharedMotion, StrategyKind, named,
};
use compensator::{Compensator, Correction, Sample};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::axis::PyAxis;
use crate::errors::{StrategyError, raise};
use crate::identify::TransferFunctions;
use crate::learn::MoveCorrection;
use crate::long::Hook;
use crate::lugre_law::PyLuGre;
use crate::motion::AnyMotion;
use crate::network::PyNetwork;
use crate::sample::{PyCorrection, PySample};
use crate::value::{Value, value};

/// How a compensator is made for a motion.
#[derive(Clone)]
pub(crate) struct Strategy {
    kind: &'static StrategyKind,
    predictors: Predictors,
    /// What was learned of the move that is made.
    learned: Option<StoredCorrection>,
}

impl Strategy {
    /// The compensator of a motion.
    fn compensator(&self, motion: &SharedMotion) -> PyResult<Box<dyn Compensator + Send>> {
        let learned = self.learned.as_ref();
        let learned = learned.map(|stored| stored.on(&self.predictors.axis, &**motion));
        let next = NextMove {
            motion: motion.clone(),
            continued: None,
            learned: learned
                .transpose()
                .map_err(raise::<StrategyError>)?
                .map(Arc::new),
        };
        let strategy = self.kind.strategy(&self.predictors);
        let mut strategy = strategy.map_err(raise::<StrategyError>)?;
        strategy.compensator(&next).map_err(raise::<StrategyError>)
    }
}

/// What `simulate` may be given.
pub(crate) enum Recipe {
    Strategy(Box<Strategy>),
    Function(Py<PyAny>),
}

impl Recipe {
    /// The compensator of one run along a motion.
    pub(crate) fn make(self, motion: &SharedMotion) -> PyResult<Box<dyn Compensator>> {
        match self {
            Self::Strategy(strategy) => {
                let made: Box<dyn Compensator> = strategy.compensator(motion)?;
                Ok(made)
            }
            Self::Function(function) => Ok(Box::new(Function(function))),
        }
    }
}

/// A compensation as a caller gives it.
#[derive(FromPyObject)]
pub(crate) enum Given<'py> {
    Made(PyRef<'py, PyCompensator>),
    Function(Bound<'py, PyAny>),
}

impl Given<'_> {
    pub(crate) fn recipe(self) -> PyResult<Recipe> {
        Ok(match self {
            Self::Made(made) => Recipe::Strategy(Box::new(made.strategy.clone())),
            Self::Function(function) if function.is_callable() => {
                Recipe::Function(function.unbind())
            }
            Self::Function(other) => {
                return Err(PyTypeError::new_err(format!(
                    "compensation is a {}; valid: a Compensator, or a function from Sample to Correction",
                    other.get_type().name()?
                )));
            }
        })
    }
}

/// A Python function as a compensator.
struct Function(Py<PyAny>);

impl Compensator for Function {
    fn reset(&mut self) {}

    fn correct(&mut self, sample: &Sample) -> Correction {
        let called = Python::attach(|py| -> PyResult<PyCorrection> {
            let given = self.0.bind(py).call1((PySample::of(sample),))?;
            let Ok(correction) = given.cast::<PyCorrection>() else {
                return Err(PyTypeError::new_err(format!(
                    "the compensation gave a {}; valid: a Correction",
                    given.get_type().name()?
                )));
            };
            Ok(correction.get().clone())
        });
        match called {
            Ok(correction) => Correction {
                position: correction.position_m,
                command: correction.command,
            },
            Err(raised) => Hook::fail(raised),
        }
    }
}

/// A compensation strategy on an axis.
#[pyclass(module = "feed_axis", name = "Compensator", frozen)]
pub(crate) struct PyCompensator {
    strategy: Strategy,
    axis: PyAxis,
    /// At work, cycle by cycle; made by `start`.
    running: Mutex<Option<Box<dyn Compensator + Send>>>,
}

/// What a strategy may need, found elsewhere.
struct Found<'a> {
    network: Option<&'a PyNetwork>,
    transfer: Option<&'a TransferFunctions>,
    friction: Option<&'a PyLuGre>,
    correction: Option<&'a MoveCorrection>,
}

impl PyCompensator {
    /// Name of the strategy, and what it is made of.
    pub(crate) fn parts(&self) -> (&'static str, &Predictors) {
        (self.strategy.kind.name, &self.strategy.predictors)
    }

    fn of(axis: &PyAxis, strategy: &str, found: Found<'_>) -> PyResult<Self> {
        let Found {
            network,
            transfer,
            friction,
            correction,
        } = found;
        let Some(kind) = named(STRATEGIES, strategy) else {
            let names: Vec<_> = STRATEGIES.iter().map(|kind| kind.name).collect();
            return Err(StrategyError::new_err(format!(
                "there is no strategy {strategy:?}; valid: {}",
                names.join(", ")
            )));
        };
        let mut predictors = Predictors::of(&axis.axis);
        predictors.network = network.map(|network| network.network.clone());
        predictors.transfer = transfer.map(|transfer| transfer.0.clone());
        predictors.identified = friction.map(|friction| friction.0);
        // Refused here, so that no run can be for what is missing.
        kind.strategy(&predictors).map_err(raise::<StrategyError>)?;
        if correction.is_some() && matches!(kind.build, Build::Each(_)) {
            return Err(StrategyError::new_err(format!(
                "{strategy:?} does not know a motion ahead, so a correction is of no use to it; valid: a strategy that plans, such as plan"
            )));
        }
        let learned = correction.map(|correction| correction.0.clone());
        Ok(Self {
            strategy: Strategy {
                kind,
                predictors,
                learned,
            },
            axis: axis.clone(),
            running: Mutex::new(None),
        })
    }
}

/// A copy has not begun a motion, whatever the original does.
impl Value for PyCompensator {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let Strategy {
            kind,
            predictors,
            learned,
        } = &self.strategy;
        let learned = learned.clone().map(MoveCorrection);
        let network = predictors.network.clone().map(|network| PyNetwork {
            network,
            losses: Vec::new(),
        });
        let transfer = predictors.transfer.clone().map(TransferFunctions);
        let friction = predictors.identified.map(PyLuGre);
        (
            self.axis.clone(),
            kind.name,
            network,
            transfer,
            friction,
            learned,
        )
            .into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        type State<'py> = (
            PyRef<'py, PyAxis>,
            String,
            Option<PyRef<'py, PyNetwork>>,
            Option<PyRef<'py, TransferFunctions>>,
            Option<PyRef<'py, PyLuGre>>,
            Option<PyRef<'py, MoveCorrection>>,
        );
        let (axis, strategy, network, transfer, friction, learned): State<'_> = state.extract()?;
        let found = Found {
            network: network.as_deref(),
            transfer: transfer.as_deref(),
            friction: friction.as_deref(),
            correction: learned.as_deref(),
        };
        Self::of(&axis, &strategy, found)
    }
}

value!(PyCompensator);

#[pymethods]
impl PyCompensator {
    /// The strategy of that name (`feed_axis.STRATEGIES`) for an axis, with what it needs.
    #[new]
    #[pyo3(signature = (axis, strategy, *, network = None, transfer = None, friction = None, correction = None, motion = None))]
    fn new(
        axis: PyRef<'_, PyAxis>,
        strategy: &str,
        network: Option<PyRef<'_, PyNetwork>>,
        transfer: Option<PyRef<'_, TransferFunctions>>,
        friction: Option<PyRef<'_, PyLuGre>>,
        correction: Option<PyRef<'_, MoveCorrection>>,
        motion: Option<AnyMotion<'_>>,
    ) -> PyResult<Self> {
        let found = Found {
            network: network.as_deref(),
            transfer: transfer.as_deref(),
            friction: friction.as_deref(),
            correction: correction.as_deref(),
        };
        let made = Self::of(&axis, strategy, found)?;
        if let Some(motion) = motion {
            made.start(motion)?;
        }
        Ok(made)
    }

    /// Begins a motion from rest: the next `update` is its first cycle.
    fn start(&self, motion: AnyMotion<'_>) -> PyResult<()> {
        let mut made = self.strategy.compensator(&motion.on(&self.axis.axis)?)?;
        made.reset();
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) = Some(made);
        Ok(())
    }

    /// The correction for the cycle that begins with this sample.
    fn update(&self, sample: PySample) -> PyResult<PyCorrection> {
        let mut running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        let law = running.as_mut().ok_or_else(|| {
            StrategyError::new_err(
                "no motion was begun: give one to start(motion), or to the constructor",
            )
        })?;
        let correction = law.correct(&sample.sample());
        Ok(PyCorrection {
            position_m: correction.position,
            command: correction.command,
        })
    }

    /// Name of the strategy.
    #[getter]
    fn strategy(&self) -> &'static str {
        self.strategy.kind.name
    }

    fn __repr__(&self) -> String {
        let kind = self.strategy.kind;
        format!(
            "Compensator({:?} on {:?}: {})",
            kind.name, self.axis.axis.name, kind.summary
        )
    }
}

/// The strategies by name, each in a line.
pub(crate) fn strategies() -> Vec<(&'static str, &'static str)> {
    let all = STRATEGIES.iter();
    all.map(|kind| (kind.name, kind.summary)).collect()
}
