//! The functions of `fmi2Functions.h` for co-simulation.

mod absent;
mod lifecycle;
mod states;
mod status;
mod values;

/// `fmi2Boolean`.
type Bool = i32;
