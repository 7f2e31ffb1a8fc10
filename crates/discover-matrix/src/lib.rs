//! Simulated machines with something hidden in them, and how the search of
//! [`discrepancy`] does on them, blind.
//!
//! [`hidden`] makes the logs: another mesh, another integrator and shorter steps than
//! those of the model, known parameters off, and sensor noise in the loop. It shares no
//! noise with the search, which supposes [`discrepancy::SensorNoise`]: neither generator
//! nor transformation to normal numbers is the same. [`matrix`] lays out cases, runs them
//! and counts; [`matrix2`] does so on machines that differ from the model as real ones do.
//!
//! # What this crate knows nothing of
//! Files, terminals and pictures; how the search is made.

pub mod hidden;
pub mod matrix;
pub mod matrix2;

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
