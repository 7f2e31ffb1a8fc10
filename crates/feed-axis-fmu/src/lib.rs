//! The library of FMI 3.0 and FMI 2.0 units of axes, over [`axis_fmu::Unit`]: all functions of
//! `fmi3Functions.h` (Modelica Association, *Functional Mock-up Interface Specification 3.0.2*), and
//! those for co-simulation of `fmi2Functions.h` (*Functional Mock-up Interface for Model Exchange and
//! Co-Simulation 2.0.5*).
//!
//! One library serves every axis and both versions: it reads the axis or machine file from the unit's resources.
//! What FMI offers and this does not (`absent.rs`) returns an error and says so to the logger,
//! whatever the description has promised; nothing panics across the border.
//!
//! # Pointers
//! The functions are made by `safer-ffi`'s `#[ffi_export]`: pointers come as `Option` of
//! references and boxes, so no `unsafe` is written here. Arrays are read and written element by
//! element (`access.rs`), which holds under the calling convention of any target.
#![cfg(all(
    any(unix, windows),
    any(target_arch = "x86_64", target_arch = "aarch64")
))]

mod access;
mod arrays;
mod call;
mod component;
mod fmi2;
mod fmi3;
mod instance;
mod log;
mod resource_path;
mod state_bytes;
mod status;
mod values;
