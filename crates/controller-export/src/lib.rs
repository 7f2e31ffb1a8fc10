//! Compensators for controllers: one C99 file, a LinuxCNC component, a network as ONNX.
//!
//! What runs cycle by cycle on a controller is exported: its numbers as data, and a small
//! evaluator in C that computes with them what the crates `compensator`, `cfnn` and `lugre`
//! compute, operation by operation in the same order. The tests compile it and compare it with
//! the Rust code, bit by bit.
//!
//! ```text
//! Predictors, name of a strategy ─► Controller ─┬─► c::export ────────► NAME.h, NAME.c
//!                                               ├─► linuxcnc::export ─► NAME.comp, NAME.hal
//!                            trained network ───┴─► onnx::export ─────► NAME.onnx
//! ```
//!
//! Every exported compensator stands behind a guard ([`compensator::Guard`]): its corrections
//! are limited, faded in and out, and fade out by themselves where something is wrong.
//!
//! # Units
//! SI: m (rad where the load turns), rad, s, A (N·m, N or V where the actuator takes that). In
//! LinuxCNC positions are in machine units.
//!
//! # What this crate does not know
//! Files, terminals, options: functions return named texts and bytes. How strategies are found
//! (`axis-pipeline`), and any physics: no equation stands here that the crates below do not have.

pub mod c;
mod controller;
mod error;
mod law;
pub mod linuxcnc;
mod name;
pub mod onnx;

pub use controller::{EXPORTED, ExportedController, Units, exportable};
pub use error::ExportError;
pub use law::{ExportedLaw, NetworkLaw, PlanLaw, Position};

/// A text with the name of the file that it belongs in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedText {
    /// Name of the file, without a folder.
    pub name: String,
    /// What stands in it.
    pub text: String,
}
