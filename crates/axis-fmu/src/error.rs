//! What a unit refuses.

use axis_machine::{MachineError, MachineFileError};
use axis_pipeline::PipelineError;
use axis_sim::{AxisFileError, RunStopped, SetupError};
use thiserror::Error;

use crate::mode::FmiMode;

/// Why a call of a unit failed.
#[derive(Debug, Error)]
pub enum UnitError {
    /// The axis file, or a parameter that was set, makes no axis.
    #[error(transparent)]
    Axis(#[from] AxisFileError),
    /// The axis cannot be simulated, or not begin there.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The machine file, or a parameter that was set, makes no machine.
    #[error(transparent)]
    MachineFile(Box<MachineFileError>),
    /// The machine cannot begin there.
    #[error(transparent)]
    Machine(Box<MachineError>),
    /// The run of a machine had to be given up, as that of an axis.
    #[error("{0}; reset the unit, or set it to a state that was saved before")]
    MachineStopped(Box<MachineError>),
    /// The run had to be given up. An earlier state, a reset or the end are what is left.
    #[error("{0}; reset the unit, or set it to a state that was saved before")]
    Stopped(#[from] RunStopped),
    /// A call that its mode does not allow.
    #[error("{call}: the unit is {mode}; valid: {valid}")]
    Order {
        /// What was called.
        call: &'static str,
        /// The mode that the unit is in.
        mode: FmiMode,
        /// When it may be called.
        valid: &'static str,
    },
    /// A value reference that no variable has.
    #[error("no variable has the value reference {reference}; valid: 0 to {last}")]
    Reference {
        /// The reference.
        reference: u32,
        /// The last that is valid.
        last: u32,
    },
    /// A variable that cannot be set, or not now.
    #[error("{name} cannot be set: {why}")]
    Set {
        /// The variable.
        name: String,
        /// Why, and when or what would be valid.
        why: String,
    },
    /// A time that is not a number, or not where the unit is.
    #[error("{what} of {value} s; valid: {valid}")]
    Time {
        /// Which time.
        what: &'static str,
        /// Its value, s.
        value: f64,
        /// What would be valid.
        valid: String,
    },
    /// A part of FMI that this does not offer.
    #[error("not offered: {0}")]
    Absent(String),
    /// What is not there: a state, an array.
    #[error("the address of the {0} is null; valid: that of one")]
    Null(&'static str),
    /// A state that cannot be made bytes, or bytes that are no state.
    #[error("the state: {0}")]
    State(String),
    /// Other numbers of values than of variables.
    #[error("{values} values of {variables} variables; valid: one of each")]
    Lengths {
        /// Variables.
        variables: usize,
        /// Values.
        values: usize,
    },
    /// A correction that cannot be in a unit.
    #[error("no correction by {name}: {why}")]
    Correction {
        /// Name of the strategy.
        name: String,
        /// Why.
        #[source]
        why: Box<PipelineError>,
    },
    /// A text that is no correction.
    #[error(
        "the correction of the unit cannot be read: {0}; valid: the one that this version has exported"
    )]
    CorrectionText(String),
    /// A compensated unit without its correction.
    #[error("a compensated unit is made of an axis and a correction; valid: both, or another kind")]
    NoCorrection,
    /// A unit of a machine that is to be made of one axis.
    #[error("a unit of a machine is made of a machine file; valid: that, or another kind")]
    NoMachine,
    /// An axis or machine file that is no TOML table of tables after a change.
    #[error("the file cannot be changed: {0}")]
    Text(String),
}

impl From<MachineFileError> for UnitError {
    fn from(error: MachineFileError) -> Self {
        Self::MachineFile(Box::new(error))
    }
}
