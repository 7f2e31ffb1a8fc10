//! The library of FMI 3.0 units of axes: all functions of `fmi3Functions.h` (Modelica
//! Association, *Functional Mock-up Interface Specification 3.0.2*), over [`axis_fmu::Unit`].
//!
//! One library serves every axis: it reads `axis.toml` from the unit's resources. What FMI offers
//! and this does not (`absent.rs`) returns `fmi3Error` and says so to the logger, whatever
//! the description has promised; nothing panics across the border.
//!
//! # Pointers
//! The functions are made by `safer-ffi`'s `#[ffi_export]`: pointers come as `Option` of
//! references, boxes and slices, so no `unsafe` is written here. FMI passes arrays as two
//! arguments, address and length; `c_slice` is one structure of the two. Under the System V ABI of
//! x86-64 (Section 3.2.3) and the procedure call standard of AArch64 (Section 6.8) a structure of
//! two registers passes exactly as two arguments do while registers last, which is so in all
//! functions here that take one. On other targets that does not hold, and the library is empty.
#![cfg(all(unix, any(target_arch = "x86_64", target_arch = "aarch64")))]

mod absent;
mod call;
mod instance;
mod lifecycle;
mod states;
mod values;
