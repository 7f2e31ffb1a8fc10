//! Several feed axes on one path: the closed loop of each, and the contour error of all.
//!
//! # The problem
//! Two or three axes carry a tool along a path. Each has its own servo and its own error; what the workpiece shows is
//! how far the tool left the path. A [`toolpath::FeedProfile`] says where each axis has to be at each time ([`AxisMotion`]), the
//! closed loop of each axis ([`axis_sim::ClosedLoop`]) makes of that where it is, and a [`toolpath::Follower`] takes the distance of that
//! point from the path.
//!
//! ```
//! use axis_machine::{Driven, trace};
//! use axis_sim::{Axis, ClosedLoop};
//! use compensator::NoCompensation;
//! use toolpath::named::CircleTest;
//! use toolpath::{FeedLimits, FeedProfile};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/linear-stage.toml");
//! // Two stages of the same kind as X and Y; a circle of 10 mm at 3 m/min, 1 m/s² and 20 m/s³ for each axis.
//! let stage = ClosedLoop::new(&Axis::read(file.as_ref())?)?;
//! let circle = CircleTest::new(0.01).path()?;
//! let profile = FeedProfile::plan(&circle.path, &FeedLimits::equal(0.05, 1.0, 1.0, 20.0))?;
//! let driven = [(); 2].map(|()| Driven::new(&stage, Box::new(NoCompensation)));
//! let traced = trace(&profile, driven)?;
//! let worst = traced.contour_error().map(|foot| foot.length()).fold(0.0, f64::max);
//! assert!(worst > 1e-6 && worst < 1e-3);
//! # Ok(())
//! # }
//! ```
//!
//! # What lies between axes
//! A [`CoupledMachine`] runs its drives in lockstep. [`Coupling`]: squareness, straightness and cross-talk, by which one axis moves the
//! tool along another; [`BaseMode`]: a base on a spring under an axis; [`GantryBeam`]: two drives that carry one beam. Its
//! references may take the coupling away ([`AxisMotion::correcting`]); [`fit_circles`] finds squareness and cross-talk from
//! circles at two feeds. [`Laps`] keeps a strategy of compensation for each drive from lap to lap, and [`MachineFile`] is the
//! file that names axis files and all of that. Equations: docs/theory/axis-machine.md.
//!
//! # What it deliberately knows nothing of
//! How a correction is found ([`axis_pipeline::strategies`]), pages, the command line; cutting forces and heat.

mod base;
mod coupling;
mod driven;
mod error;
mod file;
mod gantry;
mod identify;
mod laps;
mod machine;
mod motion;
mod numbers;
mod run;
mod running;
mod straightness;
mod traced;

pub use base::BaseMode;
pub use coupling::{AxisCoupling, Coupling};
pub use driven::{Driven, trace};
pub use error::{CircleFitError, MachineError};
pub use file::{
    AxisName, BaseText, CouplingText, FileDrive, GantryText, MachineAxes, MachineFile,
    MachineFileError, MachineText,
};
pub use gantry::GantryBeam;
pub use identify::{CircleEstimate, CirclesFound, MeasuredCircle, fit_circles};
pub use laps::{DriveSensors, Laps, LearnedLap};
pub use machine::{CoupledMachine, MachineDrive};
pub use motion::AxisMotion;
pub use numbers::MachineNumber;
pub use run::{DriveLaw, Lap, MachineState};
pub use running::{AxisGiven, RunningMachine};
pub use straightness::Straightness;
pub use traced::Traced;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
