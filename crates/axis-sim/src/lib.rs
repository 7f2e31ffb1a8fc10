//! Closed-loop simulation of a feed axis: mechanism, actuator, control, sensors,
//! friction and loads, and a compensator, to a log.
//!
//! # The problem
//! A load is to follow a reference S_ref(t). Between two samples the machine is a set of
//! ordinary differential equations: a mechanism, which a motor torque T drives and a force
//! F on the load opposes, both depending on what they cause. At the instants `t_k = k T`
//! a controller samples what sensors show of it and gives the actuator a command u:
//!
//! ```text
//! mechanism   M(x) q̈ + C(x) q̇ + K(x) q = [T at the motor, −F at the load]
//! actuator    T = T(u, motor speed, its own state)
//! friction    F = LuGre(load speed, bristles) + loads(position, time)
//! sensors     what a drive gets to see of load and motor
//! control     u = control(sensors, reference + Δ) + u_ff          Δ, u_ff: the compensator's
//! ```
//!
//! Each of them is a part of an [`Axis`], of a kind that the axis file names. With a screw
//! of Timoshenko elements, a permanent-magnet motor under field-oriented control, a P–PI
//! cascade and LuGre friction this is the axis of Liu, Guo, Liu, Niu, Machines 2025, 13(5),
//! 433, doi:10.3390/machines13050433, Section 3, its printed signs and units corrected; the
//! equations of all kinds are in docs/theory/axis-sim.md. What comes out is one [`Cycle`]
//! per sampling instant; the tracking error is S_ref − S there.
//!
//! # What is here
//! - [`Axis`]: parts and settings, read from a TOML file and checked once. Errors
//!   name file, line, field and what would be valid. [`Registry`]: the kinds that a file may
//!   name, to which a program may add its own.
//! - [`mechanism`], [`actuator`], [`control`], [`sensor`], [`friction`], [`load`]: the kinds
//!   of parts, each a file and a line of its registry ([`part`]).
//! - [`ClosedLoop`]: the loop above for any motion and any compensator, whole
//!   ([`ClosedLoop::run`]) or cycle by cycle for a caller who owns time
//!   ([`ClosedLoop::step`]). How a run ended is its [`Outcome`]; what it left is a
//!   [`LoopState`], from which the next may begin.
//! - [`CHANNELS`]: the channels of logs; [`Recorder`]: cycles to an [`axis_log::Log`];
//!   [`FlowRecorder`]: to a file while the run goes on, [`CsvRecorder`] to CSV text.
//! - [`OneCycle`]: a single cycle from a given motion, S(k+1) − S(k): the
//!   samples that a network learns from.
//! - [`effects`]: what a model may lack, as changes of parameters by their role and hooks
//!   in the loop.
//! - [`rating`]: the axis against the data sheets of its parts, `[rating]` of its file, under a duty.
//! - [`thermal`]: the axis' thermal model from `[thermal]` of its file, and the losses of a motion.
//! - [`Replay`]: a log's reference through an axis with effects; [`balance`]: the motor
//!   torque that an axis with effects needs for a log's measured motion.
//!
//! # Units
//! SI inside: m, rad, s, N, N·m, A, V; a load that turns has rad for m, N·m for N and kg·m²
//! for kg ([`mechanism::Freedom`]). In the file the last part of each key is its unit
//! (`lead_mm = 10`, `lead_m = 0.010`).
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
//! assert!(error.contains("mechanism.lead_inch") && error.contains("lead_mm, lead_m, lead_um"));
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
pub mod balance;
mod balance_error;
mod channels;
mod closed_loop;
pub mod control;
mod control_difference;
mod cycle;
mod data_sheets;
mod effect_forces;
pub mod effects;
mod error;
mod freedom;
pub mod friction;
mod late_clock;
pub mod load;
pub mod mechanism;
mod noise_levels;
mod one_cycle;
pub mod part;
mod plan_model;
pub mod plant;
pub mod rating;
mod recorder;
mod replay;
pub mod sensor;
mod six_digits;
mod start;
pub mod thermal;
mod torque_channel;
mod value_range;
mod work;

pub use axis::{
    Axis, BalanceSettings, Experiment, FOLLOWING_ERROR_LIMIT, LoadSensor, MoveSpec, SampleRanges,
    Sensors, Simulation, Stroke, Tolerances,
};
pub use axis_file::{AxisFileError, Registry, TABLES_WITHOUT_PARTS, toml_message};
pub use balance::{
    Balance, BalanceError, BalanceNoise, BalanceQuality, CutoffReason, TRANSMISSION_ERROR,
};
pub use channels::{
    CHANNELS, ChannelPart, EXCITATIONS, LogChannel, channels, commanded_channels,
    excitation_channel, excitation_in, known_channels, needed_position, position_in,
    position_shown, reference_in,
};
pub use closed_loop::{ClosedLoop, LoopState, MACHINE_STEP};
pub use control_difference::{ControlDifference, control_differences};
pub use cycle::{Command, Cycle, Measured, Outcome, RunStopped, Stop, StopReason};
pub use effect_forces::EffectForces;
pub use error::SetupError;
pub use noise_levels::{NoiseLevels, NormalNumbers};
pub use one_cycle::{CycleInput, OneCycle};
pub use plan_model::{PlanModelError, PositionErrors};
pub use recorder::{CsvRecorder, FlowRecorder, Recorder};
pub use replay::{LoggedReference, Probe, Replay, ReplayError, SampledCurve, Stored, Trace};
pub use six_digits::SixDigits;
pub use start::Start;
pub use value_range::ValueRange;
pub use work::{FREQUENCIES, MOST_STEPS};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
