//! An axis or a machine as a unit of the Functional Mock-up Interface, so that other programs simulate it
//! beside their own models: co-simulation by FMI 3.0 (Modelica Association, *Functional Mock-up
//! Interface Specification 3.0.2*, <https://fmi-standard.org/docs/3.0.2/>) and by FMI 2.0
//! (*Functional Mock-up Interface for Model Exchange and Co-Simulation 2.0.5*,
//! <https://github.com/modelica/fmi-standard/releases/tag/v2.0.5>).
//!
//! - [`UnitKind`]: an axis in its closed loop, the same with a correction in it, its machine alone, or
//!   two or three axes on one path.
//! - [`UnitCorrection`]: the strategy that corrects, and what was found for it.
//! - [`Unit`]: one instance. It takes set points and a force, makes control cycles with
//!   [`axis_sim::ClosedLoop::step`], and shows what machine and drive do. It refuses whatever
//!   comes in the wrong order.
//! - [`Variables`]: its inputs, outputs and parameters, made of the axis or machine file.
//! - [`FmiVersion`]: what differs between the two, the description and the names of folders.
//! - [`package`]: the file, a ZIP archive of description, library and files.
//!
//! The interface in C is another crate, `feed-axis-fmu`: a library that serves every axis, as it
//! reads the axis file from the unit's resources.
//!
//! ```
//! use axis_fmu::Unit;
//!
//! let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
//! let mut unit = Unit::new("liu2025.toml", &std::fs::read_to_string(file)?)?;
//! let named = |name: &str| unit.variables().named(name).map(|v| v.reference);
//! let (set, position) = (named("position_ref_m").unwrap(), named("machine.position_m").unwrap());
//! unit.enter_initialization(0.0, None)?;
//! unit.set(set, 0.6)?; // m
//! unit.exit_initialization()?;
//! unit.set(set, 0.6 + 1e-4)?; // a step of 0.1 mm
//! unit.step(0.0, 0.2)?; // s: 2000 control cycles
//! let moved = unit.get(position)? - 0.6;
//! assert!((moved - 1e-4).abs() < 0.5e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod correction;
mod description;
mod digest;
mod error;
mod given;
mod history;
mod kind;
mod library;
mod library_mark;
mod machine;
mod machine_run;
mod measure;
mod mode;
mod one_axis;
mod outputs;
mod paced;
mod package;
mod package_error;
mod parameters;
mod plant;
mod run;
mod simulated;
mod subject;
mod unit;
mod variables;
mod version;

pub use correction::UnitCorrection;
pub use description::{MODEL_IDENTIFIER, description};
pub use error::UnitError;
pub use kind::UnitKind;
pub use library::{UnitLibrary, library_file};
pub use library_mark::LIBRARY_MARK;
pub use measure::UnitDefinition;
pub use mode::FmiMode;
pub use package::package;
pub use package_error::PackageError;
pub use subject::{AXIS_FILE, CORRECTION_FILE, MACHINE_FILE};
pub use unit::Unit;
pub use variables::{Variable, VariableKind, Variables};
pub use version::FmiVersion;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
