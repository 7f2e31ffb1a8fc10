//! The work of Liu et al. 2025 (doi:10.3390/machines13050433) as library
//! calls: sample, train, identify, validate, compensate, study.
//!
//! Each call takes typed inputs and gives typed results; files, folders,
//! terminals and pages belong to the caller. Progress is a callback, called
//! from any thread, once a unit of work.
//!
//! ```text
//! Axis ─ sampling ─► SampleSet ─ training ─► Network ─┐
//!   │                                                 ├─► Predictors ─► validation, compensation
//!   └─ identification (friction), transfer ───────────┘
//! ```
//!
//! Errors are in millionths of the unit of the axis' position, µm or µrad ([`measured::ErrorUnit`]), SI otherwise.

pub mod compensation;
pub mod corrections;
mod cycle_names;
pub mod drive_terms;
mod error;
mod figures;
pub mod heat;
pub mod identification;
pub mod learning;
mod linear_map;
pub mod measured;
pub mod moves;
mod need;
pub mod residuals;
pub mod robustness;
pub mod sample_file;
pub mod sampling;
pub mod strategies;
pub mod study;
pub mod summary;
pub mod tracking;
pub mod training;
pub mod transfer;
pub mod validation;
pub mod vibration;

pub use error::{NoFeedback, PipelineError};
pub use figures::Figures;
pub use linear_map::LinearMap;
pub use measured::ErrorUnit;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
