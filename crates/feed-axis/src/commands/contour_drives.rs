//! Compensations of the drives of a machine on a path, and what can go wrong on it.

use std::fmt;
use std::path::PathBuf;

use axis_machine::{CircleFitError, MachineError, MachineFile, MachineFileError};
use axis_pipeline::PipelineError;
use axis_pipeline::strategies::{Predictors, Strategy, StrategyKind};
use toolpath::ToolpathError;

/// Why a machine was not run along a path.
#[derive(Debug)]
#[non_exhaustive]
pub enum ContourError {
    /// The path, its feed or its figures.
    Path(ToolpathError),
    /// The machine stopped, or is none.
    Machine(MachineError),
    /// A value of the machine file.
    File(MachineFileError),
    /// A compensation that an axis cannot have.
    Strategy {
        /// Which drive, from 1; a gantry's second stands behind its first.
        drive: usize,
        /// Why.
        source: PipelineError,
    },
    /// Squareness and cross-talk were not found.
    Circles(CircleFitError),
    /// A path of more coordinates than the machine has axes.
    Dimensions {
        /// The machine file.
        machine: PathBuf,
        /// Its axes.
        axes: usize,
        /// Coordinates of the path.
        path: usize,
    },
    /// Another number of compensations than of drives.
    Drives {
        /// Compensations.
        given: usize,
        /// Drives.
        drives: usize,
    },
    /// Circles are needed, and the path is none in the plane.
    NoCircle,
}

impl fmt::Display for ContourError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Path(source) => source.fmt(f),
            Self::Machine(source) => source.fmt(f),
            Self::File(source) => source.fmt(f),
            Self::Strategy { drive, source } => write!(f, "drive {drive} (from 1): {source}"),
            Self::Circles(source) => source.fmt(f),
            Self::Dimensions {
                machine,
                axes,
                path,
            } => write!(
                f,
                "the path has {path} coordinates, and {} has {axes} axes; valid: a machine with x, y and z, or a path in the plane",
                machine.display()
            ),
            Self::Drives { given, drives } => write!(
                f,
                "there are {given} compensations for {drives} drives; valid: one for each drive, that of a gantry's second after its first"
            ),
            Self::NoCircle => write!(
                f,
                "squareness and cross-talk are found on circles in the plane of X and Y; valid: such a circle"
            ),
        }
    }
}

impl std::error::Error for ContourError {}

macro_rules! from {
    ($($kind:ident $source:ty),*) => {
        $(impl From<$source> for ContourError {
            fn from(source: $source) -> Self {
                Self::$kind(source)
            }
        })*
    };
}
from!(Path ToolpathError, Machine MachineError, File MachineFileError, Circles CircleFitError);

/// A compensation of each drive of a machine.
#[derive(Clone, Debug)]
pub struct DriveCompensations {
    /// What it is called.
    pub name: String,
    drives: Vec<(&'static StrategyKind, Predictors)>,
}

impl DriveCompensations {
    /// One strategy on all drives, which knows each axis as its file has it, and nothing else.
    ///
    /// # Errors
    /// [`ContourError::Strategy`] if it needs more, or an axis cannot have it.
    pub fn of(kind: &'static StrategyKind, file: &MachineFile) -> Result<Self, ContourError> {
        let drives = file.drives().into_iter();
        Self::new(
            drives
                .map(|drive| (kind, Predictors::of(drive.nominal)))
                .collect(),
        )
    }

    /// Strategies with what they are made of, one for each drive in the order of [`MachineFile::drives`].
    ///
    /// # Errors
    /// As [`DriveCompensations::of`].
    pub fn new(drives: Vec<(&'static StrategyKind, Predictors)>) -> Result<Self, ContourError> {
        let mut names: Vec<&str> = drives.iter().map(|(kind, _)| kind.name).collect();
        names.dedup();
        let made = Self {
            name: names.join(", "),
            drives,
        };
        made.strategies(made.drives.len())?;
        Ok(made)
    }

    /// The strategies of the first `count` drives, which have not learned anything.
    ///
    /// # Errors
    /// [`ContourError::Drives`] if there are fewer, and as [`DriveCompensations::of`].
    pub fn strategies(&self, count: usize) -> Result<Vec<Box<dyn Strategy>>, ContourError> {
        if self.drives.len() < count {
            return Err(ContourError::Drives {
                given: self.drives.len(),
                drives: count,
            });
        }
        let drives = self.drives[..count].iter().enumerate();
        drives
            .map(|(d, (kind, predictors))| {
                let drive = d + 1;
                let made = kind.strategy(predictors);
                made.map_err(|source| ContourError::Strategy { drive, source })
            })
            .collect()
    }
}
