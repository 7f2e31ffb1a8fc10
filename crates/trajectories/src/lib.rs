//! Jerk-limited S-curves and motion programs, evaluated exactly at any time.
//!
//! # The problem
//! A position `s(t)` in m is wanted that starts at rest at `s₀`, ends at rest at `s₁`, and on the
//! way obeys
//!
//! ```text
//! |s'(t)| ≤ V   m/s      velocity limit
//! |s''(t)| ≤ A  m/s²     acceleration limit
//! |s'''(t)| ≤ J m/s³     jerk limit
//! ```
//!
//! in the least time. For a motion between two rests the answer has at most seven segments of
//! constant jerk, `+J 0 −J | 0 | −J 0 +J`, symmetric about the middle of its time, each of which
//! drives one limit to its bound; [`SCurve::plan`] finds the three durations in closed form for
//! every case, those included that reach neither the speed nor the acceleration limit.
//!
//! A [`Program`] (feature `alloc`) chains such moves with dwells, sines and chirps, and both are
//! [`Motion`]s: a duration and a [`Setpoint`] at any time.
//!
//! # Symbols and units
//! | symbol | what | unit |
//! |---|---|---|
//! | t | time since the motion began | s |
//! | s and its derivatives | position, velocity, acceleration, jerk: a [`Setpoint`] | m, m/s, m/s², m/s³ |
//! | s₀, s₁ | where the motion begins and ends | m |
//! | V, A, J | [`Limits`] | m/s, m/s², m/s³ |
//!
//! For an axis that turns read rad for m.
//!
//! # Example
//! ```
//! use trajectories::{Limits, Motion, SCurve};
//!
//! // 300 mm at 100 mm/s, 225 mm/s² and 1200 mm/s³.
//! let limits = Limits::<f64>::new(0.1, 0.225, 1.2)?;
//! let curve = SCurve::plan(0.6, 0.9, &limits)?;
//!
//! // All limits are reached, so the time is d/V + V/A + A/J.
//! let closed_form = 0.3 / 0.1 + 0.1 / 0.225 + 0.225 / 1.2;
//! assert!((curve.duration() - closed_form).abs() < 1e-14);
//!
//! let middle = curve.at(0.5 * curve.duration());
//! assert_eq!(middle.velocity, 0.1);
//! assert!((middle.position - 0.75).abs() < 1e-15);
//!
//! // The end is met exactly, and kept.
//! let end = curve.at(curve.duration());
//! assert_eq!((end.position, end.velocity, end.acceleration), (0.9, 0.0, 0.0));
//! # Ok::<(), trajectories::TrajectoryError>(())
//! ```
//!
//! # From a state in motion
//! [`Transfer`] leads from any position, velocity and acceleration to any other in least time, or in a longer one that is
//! asked for; [`VelocityChange`] to a velocity, wherever that is reached, for instance to a stop. [`Axes`] makes several axes start
//! and end together, on a straight line if they can. [`Follow`] takes a target that may change in every cycle of a
//! controller.
//!
//! # What it knows nothing of
//! The machine that follows the motion: no axis, stroke, control period, controller or error
//! enters here. Callers compare [`Extremes`] with their own stroke and sample at their own
//! instants. Steps of a program are of one axis, with rest at both ends: no blending between moves.
//!
//! # Scalar
//! All motions are generic over their scalar, planning included: `f64` where none is named, `f32`
//! for a controller without double precision in hardware. Files are in `f64`; [`Program::cast`]
//! plans what was read anew.
//!
//! # Features
//! `std` (default) implies `alloc`; `alloc` gives [`Program`]; `serde` reads and writes programs
//! and steps in `f64` with keys in millimetres or degrees (see [`Step`]) and implies `alloc`. Without any of them the
//! crate is `no_std` and allocates nothing.
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod axes;
mod constant_jerk;
mod envelope;
mod error;
mod extremes;
#[cfg(feature = "serde")]
mod file;
mod follow;
mod limits;
pub mod maximum;
mod motion;
mod oscillation;
mod phases;
#[cfg(feature = "alloc")]
mod program;
mod real;
mod scurve;
mod step;
mod sweep;
mod transfer;
mod velocity_change;

pub use axes::{Axes, AxisError, AxisTask};
pub use error::TrajectoryError;
pub use extremes::Extremes;
pub use follow::Follow;
pub use limits::Limits;
pub use motion::{Motion, Setpoint};
pub use oscillation::{Chirp, Oscillation, Sine};
#[cfg(feature = "alloc")]
pub use program::{Program, ProgramUnit};
pub use real::Real;
pub use scurve::{SCurve, Segment};
pub use step::Step;
pub use sweep::Sweep;
pub use transfer::{Transfer, TransferLimits};
pub use velocity_change::{VelocityChange, VelocityLimits};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
