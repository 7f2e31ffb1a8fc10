//! Frequency responses of machines under control, from what was measured on them.
//!
//! # The problem
//! A machine runs in closed loop, and something is added to its command so that it shows how it responds. What is its
//! frequency response, how uncertain is it on each line, which modes does it have, and how far is the loop from
//! instability?
//!
//! # What is here
//! - [`Excitation`]: pseudo-random binary sequence, chirp, multisine of low peak.
//! - [`FrequencyResponse`]: estimate with deviation and coherence on each line, without bias in closed loop where the
//!   excitation is known; over overlapping segments or over whole periods.
//! - [`ModalFit`]: poles, residues and a delay, with standard deviations.
//! - [`LoopMargins`]: maximum sensitivity, gain, phase and delay margin of a measured open loop.
//!
//! # Example
//! Two samples of delay and a gain of 3, excited by a pseudo-random sequence:
//!
//! ```
//! use frequency_response::{Averaging, Estimator, Excitation, FrequencyResponse, Prbs, Record};
//!
//! let u = Excitation::Prbs(Prbs { register: 9, ..Prbs::default() }).samples(1000.0, 4088)?;
//! let y: Vec<f64> = (0..u.len()).map(|k| if k < 2 { 0.0 } else { 3.0 * u[k - 2] }).collect();
//! let record = Record { period_s: 1e-3, excitation: Some(&u), input: &u, output: &y, differenced: false };
//! let periods = Averaging::Periods { period: 1022, skip: 1 };
//! let found = FrequencyResponse::of(&record, Estimator::ThreeSignals, periods)?;
//! let (value, _) = found.at(100.0).unwrap();
//! assert!((value.norm() - 3.0).abs() < 1e-9 && (value.arg() + 0.4 * std::f64::consts::PI).abs() < 1e-9);
//! # Ok::<(), frequency_response::ResponseError>(())
//! ```
//!
//! # What this crate knows nothing of
//! Axes, drives, files. It takes samples.

mod error;
mod estimate;
mod excitation;
mod fit;
mod margins;
mod segments;
#[cfg(feature = "serde")]
mod stored;

pub use axis_fourier::Complex;
pub use error::ResponseError;
pub use estimate::{Estimator, FrequencyResponse, Record, ResponseLine};
pub use excitation::{ChirpExcitation, ChirpSweep, Excitation, Multisine, Prbs, period_of};
pub use fit::{FitSettings, FittedMode, FittedPole, ModalFit, Uncertain};
pub use margins::{LoopLine, LoopMargins, SensitivityPeak};
pub use segments::Averaging;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
