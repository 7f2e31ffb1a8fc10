//! The library of FMI 3.0 and FMI 2.0 units of axes, over [`axis_fmu::Unit`]: all functions of
//! `fmi3Functions.h` (Modelica Association, *Functional Mock-up Interface Specification 3.0.2*), and
//! those for co-simulation of `fmi2Functions.h` (*Functional Mock-up Interface for Model Exchange and
//! Co-Simulation 2.0.5*).
//!
//! One library serves every axis and both versions: it reads `axis.toml` from the unit's resources.
//! What FMI offers and this does not (`absent.rs`) returns an error and says so to the logger,
//! whatever the description has promised; nothing panics across the border.
//!
//! # Pointers
//! The functions are made by `safer-ffi`'s `#[ffi_export]`: pointers come as `Option` of
//! references, boxes and slices, so no `unsafe` is written here. FMI 3.0 passes arrays as two
//! arguments, address and length; `c_slice` is one structure of the two. Under the System V ABI of
//! x86-64 (Section 3.2.3) and the procedure call standard of AArch64 (Section 6.8) a structure of
//! two registers passes exactly as two arguments do while registers last, which is so in all
//! functions here that take one. On other targets that does not hold, and the library is empty.
//! FMI 2.0 passes one length for two arrays: `fmi2/access.rs`.
#![cfg(all(unix, any(target_arch = "x86_64", target_arch = "aarch64")))]

mod call;
mod fmi2;
mod fmi3;
mod instance;
mod log;
mod resource_path;
