//! Closed-loop simulation of a ball-screw axis: plant, servo and compensator
//! to a log.
//!
//! # The problem
//! A table on a ball screw is to follow a reference S_ref(t). Between two
//! samples the machine is a set of ordinary differential equations (Liu, Guo,
//! Liu, Niu, Machines 2025, 13(5), 433, doi:10.3390/machines13050433,
//! Section 3; its printed signs and units corrected):
//!
//! ```text
//! M q̈ + βK(x) q̇ + K(x) q = [T at the motor, −T_f / r at the table],   x = x₀ + q_table
//! T    = 1.5 p (ψ i_q + (L_d − L_q) i_d i_q)
//! L_d i̇_d = u_d − R i_d + p ω_m L_q i_q
//! L_q i̇_q = u_q − R i_q − p ω_m (L_d i_d + ψ)
//! ż    = ω − σ₀ |ω| z / G(ω),     ω = q̇_table / r,     r = lead / 2π
//! T_f  = σ₀ z + σ₁ ż + σ₂ ω
//! ```
//!
//! with the N + 4 coordinates `q` of [`feed_dynamics`], LuGre friction
//! ([`lugre`]) and a permanent-magnet motor ([`foc_pmsm`]). At the instants
//! `t_k = k T` the controller samples table position, motor speed and
//! currents, and sets the voltage for the cycle:
//!
//! ```text
//! ω_ref  = P (S_ref − S + Δ) + v_ref / r        Δ, i_ff: the compensator's
//! i_q,ref = PI(ω_ref − ω_m) + i_ff              limited, anti-windup
//! u_d, u_q = PI(0 − i_d), PI(i_q,ref − i_q)     limited, anti-windup, held over T
//! ```
//!
//! What comes out is one [`Cycle`] per sampling instant; the tracking error
//! is S_ref − S there.
//!
//! # What is here
//! - [`Axis`]: all parameters, read from a TOML file and checked once. Errors
//!   name file, line, field and what would be valid.
//! - [`ClosedLoop`]: the loop above for any motion and any compensator.
//!   How a run ended is its [`Outcome`].
//! - [`Recorder`]: cycles to an [`axis_log::Log`] with named channels;
//!   [`CsvRecorder`]: straight to CSV, in bounded memory.
//! - [`OneCycle`]: a single cycle from a given motion, S(k+1) − S(k): the
//!   samples that a network learns from.
//! - [`effects`]: what a model may lack, as components of the loop.
//! - [`RigidAxis`]: the other kind of machine, a rigid mass under a P–P
//!   controller; [`effects::Machine`] is either.
//! - [`Replay`]: a log's reference through a machine with effects.
//!
//! # Units
//! SI inside: m, rad, s, N, N·m, A, V. In the file the last part of each key
//! is its unit (`lead_mm = 10`, `lead_m = 0.010`).
//!
//! # Bounded work
//! Every value of an axis file lies within stated limits, and a run of more
//! than [`MOST_STEPS`] internal steps is refused before it begins;
//! [`ClosedLoop::cycles`] and [`ClosedLoop::steps`] tell what a run takes.
//!
//! # Example
//! Trajectory 1 of the paper's axis, without compensation:
//!
//! ```
//! use axis_sim::{Axis, ClosedLoop};
//! use compensator::NoCompensation;
//!
//! // Text of an axis file; `Axis::read` takes a path.
//! let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
//! let text = std::fs::read_to_string(file)?;
//! let axis = Axis::parse("liu2025.toml", &text)?;
//!
//! let motion = axis.plan(&axis.trajectories[0])?;
//! let mut largest = 0.0_f64;
//! ClosedLoop::new(&axis)?
//!     .run(&motion, &mut NoCompensation, |cycle| {
//!         largest = largest.max(cycle.error().abs());
//!     })
//!     .completed()?;
//! assert!((largest - 54.45e-6).abs() < 0.02e-6); // m
//!
//! // A bad file says where and what.
//! let bad = text.replace("lead_mm", "lead_inch");
//! let error = Axis::parse("bad.toml", &bad).unwrap_err().to_string();
//! assert!(error.contains("screw.lead_inch") && error.contains("lead_mm, lead_m, lead_um"));
//! let bad = text.replace("lead_mm", "laed_mm");
//! let error = Axis::parse("bad.toml", &bad).unwrap_err().to_string();
//! assert!(error.contains("did you mean `lead_mm`?"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What this crate knows nothing of
//! What a compensator does inside, and whether it is good; how networks are
//! trained; reports and the command line; measured logs. The controller and
//! the compensator see only what a real one samples, never the machine's
//! inner state (bristles, deflections, table speed).

pub mod actuator;
mod axis;
mod axis_file;
mod channels;
mod closed_loop;
pub mod control;
mod cycle;
pub mod effects;
mod error;
pub mod friction;
pub mod load;
pub mod mechanism;
mod one_cycle;
pub mod part;
pub mod plant;
mod recorder;
mod replay;
pub mod sensor;
mod six_digits;
mod work;

pub use axis::{
    Axis, Experiment, FOLLOWING_ERROR_LIMIT, LoadSensor, MoveSpec, Range, SampleRanges, Sensors,
    Simulation, Stroke, Tolerances,
};
pub use axis_file::{AxisFileError, Registry};
pub use channels::{CHANNELS, ChannelPart, LogChannel, channels, position_in, reference_in};
pub use closed_loop::{ClosedLoop, LoopState};
pub use cycle::{Command, Cycle, Measured, Outcome, RunStopped, Stop, StopReason};
pub use error::SetupError;
pub use one_cycle::{CycleInput, OneCycle};
pub use plant::Start;
pub use recorder::{CsvRecorder, Recorder};
pub use replay::{LoggedReference, Probe, Replay, ReplayError, Trace};
pub use six_digits::SixDigits;
pub use work::MOST_STEPS;
